// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include <xtrack/depth.hpp>
#include <xtrack/rig.hpp>

namespace xtrack::segment {

/// Rows and columns of padding on every side, so that neighbourhoods need no bounds check.
inline constexpr int kPad = 2;

/// Depth on the working grid: at most about 320 columns, millimetres, cleaned. Index = y * width +
/// x with the padding counted; pixel (x, y) of the grid without padding is at(x, y).
class Grid {
 public:
    void create(const Rig& rig, Size size);

    /// Fills z() from a depth image: every grid pixel is the mean of the nearest surface in its
    /// block, lone pixels are dropped and pinholes closed.
    void load(const DepthFrame& depth, float near_mm);

    [[nodiscard]] int index(int x, int y) const noexcept { return (y + kPad) * width + x + kPad; }
    [[nodiscard]] int x_of(int i) const noexcept { return i % width - kPad; }
    [[nodiscard]] int y_of(int i) const noexcept { return i / width - kPad; }
    [[nodiscard]] Vec3f point(int i) const noexcept {
        const auto k = static_cast<std::size_t>(i);
        return {ray[k].x() * z[k], ray[k].y() * z[k], z[k]};
    }
    /// Side of a grid pixel on a surface at depth z_mm that faces the camera.
    [[nodiscard]] float pitch_mm(float z_mm) const noexcept { return z_mm * inverse_focal; }
    /// The largest step in depth between neighbours of one surface.
    [[nodiscard]] float step_limit_mm(float z_mm) const noexcept {
        return kStepFloorMm + kSteepest * pitch_mm(z_mm);
    }
    [[nodiscard]] bool joined(std::size_t a, std::size_t b) const noexcept {
        return z[a] > 0.0F && z[b] > 0.0F &&
               std::abs(z[a] - z[b]) < step_limit_mm(std::min(z[a], z[b]));
    }
    [[nodiscard]] std::size_t size() const noexcept { return z.size(); }

    int inner_width = 0, inner_height = 0;  ///< without padding
    int width = 0, height = 0;              ///< with padding
    int scale = 1;
    float inverse_focal = 0.0F;
    std::vector<float> z;    ///< mm; 0 = no depth
    std::vector<Vec2f> ray;  ///< x/z, y/z of the pixel's centre

    /// Noise of two neighbours, mm: 3 sigma of 1.5 mm each, after the mean of the block.
    static constexpr float kStepFloorMm = 6.0F;
    /// Steepest surface followed, mm of depth a mm along the image: 80 degrees.
    static constexpr float kSteepest = 5.5F;

 private:
    void drop_lone();
    void close_pinholes();
    std::vector<float> scratch_;
};

}  // namespace xtrack::segment
