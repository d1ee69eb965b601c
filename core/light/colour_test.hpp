// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <xtrack/light_calibration.hpp>
#include <xtrack/pattern.hpp>

#include "core/depth/triangulation.hpp"
#include "core/light/coordinates.hpp"
#include "core/light/light_samples.hpp"
#include "core/light/ramp.hpp"

namespace xtrack {

/// What is known before colours are measured.
struct ColourTestInput {
    const LightSamples& samples;
    const PatternSequence& sequence;  ///< with the response that is believed where no ramp is
    std::span<const std::size_t> pixels;
    std::span<const float> coordinate_px;              ///< one for each pixel; NaN: none
    bool ranges_in_colour = false;                     ///< false: they are luma's
    std::vector<std::array<LightRange, 3>> ranges{};   ///< of each pixel's red, green, blue
    const Ramp* ramp = nullptr;                        ///< null: none was shown
    std::array<std::vector<double>, 3> ramp_shares{};  ///< in the camera's red, green, blue
    const Triangulation* geometry = nullptr;           ///< null: no rig
    const Rig* rig = nullptr;                          ///< the same
};

struct ColourTestResult {
    ColourSelfTest verdict;
    /// Shares of full light at the ramp's steps, of the projector's colours; empty without a ramp.
    std::array<std::vector<double>, 3> light;
};

/// Patterns of a sequence that have their phases in colours, longest period first.
[[nodiscard]] std::vector<int> colour_patterns(const PatternSequence& sequence);

/// Measures the crosstalk and the colours' responses in turn, and judges what is left.
[[nodiscard]] ColourTestResult test_colours(const ColourTestInput& input);

/// The projector's curves behind a ramp that a camera of this matrix saw.
/// @param light out: at the ramp's steps, never falling
void separate_ramp(const Ramp& ramp, const std::array<std::vector<double>, 3>& shares,
                   const Mat3d& camera_from_projector_rgb,
                   std::array<std::vector<double>, 3>& light);

}  // namespace xtrack
