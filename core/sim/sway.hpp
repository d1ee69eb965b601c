// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <xtrack/sim.hpp>

#include "core/sim/hand_pose.hpp"

namespace xtrack::sim {

/// What a living hand does without meaning to: slow drift, and physiological tremor (8-12 Hz,
/// tenths of a millimetre), of place, turns and fingers.
class Sway {
 public:
    Sway(std::uint64_t seed, SimHand hand);

    /// Adds it to a pose that was planned.
    void add(double t_s, HandPose& pose) const;

 private:
    struct Wave {
        float amplitude = 0.0F;
        float rad_per_s = 0.0F;
        float phase_rad = 0.0F;
    };
    static constexpr std::size_t kWaves = 4;
    static constexpr std::size_t kChannels = 7;  // place, turns, fingers together

    [[nodiscard]] float at(std::size_t channel, double t_s) const;

    std::array<std::array<Wave, kWaves>, kChannels> waves_{};
};

}  // namespace xtrack::sim
