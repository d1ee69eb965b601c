// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>
#include <optional>
#include <string>

#include <xtrack/point_cloud.hpp>

namespace xtrack {

// What the binary formats of point clouds share.

inline void append_little_endian(std::string& out, float value) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    for (unsigned shift = 0; shift < 32U; shift += 8U) {
        out += static_cast<char>((bits >> shift) & 0xFFU);
    }
}

inline void append_point(std::string& out, const Vec3f& point) {
    for (int axis = 0; axis < 3; ++axis) {
        append_little_endian(out, point(axis));
    }
}

/// For the comment of a file.
inline const char* unit_of(bool metric) { return metric ? "mm" : "relative, no scale"; }

[[nodiscard]] inline std::optional<Error> check_colours(const PointCloud& cloud) {
    if (!cloud.colours_rgb.empty() && cloud.colours_rgb.size() != cloud.points_mm.size()) {
        return Error{ErrorCode::invalid_argument,
                     "point cloud: colours_rgb must be empty or hold one colour a point"};
    }
    return std::nullopt;
}

}  // namespace xtrack
