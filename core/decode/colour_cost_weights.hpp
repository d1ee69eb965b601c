// SPDX-License-Identifier: Apache-2.0
#pragma once

// What both forms of colour_cost() agree on.
namespace xtrack::colour_cost_weights {

// A pixel under the wrong surface: its periods are apart by a fifth of a period, or its contrasts
// by a fifth.
inline constexpr float kApart = 4.0F;
inline constexpr float kContrast = 4.0F;
inline constexpr float kMostContrast = 1.1F;  // of a pixel: 1, and noise

}  // namespace xtrack::colour_cost_weights
