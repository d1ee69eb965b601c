// SPDX-License-Identifier: Apache-2.0
#include "core/unwrap/unwrap_row.hpp"

#include <cmath>
#include <numbers>

namespace xtrack {

void unwrap_row_scalar(const UnwrapRow& row) noexcept {
    const auto period = static_cast<float>(row.period_px);
    const auto px_per_rad = static_cast<float>(row.period_px / (2.0 * std::numbers::pi));
    const float per_period = 1.0F / period;
    const float limit = row.tolerance * period;
    for (int i = 0; i < row.count; ++i) {
        const float within = row.phase_rad[i] * px_per_rad;
        const float order = std::nearbyint((row.reference_px[i] - within) * per_period);
        const float x = order * period + within;
        const bool good = std::fabs(x - row.reference_px[i]) <= limit &&
                          x >= row.coordinate_min_px && x <= row.coordinate_max_px;
        row.coordinate_px[i] = good ? x : std::numeric_limits<float>::quiet_NaN();
    }
}

#if XTRACK_WITH_HIGHWAY
void unwrap_row(const UnwrapRow& row) noexcept { unwrap_row_highway(row); }
#else
void unwrap_row(const UnwrapRow& row) noexcept { unwrap_row_scalar(row); }
#endif

}  // namespace xtrack
