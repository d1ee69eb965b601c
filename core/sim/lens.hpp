// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <xtrack/geometry.hpp>
#include <xtrack/rig.hpp>

#include "core/sim/raster.hpp"

namespace xtrack::sim {

/// A camera or projector as the renderer uses it: Pinhole in single precision, both ways.
/// The distortion is OpenCV's rational model (Brown 1966; docs of cv::projectPoints).
class Lens {
 public:
    explicit Lens(const Pinhole& pinhole);

    /// Pixel of a point in front of the lens; z must be > 0.
    [[nodiscard]] ScreenPoint project(const Vec3f& p) const {
        float x = p.x() / p.z();
        float y = p.y() / p.z();
        if (distorted_) {
            distort(x, y);
        }
        return {fx_ * x + skew_ * y + cx_, fy_ * y + cy_};
    }
    /// The ray (x, y, 1) that is seen at a pixel.
    [[nodiscard]] Vec2f ray(float u_px, float v_px) const;

    [[nodiscard]] Size size() const noexcept { return size_; }
    [[nodiscard]] PixelRect frame() const noexcept { return {0, 0, size_.width, size_.height}; }

 private:
    void distort(float& x, float& y) const;

    float fx_;
    float fy_;
    float cx_;
    float cy_;
    float skew_;
    bool distorted_;
    std::array<float, 8> k_{};
    Size size_;
};

}  // namespace xtrack::sim
