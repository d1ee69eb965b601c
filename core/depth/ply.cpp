// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <xtrack/point_cloud.hpp>

#include "core/base/file.hpp"
#include "core/depth/cloud_bytes.hpp"

namespace xtrack {

Result<void> write_ply(const PointCloud& cloud, const std::filesystem::path& file) {
    if (auto error = check_colours(cloud)) {
        return *error;
    }
    const bool coloured = !cloud.colours_rgb.empty();
    std::string bytes = "ply\nformat binary_little_endian 1.0\ncomment camera frame, ";
    bytes += unit_of(cloud.metric);
    bytes += "\nelement vertex " + std::to_string(cloud.points_mm.size()) +
             "\nproperty float x\nproperty float y\nproperty float z\n";
    if (coloured) {
        bytes += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
    }
    bytes += "end_header\n";

    bytes.reserve(bytes.size() + cloud.points_mm.size() * (coloured ? 15U : 12U));
    for (std::size_t i = 0; i < cloud.points_mm.size(); ++i) {
        append_point(bytes, cloud.points_mm[i]);
        if (coloured) {
            for (const std::uint8_t channel : cloud.colours_rgb[i]) {
                bytes += static_cast<char>(channel);
            }
        }
    }
    return base::write_file(file, bytes);
}

}  // namespace xtrack
