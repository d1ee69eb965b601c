// SPDX-License-Identifier: Apache-2.0
#include <xtrack/point_cloud.hpp>

#include <algorithm>
#include <cmath>

#include "core/base/setting_up.hpp"
#include "core/depth/distortion.hpp"

namespace xtrack {

namespace {

PointCloud fill(const DepthFrame& depth, const Rig& rig, ImageView<const float> grey) {
    const Image<std::uint16_t>& image = depth.depth;
    PointCloud cloud;
    cloud.metric = depth.metric;
    std::size_t count = 0;
    for (int v = 0; v < image.height(); ++v) {
        const std::uint16_t* row = image.row(v);
        count += static_cast<std::size_t>(image.width() -
                                          std::count(row, row + image.width(), std::uint16_t{0}));
    }
    cloud.points_mm.reserve(count);
    cloud.colours_rgb.reserve(grey.empty() ? 0 : count);
    for (int v = 0; v < image.height(); ++v) {
        for (int u = 0; u < image.width(); ++u) {
            const std::uint16_t steps = image.at(u, v);
            if (steps == 0) {
                continue;
            }
            const double z = steps * depth.depth_unit_mm;
            const RayXY ray = ray_of_pixel(rig.camera, u, v);
            cloud.points_mm.emplace_back(static_cast<float>(ray.x * z),
                                         static_cast<float>(ray.y * z), static_cast<float>(z));
            if (!grey.empty()) {
                const float level = std::clamp(grey.at(u, v), 0.0F, 255.0F);
                const auto byte = static_cast<std::uint8_t>(std::isfinite(level) ? level : 0.0F);
                cloud.colours_rgb.push_back({byte, byte, byte});
            }
        }
    }
    return cloud;
}

}  // namespace

Result<PointCloud> make_point_cloud(const DepthFrame& depth, const Rig& rig,
                                    ImageView<const float> grey) {
    const Image<std::uint16_t>& image = depth.depth;
    if (!grey.empty() && grey.size() != image.size()) {
        return Error{ErrorCode::invalid_argument,
                     "point cloud: the colour image and the depth image differ in size"};
    }
    if (rig.camera.size != image.size()) {
        return Error{ErrorCode::invalid_argument,
                     "point cloud: the depth image is not of the rig's camera_size"};
    }
    if (auto valid = validate(rig); !valid) {
        return Error{ErrorCode::invalid_argument, "rig: " + valid.error().message};
    }
    return base::setting_up("make_point_cloud",
                            [&]() -> Result<PointCloud> { return fill(depth, rig, grey); });
}

}  // namespace xtrack
