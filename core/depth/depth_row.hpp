// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace xtrack {

/// One row of triangulation. With the ray r = (x, y, 1) of a camera pixel, the projector sees the
/// point Z r at x = (a Z + b) / (c Z + d), so Z = (d x - b) / (a - c x).
struct DepthRow {
    int count = 0;                         ///< pixels
    const float* coordinate_px = nullptr;  ///< undistorted projector px, NaN = none
    const float* modulation = nullptr;     ///< grey levels
    /// a and c of each pixel; null: a = a0 + i a_step, c = c0 + i c_step (no camera distortion)
    const float* a = nullptr;
    const float* c = nullptr;
    float a0 = 0.0F;
    float a_step = 0.0F;
    float c0 = 0.0F;
    float c_step = 0.0F;
    float b = 0.0F;
    float d = 0.0F;
    float near_mm = 0.0F;  ///< outside near ... far: no depth
    float far_mm = 0.0F;
    std::uint16_t* depth = nullptr;   ///< out: 0.1 mm, 0 = none
    std::uint8_t* quality = nullptr;  ///< out: modulation, 1 ... 255; 0 = none
};

/// @thread any; rows are independent
/// @ownership borrows everything for the call
void depth_row(const DepthRow& row) noexcept;

/// The reference form, plain C++.
void depth_row_scalar(const DepthRow& row) noexcept;

#if XTRACK_WITH_HIGHWAY
void depth_row_highway(const DepthRow& row) noexcept;
#endif

}  // namespace xtrack
