// SPDX-License-Identifier: Apache-2.0
#include "core/depth/points_row.hpp"

#include <cstddef>
#include <limits>

namespace xtrack {

void points_row_scalar(const PointsRow& row) noexcept {
    constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
    for (int i = 0; i < row.count; ++i) {
        const auto column = static_cast<float>(i);
        const float x = row.ray_x != nullptr ? row.ray_x[i] : row.x0 + column * row.x_step;
        const float y = row.ray_x != nullptr ? row.ray_y[i] : row.y0 + column * row.y_step;
        const float z = row.depth[i] != 0 ? static_cast<float>(row.depth[i]) * row.unit_mm : kNone;
        float* point = row.xyz_mm + 3 * static_cast<std::ptrdiff_t>(i);
        point[0] = x * z;
        point[1] = y * z;
        point[2] = z;
    }
}

#if XTRACK_WITH_HIGHWAY
void points_row(const PointsRow& row) noexcept { points_row_highway(row); }
#else
void points_row(const PointsRow& row) noexcept { points_row_scalar(row); }
#endif

}  // namespace xtrack
