// SPDX-License-Identifier: Apache-2.0
#include "core/decode/colour_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace xtrack {
namespace {

constexpr float kLeastContrast = 0.25F;  // below it noise explains everything
constexpr float kContrastStep = 0.06F;
constexpr float kLeastLight = 3.0F;  // grey levels of each colour
constexpr float kLeastSum = 30.0F;   // of all three
// Light from which on a logarithm's noise does not matter beside what the model leaves out.
constexpr float kSureLight = 60.0F;
constexpr float kStepsPerPeriod = 32.0F;

float contrast_of(std::size_t index) {
    return kLeastContrast + kContrastStep * static_cast<float>(index);
}

}  // namespace

ColourSearch::ColourSearch(const ColourModel& model, const ColourPeriod& coarse,
                           const ColourPeriod& fine)
    : model_(model), coarse_(coarse), fine_(fine), logs_(kContrasts * kTurnSteps) {
    for (std::size_t k = 0; k < kContrasts; ++k) {
        for (std::size_t t = 0; t < kTurnSteps; ++t) {
            const double turn =
                2.0 * std::numbers::pi * static_cast<double>(t) / static_cast<double>(kTurnSteps);
            logs_[k * kTurnSteps + t] = static_cast<float>(
                std::log(1.0 + static_cast<double>(contrast_of(k)) * std::cos(turn)));
        }
    }
}

std::size_t ColourSearch::find(const ColourModel::Light& coarse, const ColourModel::Light& fine,
                               float first_px, float last_px, Hypotheses& out) const noexcept {
    if (std::min(coarse.minCoeff(), fine.minCoeff()) < kLeastLight || fine.sum() < kLeastSum) {
        return 0;
    }
    std::array<float, 3> ratio{};
    std::array<float, 3> weight{};
    for (int i = 0; i < 3; ++i) {
        const auto k = static_cast<std::size_t>(i);
        ratio[k] = std::log(coarse[i] / fine[i]);
        weight[k] = std::min(1.0F, std::min(coarse[i], fine[i]) / kSureLight);
    }
    constexpr auto kSteps = static_cast<double>(kTurnSteps);
    const auto steps = [&](double phase_rad) {
        return phase_rad * kSteps / (2.0 * std::numbers::pi);
    };
    const auto coarse_slope = static_cast<float>(kSteps / coarse_.period_px);
    const auto fine_slope = static_cast<float>(kSteps / fine_.period_px);
    std::array<float, 3> coarse_first{};
    std::array<float, 3> fine_first{};
    for (std::size_t k = 0; k < 3; ++k) {
        const auto step = static_cast<double>(model_.steps_rad()[k]);
        coarse_first[k] = static_cast<float>(steps(coarse_.phase_rad + step));
        fine_first[k] = static_cast<float>(steps(fine_.phase_rad + step));
    }
    const auto index = [](float turn) {
        return static_cast<std::size_t>(static_cast<int>(std::floor(turn + 0.5F)) &
                                        static_cast<int>(kTurnSteps - 1));
    };
    constexpr float kFar = std::numeric_limits<float>::max();
    std::size_t found = 0;
    ColourHypothesis last{{}, 0.0F, kFar};
    bool falling = false;
    const auto keep = [&](const ColourHypothesis& hypothesis) {
        std::size_t at = found < kMostHypotheses ? found++ : kMostHypotheses;
        while (at > 0 && out[at - 1].misfit > hypothesis.misfit) {
            if (at < kMostHypotheses) {
                out[at] = out[at - 1];
            }
            --at;
        }
        if (at < kMostHypotheses) {
            out[at] = hypothesis;
        }
    };
    const float step_px = static_cast<float>(fine_.period_px) / kStepsPerPeriod;
    for (float x = first_px; x <= last_px; x += step_px) {
        std::array<std::size_t, 3> at_coarse{};
        std::array<std::size_t, 3> at_fine{};
        for (std::size_t k = 0; k < 3; ++k) {
            at_coarse[k] = index(coarse_first[k] + coarse_slope * x);
            at_fine[k] = index(fine_first[k] + fine_slope * x);
        }
        ColourHypothesis here{{}, x, kFar};
        for (std::size_t n = 0; n < kContrasts; ++n) {
            const float* log = logs(n);
            float misfit = 0.0F;
            for (std::size_t k = 0; k < 3; ++k) {
                const float off = ratio[k] - log[at_coarse[k]] + log[at_fine[k]];
                misfit += weight[k] * off * off;
            }
            if (misfit < here.misfit) {
                here.misfit = misfit;
                here.surface.contrast = contrast_of(n);
            }
        }
        if (falling && here.misfit >= last.misfit) {
            keep(last);
        }
        falling = here.misfit < last.misfit;
        last = here;
    }
    for (std::size_t n = 0; n < found; ++n) {
        // The mean of both images has half the noise.
        ColourHypothesis& h = out[n];
        std::array<float, 3> gain{};
        for (int i = 0; i < 3; ++i) {
            const auto k = static_cast<std::size_t>(i);
            const auto lit = [&](float turn) {
                return 1.0F +
                       h.surface.contrast * std::cos(turn * 2.0F * std::numbers::pi_v<float> /
                                                     static_cast<float>(kTurnSteps));
            };
            gain[k] = std::sqrt(coarse[i] * fine[i] /
                                (lit(coarse_first[k] + coarse_slope * h.coordinate_px) *
                                 lit(fine_first[k] + fine_slope * h.coordinate_px)));
        }
        h.surface = model_.surface(gain, h.surface.contrast);
    }
    return found;
}

}  // namespace xtrack
