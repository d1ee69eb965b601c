// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <xtrack/point_cloud.hpp>

#include "core/base/file.hpp"
#include "core/depth/cloud_bytes.hpp"

namespace xtrack {

Result<void> write_pcd(const PointCloud& cloud, const std::filesystem::path& file) {
    if (auto error = check_colours(cloud)) {
        return *error;
    }
    const bool coloured = !cloud.colours_rgb.empty();
    const std::string count = std::to_string(cloud.points_mm.size());
    std::string bytes = "# .PCD v0.7 - Point Cloud Data file format\n# camera frame, ";
    bytes += unit_of(cloud.metric);
    // PCL looks for a colour of type F, though its four bytes are no number.
    bytes += coloured ? "\nVERSION 0.7\nFIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F F\n"
                        "COUNT 1 1 1 1\n"
                      : "\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n";
    bytes += "WIDTH " + count + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + count +
             "\nDATA binary\n";

    bytes.reserve(bytes.size() + cloud.points_mm.size() * (coloured ? 16U : 12U));
    for (std::size_t i = 0; i < cloud.points_mm.size(); ++i) {
        append_point(bytes, cloud.points_mm[i]);
        if (coloured) {
            // 0x00RRGGBB, least byte first.
            for (std::size_t channel = 3; channel-- > 0;) {
                bytes += static_cast<char>(cloud.colours_rgb[i][channel]);
            }
            bytes += '\0';
        }
    }
    return base::write_file(file, bytes);
}

}  // namespace xtrack
