// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <cstdint>
#include <string>

#include <xtrack/point_cloud.hpp>

#include "core/base/file.hpp"

namespace xtrack {
namespace {

void append_little_endian(std::string& out, float value) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    for (unsigned shift = 0; shift < 32U; shift += 8U) {
        out += static_cast<char>((bits >> shift) & 0xFFU);
    }
}

}  // namespace

Result<void> write_ply(const PointCloud& cloud, const std::filesystem::path& file) {
    const bool coloured = !cloud.colours_rgb.empty();
    if (coloured && cloud.colours_rgb.size() != cloud.points_mm.size()) {
        return Error{ErrorCode::invalid_argument,
                     "point cloud: colours_rgb must be empty or hold one colour a point"};
    }
    std::string bytes = "ply\nformat binary_little_endian 1.0\ncomment camera frame, ";
    bytes += cloud.metric ? "mm" : "relative, no scale";
    bytes += "\nelement vertex " + std::to_string(cloud.points_mm.size()) +
             "\nproperty float x\nproperty float y\nproperty float z\n";
    if (coloured) {
        bytes += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
    }
    bytes += "end_header\n";

    bytes.reserve(bytes.size() + cloud.points_mm.size() * (coloured ? 15U : 12U));
    for (std::size_t i = 0; i < cloud.points_mm.size(); ++i) {
        for (int axis = 0; axis < 3; ++axis) {
            append_little_endian(bytes, cloud.points_mm[i](axis));
        }
        if (coloured) {
            for (const std::uint8_t channel : cloud.colours_rgb[i]) {
                bytes += static_cast<char>(channel);
            }
        }
    }
    return base::write_file(file, bytes);
}

}  // namespace xtrack
