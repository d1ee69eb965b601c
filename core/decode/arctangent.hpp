// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace xtrack {

/// atan(t) = t P(t^2) on [0, 1], ascending powers of t^2; a minimax fit, error below 1.7e-6 rad,
/// 400 times less than the phase noise of an 8-bit camera at full modulation.
inline constexpr std::array<float, 6> kArctangent{0.999977219F,  -0.332622827F, 0.19354037F,
                                                  -0.116426467F, 0.0526473346F, -0.0117191289F};

/// The angle of x + iy by that polynomial, rad, (-pi, pi]; 0 for 0.
inline float arctangent2(float y, float x) noexcept {
    const float ax = std::fabs(x);
    const float ay = std::fabs(y);
    const float larger = ax > ay ? ax : ay;
    if (larger == 0.0F) {
        return 0.0F;
    }
    const float t = (ax > ay ? ay : ax) / larger;
    const float t2 = t * t;
    float p = kArctangent[5];
    for (std::size_t k = 5; k-- > 0;) {
        p = p * t2 + kArctangent[k];
    }
    float angle = p * t;
    if (ay > ax) {
        angle = std::numbers::pi_v<float> / 2.0F - angle;
    }
    if (x < 0.0F) {
        angle = std::numbers::pi_v<float> - angle;
    }
    return y < 0.0F ? -angle : angle;
}

}  // namespace xtrack
