// SPDX-License-Identifier: Apache-2.0
#include "core/depth/sigma_row.hpp"

#include <cmath>
#include <numbers>

#include <xtrack/depth.hpp>

namespace xtrack {

void sigma_row(const DepthRow& depth, const SigmaRow& row) noexcept {
    constexpr float kTurn = 2.0F * std::numbers::pi_v<float>;
    const float read_variance = row.read_noise_levels * row.read_noise_levels;
    const float shot = row.electrons_per_level > 0.0F ? 1.0F / row.electrons_per_level : 0.0F;
    for (int i = 0; i < depth.count; ++i) {
        if (depth.depth[i] == 0 || !(depth.modulation[i] > 0.0F)) {
            row.sigma_mm[i] = 0.0F;
            continue;
        }
        const auto column = static_cast<float>(i);
        const float a = depth.a == nullptr ? depth.a0 + column * depth.a_step : depth.a[i];
        const float c = depth.c == nullptr ? depth.c0 + column * depth.c_step : depth.c[i];
        const float z = static_cast<float>(kDepthUnitMm) * static_cast<float>(depth.depth[i]);
        const float below = c * z + depth.d;
        const float px_per_mm = std::fabs(a * depth.d - depth.b * c) / (below * below);
        const float levels = std::sqrt(read_variance + shot * row.mean[i]);
        const float phase_rad = row.noise_gain[i] * levels / depth.modulation[i];
        row.sigma_mm[i] = phase_rad * row.period_px / kTurn / px_per_mm;
    }
}

}  // namespace xtrack
