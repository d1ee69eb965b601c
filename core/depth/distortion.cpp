// SPDX-License-Identifier: Apache-2.0
#include "core/depth/distortion.hpp"

#include <cmath>

namespace xtrack {
namespace {

constexpr int kMaxIterations = 50;
constexpr double kConverged = 1e-10;  // of the plane Z = 1: a ten-millionth of a pixel

}  // namespace

RayXY distort(const Pinhole& lens, RayXY ideal) noexcept {
    const auto& k = lens.distortion;
    const double x = ideal.x;
    const double y = ideal.y;
    const double r2 = x * x + y * y;
    const double radial = (1.0 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]))) /
                          (1.0 + r2 * (k[5] + r2 * (k[6] + r2 * k[7])));
    return {x * radial + 2.0 * k[2] * x * y + k[3] * (r2 + 2.0 * x * x),
            y * radial + k[2] * (r2 + 2.0 * y * y) + 2.0 * k[3] * x * y};
}

RayXY undistort(const Pinhole& lens, RayXY seen) noexcept {
    RayXY ideal = seen;
    for (int n = 0; n < kMaxIterations; ++n) {
        const RayXY image = distort(lens, ideal);
        const double dx = seen.x - image.x;
        const double dy = seen.y - image.y;
        ideal.x += dx;
        ideal.y += dy;
        if (std::fabs(dx) + std::fabs(dy) < kConverged) {
            break;
        }
    }
    return ideal;
}

RayXY ray_of_pixel(const Pinhole& lens, double u_px, double v_px) noexcept {
    const auto& m = lens.matrix;
    const double y = (v_px - m(1, 2)) / m(1, 1);
    const double x = (u_px - m(0, 2) - m(0, 1) * y) / m(0, 0);
    return lens.distorted() ? undistort(lens, {x, y}) : RayXY{x, y};
}

}  // namespace xtrack
