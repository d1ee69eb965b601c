// SPDX-License-Identifier: Apache-2.0
#include "core/sim/sway.hpp"

#include <cmath>
#include <numbers>

#include "core/sim/random.hpp"

namespace xtrack::sim {

Sway::Sway(std::uint64_t seed, SimHand hand) {
    struct Range {
        double low;
        double high;
    };
    Random random(mix(seed, 202U + static_cast<std::uint64_t>(hand)));
    constexpr std::array<Range, kWaves> kHz{{{0.08, 0.2}, {0.25, 0.5}, {0.7, 1.3}, {8.0, 12.0}}};
    constexpr std::array<double, kWaves> kPlaceMm{5.0, 2.5, 0.8, 0.12};
    constexpr std::array<double, kWaves> kTurnRad{0.05, 0.02, 0.006, 0.001};
    constexpr std::array<double, kWaves> kFingerRad{0.05, 0.02, 0.008, 0.001};
    for (std::size_t channel = 0; channel < kChannels; ++channel) {
        const auto& amplitude = channel < 3 ? kPlaceMm : channel < 6 ? kTurnRad : kFingerRad;
        for (std::size_t w = 0; w < kWaves; ++w) {
            const double hz = random.between(kHz[w].low, kHz[w].high);
            waves_[channel][w] = {static_cast<float>(amplitude[w] * random.between(0.6, 1.2)),
                                  static_cast<float>(2.0 * std::numbers::pi * hz),
                                  static_cast<float>(random.between(0.0, 2.0 * std::numbers::pi))};
        }
    }
}

float Sway::at(std::size_t channel, double t_s) const {
    float sum = 0.0F;
    for (const Wave& w : waves_[channel]) {
        sum += w.amplitude * static_cast<float>(std::sin(w.rad_per_s * t_s + w.phase_rad));
    }
    return sum;
}

void Sway::add(double t_s, HandPose& pose) const {
    for (int axis = 0; axis < 3; ++axis) {
        pose.palm_mm[axis] += at(static_cast<std::size_t>(axis), t_s);
        pose.turn_rad[axis] += at(static_cast<std::size_t>(axis) + 3, t_s);
    }
    const float bend = at(kChannels - 1, t_s);
    // Idle fingers move together, the outer ones more; thumb and index hold a pinch steady.
    constexpr std::array<float, kSimFingerCount> kShare{0.2F, 0.3F, 0.8F, 1.0F, 1.1F};
    for (std::size_t f = 0; f < kSimFingerCount; ++f) {
        const std::size_t first = f * kAnglesPerFinger;
        pose.fingers[first + (f == kThumb ? 2 : 0)] += kShare[f] * bend;
        pose.fingers[first + (f == kThumb ? 3 : 2)] += kShare[f] * bend;
    }
}

}  // namespace xtrack::sim
