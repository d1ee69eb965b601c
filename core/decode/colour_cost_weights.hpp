// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

// What both forms of colour_cost() agree on.
namespace xtrack::colour_cost_weights {

// A pixel under the wrong surface: its periods are apart by a fifth of a period, or its contrasts
// by a fifth.
inline constexpr float kApart = 4.0F;
inline constexpr float kContrast = 4.0F;
inline constexpr float kMostContrast = 1.1F;  // of a pixel: 1, and noise

// A contrast less a share of another has less noise the smaller the share is: so much that no
// surface costs less for it.
inline float equal_noise(float share) noexcept { return std::sqrt(2.0F / (1.0F + share * share)); }

}  // namespace xtrack::colour_cost_weights
