// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace xtrack {

/// One row of depth as points: x, y, z of every pixel, NaN where it has no depth. The ray of pixel
/// i is (ray_x[i], ray_y[i], 1), or (x0 + i x_step, y0 + i y_step, 1) where `ray_x` is null.
struct PointsRow {
    int count = 0;                         ///< pixels
    const std::uint16_t* depth = nullptr;  ///< steps of `unit_mm`, 0 = none
    float unit_mm = 0.0F;
    const float* ray_x = nullptr;
    const float* ray_y = nullptr;
    float x0 = 0.0F;
    float x_step = 0.0F;
    float y0 = 0.0F;
    float y_step = 0.0F;
    float* xyz_mm = nullptr;  ///< out: 3 count values
};

/// @thread any; rows are independent
/// @ownership borrows everything for the call
void points_row(const PointsRow& row) noexcept;

/// The reference form, plain C++.
void points_row_scalar(const PointsRow& row) noexcept;

#if XTRACK_WITH_HIGHWAY
void points_row_highway(const PointsRow& row) noexcept;
#endif

}  // namespace xtrack
