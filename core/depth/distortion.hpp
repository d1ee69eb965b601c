// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <xtrack/rig.hpp>

namespace xtrack {

/// A point of the plane Z = 1 of a pinhole, no unit.
struct RayXY {
    double x = 0.0;
    double y = 0.0;
};

/// Where the lens puts a ray: OpenCV's rational model, k1 k2 p1 p2 k3 k4 k5 k6.
[[nodiscard]] RayXY distort(const Pinhole& lens, RayXY ideal) noexcept;

/// The inverse by fixed-point iteration, to 1e-9 for lenses that can be inverted.
[[nodiscard]] RayXY undistort(const Pinhole& lens, RayXY seen) noexcept;

/// The undistorted ray of a pixel.
[[nodiscard]] RayXY ray_of_pixel(const Pinhole& lens, double u_px, double v_px) noexcept;

}  // namespace xtrack
