// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <xtrack/pattern.hpp>
#include <xtrack/result.hpp>

#include "core/light/light_samples.hpp"

namespace xtrack {

/// The flat patterns of a sequence, from dark to bright, none twice.
struct Ramp {
    struct Step {
        int pattern = 0;
        double value = 0.0;  ///< 0..1, as 8 bits show it
    };
    std::vector<Step> steps;

    [[nodiscard]] static Ramp of(const PatternSequence& sequence);
    /// It begins with black and ends with white.
    [[nodiscard]] bool has_ends() const noexcept {
        return !steps.empty() && steps.front().value == 0.0 && steps.back().value == 1.0;
    }
    [[nodiscard]] int black() const noexcept { return steps.front().pattern; }
    [[nodiscard]] int white() const noexcept { return steps.back().pattern; }
};

/// The share of full light that each step of a ramp shows in a channel, 0 first and 1 last: sums
/// over pixels, which rounding to grey levels does not bias.
/// @pre ramp.has_ends(); every step was seen by each of `pixels`
[[nodiscard]] std::vector<double> ramp_shares(const LightSamples& samples, const Ramp& ramp,
                                              std::size_t channel,
                                              std::span<const std::size_t> pixels);

/// Where the luma of pixels follows shares: those that stray thrice as far as most saw something
/// else. @param spread out: rms of the others about the shares
[[nodiscard]] std::vector<std::size_t> steady_pixels(const LightSamples& samples, const Ramp& ramp,
                                                     std::span<const double> shares,
                                                     std::span<const std::size_t> pixels,
                                                     double& spread);

/// @return unsupported where a step is darker than one before it by more than noise makes it; the
///         message names the levels
[[nodiscard]] Result<void> check_rising(const Ramp& ramp, std::span<const double> shares);

/// Makes shares of light a curve from 0 to 1 that never falls: steps that noise has swapped become
/// alike.
void pool_falls(std::vector<double>& shares);

/// The same curve at equal steps of the value, as ProjectorResponse wants it.
[[nodiscard]] std::vector<double> equal_steps(const Ramp& ramp, std::span<const double> shares);

/// The power of the value that comes nearest to a curve of equal steps.
[[nodiscard]] double nearest_gamma(std::span<const double> light);

}  // namespace xtrack
