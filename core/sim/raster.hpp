// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace xtrack::sim {

/// A corner of a triangle on an image: pixel coordinates, 0 in the centre of the first pixel.
struct ScreenPoint {
    float x = 0.0F;
    float y = 0.0F;
};

/// Pixels [x0, x1) x [y0, y1).
struct PixelRect {
    int x0 = 0;
    int y0 = 0;
    int x1 = 0;
    int y1 = 0;
    [[nodiscard]] bool empty() const noexcept { return x0 >= x1 || y0 >= y1; }
};

[[nodiscard]] inline PixelRect unite(const PixelRect& a, const PixelRect& b) noexcept {
    if (a.empty()) {
        return b;
    }
    if (b.empty()) {
        return a;
    }
    return {std::min(a.x0, b.x0), std::min(a.y0, b.y0), std::max(a.x1, b.x1), std::max(a.y1, b.y1)};
}

/// Corners are rounded to this part of a pixel, so that neighbours share exact edges: no cracks.
inline constexpr float kSubPixels = 256.0F;

/// Calls `pixel(x, y, w0, w1, w2)` for each pixel centre in the triangle, edges included, with its
/// barycentric weights. Triangles that are clockwise on the screen (y down) are not drawn.
template <typename Pixel>
void raster_triangle(const ScreenPoint& a, const ScreenPoint& b, const ScreenPoint& c,
                     const PixelRect& clip, Pixel&& pixel) {
    // Pinned to the whole pixels around the triangle first: 32 bits do for small triangles, 64 hold
    // any that is in reach of an image.
    const auto fix = [](float v) { return static_cast<std::int64_t>(std::lrintf(v * kSubPixels)); };
    constexpr auto kOne = static_cast<std::int64_t>(kSubPixels);
    const std::array<std::int64_t, 3> x{fix(a.x), fix(b.x), fix(c.x)};
    const std::array<std::int64_t, 3> y{fix(a.y), fix(b.y), fix(c.y)};
    // Twice the area, positive when the corners go round counter-clockwise to a viewer.
    const std::int64_t area = (x[2] - x[0]) * (y[1] - y[0]) - (x[1] - x[0]) * (y[2] - y[0]);
    if (area <= 0) {
        return;
    }
    const auto ceil_px = [](std::int64_t v) { return static_cast<int>((v + kOne - 1) >> 8); };
    const auto floor_px = [](std::int64_t v) { return static_cast<int>(v >> 8); };
    const int x0 = std::max(clip.x0, ceil_px(std::min({x[0], x[1], x[2]})));
    const int x1 = std::min(clip.x1 - 1, floor_px(std::max({x[0], x[1], x[2]})));
    const int y0 = std::max(clip.y0, ceil_px(std::min({y[0], y[1], y[2]})));
    const int y1 = std::min(clip.y1 - 1, floor_px(std::max({y[0], y[1], y[2]})));
    if (x0 > x1 || y0 > y1) {
        return;
    }
    // Edge functions: edge i is opposite corner i.
    std::array<std::int64_t, 3> row{};
    std::array<std::int64_t, 3> step_x{};
    std::array<std::int64_t, 3> step_y{};
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t p = (i + 1) % 3;
        const std::size_t q = (i + 2) % 3;
        const std::int64_t dx = x[q] - x[p];
        const std::int64_t dy = y[q] - y[p];
        row[i] = dx * (y[p] - kOne * y0) - dy * (x[p] - kOne * x0);
        step_x[i] = dy * kOne;
        step_y[i] = -dx * kOne;
    }
    const float inverse_area = 1.0F / static_cast<float>(area);
    for (int py = y0; py <= y1; ++py) {
        std::int64_t e0 = row[0];
        std::int64_t e1 = row[1];
        std::int64_t e2 = row[2];
        for (int px = x0; px <= x1; ++px) {
            if ((e0 | e1 | e2) >= 0) {
                const float w0 = static_cast<float>(e0) * inverse_area;
                const float w1 = static_cast<float>(e1) * inverse_area;
                pixel(px, py, w0, w1, 1.0F - w0 - w1);
            }
            e0 += step_x[0];
            e1 += step_x[1];
            e2 += step_x[2];
        }
        for (std::size_t i = 0; i < 3; ++i) {
            row[i] += step_y[i];
        }
    }
}

}  // namespace xtrack::sim
