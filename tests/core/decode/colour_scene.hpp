// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <xtrack/geometry.hpp>
#include <xtrack/image.hpp>

#include "core/decode/colour_cost.hpp"

namespace xtrack::test {

inline constexpr std::array<double, 3> kThirds_rad{0.0, -2.0 * std::numbers::pi / 3.0,
                                                   -4.0 * std::numbers::pi / 3.0};

/// One pixel under a colour fringe, by the formula of the model and nothing else.
struct ColourPixel {
    std::array<double, 3> gains{1.0, 1.0, 1.0};
    std::array<double, 3> tint{0.0, 0.0, 0.0};
    double contrast = 0.9;
    double shade = 60.0;
    std::array<double, 3> fade{1.0, 1.0, 1.0};  ///< of contrast, in every period looked at

    /// Light of the projector's red, green, blue.
    [[nodiscard]] Vec3d light(double coordinate_px, const ColourPeriod& period,
                              const std::array<double, 3>& steps_rad = kThirds_rad) const {
        Vec3d out;
        for (std::size_t k = 0; k < 3; ++k) {
            const double phase = 2.0 * std::numbers::pi * coordinate_px / period.period_px +
                                 period.phase_rad + steps_rad[k] - steps_rad[0];
            out[static_cast<int>(k)] =
                shade * gains[k] * (1.0 + tint[k] + contrast * fade[k] * std::cos(phase));
        }
        return out;
    }
};

/// What a camera makes of it: blue, green, red.
inline void photograph(const Vec3d& light, const Mat3d& camera_from_projector, std::uint8_t* bgr) {
    const Vec3d seen = camera_from_projector * light;
    for (int c = 0; c < 3; ++c) {
        bgr[c] = static_cast<std::uint8_t>(std::lround(std::clamp(seen[2 - c], 0.0, 255.0)));
    }
}

}  // namespace xtrack::test
