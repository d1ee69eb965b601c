// SPDX-License-Identifier: Apache-2.0
#include "core/depth/depth_row.hpp"

#include <cmath>

#include <xtrack/depth.hpp>

namespace xtrack {

void depth_row_scalar(const DepthRow& row) noexcept {
    constexpr auto kStepsPerMm = static_cast<float>(1.0 / kDepthUnitMm);
    for (int i = 0; i < row.count; ++i) {
        const auto column = static_cast<float>(i);
        const float a = row.a != nullptr ? row.a[i] : row.a0 + column * row.a_step;
        const float c = row.c != nullptr ? row.c[i] : row.c0 + column * row.c_step;
        const float x = row.coordinate_px[i];
        const float z = (row.d * x - row.b) / (a - c * x);
        const bool good = z >= row.near_mm && z <= row.far_mm;
        row.depth[i] = good ? static_cast<std::uint16_t>(std::nearbyint(z * kStepsPerMm)) : 0;
        const float trust = row.modulation[i] < 1.0F ? 1.0F : row.modulation[i];
        const float most = trust > 255.0F ? 255.0F : trust;
        row.quality[i] = good ? static_cast<std::uint8_t>(std::nearbyint(most)) : 0;
    }
}

#if XTRACK_WITH_HIGHWAY
void depth_row(const DepthRow& row) noexcept { depth_row_highway(row); }
#else
void depth_row(const DepthRow& row) noexcept { depth_row_scalar(row); }
#endif

}  // namespace xtrack
