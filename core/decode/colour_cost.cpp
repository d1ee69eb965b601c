// SPDX-License-Identifier: Apache-2.0
#include "core/decode/colour_cost.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/decode/arctangent.hpp"
#include "core/decode/colour_cost_weights.hpp"

namespace xtrack {

void colour_cost_scalar(const ColourCost& row) noexcept {
    using namespace colour_cost_weights;
    const auto seen = [](const ColourModel::Inverse& inverse,
                         const std::array<const float*, 3>& light, int i) {
        const ColourModel::Light pixel(light[0][i], light[1][i], light[2][i]);
        return ColourModel::Light(inverse * pixel);
    };
    // Within one period.
    const auto coordinate_px = [](const ColourModel::Light& light, const ColourPeriod& period) {
        constexpr float kTurn = 2.0F * std::numbers::pi_v<float>;
        return (arctangent2(light[2], light[1]) - static_cast<float>(period.phase_rad)) *
               (static_cast<float>(period.period_px) / kTurn);
    };
    const auto contrast_of = [](const ColourModel::Light& light) {
        return std::sqrt(light[1] * light[1] + light[2] * light[2]) / light[0];
    };
    const float transfer = row.has_coarse ? row.transfer : 1.0F;
    const float same_noise = equal_noise(transfer);
    const auto fine_period = static_cast<float>(row.fine.period_px);
    const auto coarse_period = static_cast<float>(row.coarse.period_px);
    for (int i = 0; i < row.count; ++i) {
        const ColourModel::Light fine = seen(row.inverse, row.samples.fine, i);
        const float fine_contrast = contrast_of(fine);
        bool possible = fine[0] > 0.0F && fine_contrast <= kMostContrast;
        float contrast = row.contrast;
        float reference_px = row.samples.reference_px[i];
        if (row.has_coarse) {
            const ColourModel::Light coarse = seen(row.coarse_inverse, row.samples.coarse, i);
            contrast = contrast_of(coarse);
            possible = possible && coarse[0] > 0.0F && contrast <= kMostContrast;
            const float x = coordinate_px(coarse, row.coarse);
            const float turns = std::floor((reference_px - x) / coarse_period + 0.5F);
            reference_px = std::isnan(reference_px) ? x : x + coarse_period * turns;
        }
        float apart = (coordinate_px(fine, row.fine) - reference_px) / fine_period;
        apart -= std::floor(apart + 0.5F);
        apart = std::isnan(reference_px) ? 0.0F : apart;
        const float between = (fine_contrast - transfer * contrast) * same_noise;
        const float cost = kApart * apart * apart + kContrast * between * between;
        if (row.fine_contrast != nullptr) {
            row.fine_contrast[i] = fine_contrast;
        }
        row.cost[i] = possible ? std::min(cost, kMostColourCost) : kMostColourCost;
    }
}

#if XTRACK_WITH_HIGHWAY
void colour_cost(const ColourCost& row) noexcept { colour_cost_highway(row); }
#else
void colour_cost(const ColourCost& row) noexcept { colour_cost_scalar(row); }
#endif

}  // namespace xtrack
