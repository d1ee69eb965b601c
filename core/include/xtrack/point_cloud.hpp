// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

#include <xtrack/depth.hpp>
#include <xtrack/geometry.hpp>
#include <xtrack/result.hpp>
#include <xtrack/rig.hpp>

namespace xtrack {

/// Points in the camera frame, mm, with a grey or colour value each.
/// @since 0.1
struct PointCloud {
    bool metric = true;
    std::vector<Vec3f> points_mm;
    std::vector<std::array<std::uint8_t, 3>> colours_rgb;  ///< empty or one a point
};

}  // namespace xtrack
