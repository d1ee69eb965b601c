// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include <xtrack/hand.hpp>

namespace xtrack::recognise {

[[nodiscard]] inline double degrees(double rad) noexcept { return rad * 180.0 / std::numbers::pi; }

/// Between two vectors, 0..180; 0 where one of them is zero.
[[nodiscard]] inline double angle_deg(const Vec3f& a, const Vec3f& b) noexcept {
    const double norms = static_cast<double>(a.norm()) * static_cast<double>(b.norm());
    const double cosine = norms > 0.0 ? static_cast<double>(a.dot(b)) / norms : 1.0;
    return degrees(std::acos(std::clamp(cosine, -1.0, 1.0)));
}

}  // namespace xtrack::recognise
