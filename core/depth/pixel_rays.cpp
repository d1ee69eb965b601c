// SPDX-License-Identifier: Apache-2.0
#include "core/depth/pixel_rays.hpp"

#include <algorithm>

#include "core/depth/distortion.hpp"

namespace xtrack {

PixelRays::PixelRays(const Pinhole& camera) {
    if (!camera.distorted()) {
        const auto ray = [&](int u, int v) {
            const RayXY of = ray_of_pixel(camera, u, v);
            return Vec2f(static_cast<float>(of.x), static_cast<float>(of.y));
        };
        // Over the whole image, so that rounding is a share of a pixel in the last one too.
        const int width = std::max(camera.size.width - 1, 1);
        const int height = std::max(camera.size.height - 1, 1);
        first_ = ray(0, 0);
        right_ = (ray(width, 0) - first_) / static_cast<float>(width);
        down_ = (ray(0, height) - first_) / static_cast<float>(height);
        return;
    }
    x_.resize(camera.size.width, camera.size.height);
    y_.resize(camera.size.width, camera.size.height);
    for (int v = 0; v < camera.size.height; ++v) {
        for (int u = 0; u < camera.size.width; ++u) {
            const RayXY ray = ray_of_pixel(camera, u, v);
            x_.at(u, v) = static_cast<float>(ray.x);
            y_.at(u, v) = static_cast<float>(ray.y);
        }
    }
}

void PixelRays::prepare_row(int y, PointsRow& row) const noexcept {
    if (!x_.empty()) {
        row.ray_x = x_.row(y);
        row.ray_y = y_.row(y);
        return;
    }
    const Vec2f begin = first_ + static_cast<float>(y) * down_;
    row.x0 = begin.x();
    row.y0 = begin.y();
    row.x_step = right_.x();
    row.y_step = right_.y();
}

}  // namespace xtrack
