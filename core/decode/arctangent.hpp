// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace xtrack {

/// atan(t) = t P(t^2) on [0, 1], ascending powers of t^2; a minimax fit, error below 1.7e-6 rad,
/// 400 times less than the phase noise of an 8-bit camera at full modulation.
inline constexpr std::array<float, 6> kArctangent{0.999977219F,  -0.332622827F, 0.19354037F,
                                                  -0.116426467F, 0.0526473346F, -0.0117191289F};

}  // namespace xtrack
