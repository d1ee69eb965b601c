// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include <xtrack/geometry.hpp>
#include <xtrack/hand.hpp>
#include <xtrack/sim.hpp>

namespace xtrack::tools::corpus {

/// How somebody moves who moves differently; `usual` is everybody else.
enum class Manner : std::uint8_t {
    usual,
    tremor,          ///< 4-6 Hz, 5-20 mm from crest to crest
    slow_and_short,  ///< half the way at half the speed
    wrist_at_rest,   ///< the forearm lies on something, the hand turns about its wrist
    bent_fingers,    ///< ring and little finger stay bent
    missing_finger,  ///< one of the four
};
inline constexpr std::size_t kMannerCount = 6;
[[nodiscard]] const char* to_string(Manner manner) noexcept;

/// Somebody before the screen. Camera frame, mm.
struct Person {
    std::uint64_t seed = 0;
    SimHand hand = SimHand::right;  ///< the one that gestures
    double hand_length_mm = 185.0;  ///< wrist to middle fingertip
    double speed_mmps = 600.0;      ///< mean of a stroke that nobody hurries or slows
    Vec3f home_mm = Vec3f::Zero();  ///< where the right palm is held up; the left one mirrors it
    double chest_mm = 900.0;        ///< camera Z of the front of the chest
    double to_side_mm = 0.0;        ///< where the middle of the body is, camera X
    double tall_mm = 0.0;           ///< how much higher than an adult's their shoulders are
    Manner manner = Manner::usual;
    double tremor_hz = 0.0;
    double tremor_mm = 0.0;  ///< from crest to crest
    std::array<bool, kFingerCount> bent{};
    std::array<bool, kFingerCount> missing{};

    [[nodiscard]] float scale() const noexcept;
    /// Where the palm of a hand is held up.
    [[nodiscard]] Vec3f home_of(SimHand which) const noexcept;
    /// +1 or -1: the camera X that is outward of this hand.
    [[nodiscard]] static float outward(SimHand which) noexcept {
        return which == SimHand::right ? -1.0F : 1.0F;
    }
};

/// Anybody from a child of six to somebody large: hand 130-220 mm, 40-90 cm away, left or right,
/// strokes of 0.2-1.5 m/s.
[[nodiscard]] Person draw_person(std::uint64_t seed, Manner manner = Manner::usual);

}  // namespace xtrack::tools::corpus
