// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "core/decode/colour_cost.hpp"
#include "core/decode/colour_surface.hpp"

namespace xtrack {

/// A surface that explains one pixel.
struct ColourHypothesis {
    ColourSurface surface;  ///< contrast and gains; no tint
    float coordinate_px = 0.0F;
    float misfit = 0.0F;  ///< sum of squares of logarithms of light; 0: perfect
};

/// Finds out about a pixel's gains without knowing anything of its neighbours, from its images
/// under two periods: what a surface does to a colour it does to it twice, so in the ratio of the
/// two images the gains cancel. Three ratios then say two things, coordinate and contrast.
/// @thread any; const
class ColourSearch {
 public:
    static constexpr std::size_t kMostHypotheses = 4;
    using Hypotheses = std::array<ColourHypothesis, kMostHypotheses>;

    ColourSearch() = default;
    ColourSearch(const ColourModel& model, const ColourPeriod& coarse, const ColourPeriod& fine);

    /// @param coarse, fine the pixel's light in the two images
    /// @param first_px, last_px coordinates that are possible
    /// @return how many, best first; none where the light is too little to say
    [[nodiscard]] std::size_t find(const ColourModel::Light& coarse, const ColourModel::Light& fine,
                                   float first_px, float last_px, Hypotheses& out) const noexcept;

 private:
    static constexpr std::size_t kContrasts = 12;
    static constexpr std::size_t kTurnSteps = 256;
    [[nodiscard]] const float* logs(std::size_t contrast) const noexcept {
        return logs_.data() + contrast * kTurnSteps;
    }

    ColourModel model_;
    ColourPeriod coarse_;
    ColourPeriod fine_;
    // ln(1 + kappa cos(turn)), kTurnSteps for each contrast.
    std::vector<float> logs_;
};

}  // namespace xtrack
