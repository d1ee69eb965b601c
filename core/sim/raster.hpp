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

/// Nothing yet: what raster_triangle() grows from.
inline constexpr PixelRect kNoPixels{1 << 30, 1 << 30, -(1 << 30), -(1 << 30)};

/// A corner rounded to 1/256 of a pixel, so that neighbours share exact edges: no cracks.
struct Corner {
    std::int32_t x = 0;
    std::int32_t y = 0;
};
inline constexpr int kSubPixelBits = 8;

[[nodiscard]] inline std::int32_t snap(float v_px) noexcept {
    constexpr float kSubPixels = 1 << kSubPixelBits;
    constexpr float kFarOffPx = 1.0e6F;  // keeps differences within 32 bits, products within 64
    return static_cast<std::int32_t>(
        std::floor(std::clamp(v_px, -kFarOffPx, kFarOffPx) * kSubPixels + 0.5F));
}
[[nodiscard]] inline Corner snap(const ScreenPoint& p) noexcept { return {snap(p.x), snap(p.y)}; }

/// Calls `pixel(x, y, w0, w1, w2)` for each pixel centre in the triangle, edges included, with its
/// barycentric weights. Triangles that are clockwise on the screen (y down) are not drawn.
/// @param touched grows by the pixels that may have been drawn
template <typename Pixel>
void raster_triangle(const Corner& a, const Corner& b, const Corner& c, const PixelRect& clip,
                     PixelRect& touched, Pixel&& pixel) {
    // Twice the area, positive when the corners go round counter-clockwise to a viewer.
    const std::int64_t area =
        std::int64_t{c.x - a.x} * (b.y - a.y) - std::int64_t{b.x - a.x} * (c.y - a.y);
    if (area <= 0) {
        return;
    }
    constexpr std::int32_t kOne = 1 << kSubPixelBits;
    const int x0 = std::max(clip.x0, (std::min({a.x, b.x, c.x}) + kOne - 1) >> kSubPixelBits);
    const int x1 = std::min(clip.x1 - 1, std::max({a.x, b.x, c.x}) >> kSubPixelBits);
    const int y0 = std::max(clip.y0, (std::min({a.y, b.y, c.y}) + kOne - 1) >> kSubPixelBits);
    const int y1 = std::min(clip.y1 - 1, std::max({a.y, b.y, c.y}) >> kSubPixelBits);
    if (x0 > x1 || y0 > y1) {
        return;
    }
    touched = {std::min(touched.x0, x0), std::min(touched.y0, y0), std::max(touched.x1, x1 + 1),
               std::max(touched.y1, y1 + 1)};
    const std::array<std::int64_t, 3> x{a.x, b.x, c.x};
    const std::array<std::int64_t, 3> y{a.y, b.y, c.y};
    // Edge functions: edge i is opposite corner i.
    std::array<std::int64_t, 3> row{};
    std::array<std::int64_t, 3> step_x{};
    std::array<std::int64_t, 3> step_y{};
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t p = (i + 1) % 3;
        const std::size_t q = (i + 2) % 3;
        const std::int64_t dx = x[q] - x[p];
        const std::int64_t dy = y[q] - y[p];
        row[i] = dx * (y[p] - std::int64_t{kOne} * y0) - dy * (x[p] - std::int64_t{kOne} * x0);
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
