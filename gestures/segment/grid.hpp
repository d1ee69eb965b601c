// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <xtrack/depth.hpp>
#include <xtrack/rig.hpp>

namespace xtrack::segment {

/// Rows and columns of padding on every side, so that neighbourhoods need no bounds check.
inline constexpr int kPad = 2;

/// Pixels [x_begin, x_end) x [y_begin, y_end) of a grid without padding.
struct Box {
    int x_begin = 0, y_begin = 0, x_end = 0, y_end = 0;

    [[nodiscard]] int width() const noexcept { return x_end - x_begin; }
    [[nodiscard]] bool empty() const noexcept { return x_begin >= x_end || y_begin >= y_end; }
};

/// Depth on a working grid of blocks of pixels: millimetres, cleaned. Index = y * width + x with
/// the padding counted; pixel (x, y) of the grid without padding is at index(x, y).
class Grid {
 public:
    /// Pixels a block of the fine grid has on a side: so few that a finger (16 mm) is 4 blocks wide
    /// at 1 m before a 60 degree camera.
    [[nodiscard]] static int fine_scale(Size image) noexcept {
        constexpr int kWidthMax = 420;
        return std::max(1, (image.width + kWidthMax - 1) / kWidthMax);
    }
    /// The same of the coarse grid, on which the whole image is looked at in every frame: twice as
    /// many, or as many where the fine grid is small.
    [[nodiscard]] static int coarse_scale(Size image) noexcept {
        constexpr int kWidthMax = 210;
        const int fine = fine_scale(image);
        return image.width / fine > kWidthMax ? 2 * fine : fine;
    }

    /// @param step_scale the scale whose neighbours' distance says how large a step in depth one
    ///        surface may have; a coarse grid that takes the fine one's joins no more than that
    ///        does
    void create(const Rig& rig, Size size, int scale, int step_scale);

    /// Fills z() from a depth image: every grid pixel is the mean of the nearest surface in its
    /// block, lone pixels are dropped and pinholes closed. What is filled does not depend on the
    /// box.
    /// @param box part of the grid to fill; the rest keeps what it had
    void load(const DepthFrame& depth, float near_mm, const Box& box);
    void load(const DepthFrame& depth, float near_mm) { load(depth, near_mm, whole()); }

    [[nodiscard]] Box whole() const noexcept { return {0, 0, inner_width, inner_height}; }
    /// The box with so many more pixels on every side, as far as the grid goes.
    [[nodiscard]] Box grown(const Box& box, int by) const noexcept {
        return {std::max(0, box.x_begin - by), std::max(0, box.y_begin - by),
                std::min(inner_width, box.x_end + by), std::min(inner_height, box.y_end + by)};
    }
    [[nodiscard]] int index(int x, int y) const noexcept { return (y + kPad) * width + x + kPad; }
    [[nodiscard]] int x_of(int i) const noexcept { return i % width - kPad; }
    [[nodiscard]] int y_of(int i) const noexcept { return i / width - kPad; }
    /// Whether a pixel is in the outermost row or column.
    [[nodiscard]] bool at_border(int i) const noexcept {
        const int x = x_of(i);
        const int y = y_of(i);
        return x == 0 || y == 0 || x == inner_width - 1 || y == inner_height - 1;
    }
    [[nodiscard]] Vec3f point(int i) const noexcept {
        const auto k = static_cast<std::size_t>(i);
        return {ray[k].x() * z[k], ray[k].y() * z[k], z[k]};
    }
    /// Side of a grid pixel on a surface at depth z_mm that faces the camera.
    [[nodiscard]] float pitch_mm(float z_mm) const noexcept { return z_mm * inverse_focal; }
    /// The largest step in depth between neighbours of one surface.
    [[nodiscard]] float step_limit_mm(float z_mm) const noexcept {
        return kStepFloorMm + step_slope * z_mm;
    }
    /// Surface of a run of pixels, projected on planes that face the camera.
    [[nodiscard]] float area_mm2(int begin, int end) const noexcept;
    [[nodiscard]] std::size_t size() const noexcept { return z.size(); }

    int inner_width = 0, inner_height = 0;  ///< without padding
    int width = 0, height = 0;              ///< with padding
    int scale = 1;
    float inverse_focal = 0.0F;
    float step_slope = 0.0F;  ///< see step_limit_mm()
    std::vector<float> z;     ///< mm; 0 = no depth
    std::vector<Vec2f> ray;   ///< x/z, y/z of the pixel's centre

    /// Noise of two neighbours, mm: 3 sigma of 1.5 mm each, after the mean of the block.
    static constexpr float kStepFloorMm = 6.0F;
    /// Steepest surface followed, mm of depth a mm along the image: 80 degrees.
    static constexpr float kSteepest = 5.5F;

 private:
    void drop_lone(const Box& box, const std::vector<float>& from, std::vector<float>& to) const;
    void close_pinholes(const Box& box, const std::vector<float>& from,
                        std::vector<float>& to) const;

    std::vector<float> blocks_;  ///< as they are
    std::vector<float> kept_;    ///< without lone ones
    std::vector<float> closed_;  ///< after one round of closing
};

}  // namespace xtrack::segment
