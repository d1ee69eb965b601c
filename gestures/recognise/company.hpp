// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include <xtrack/gesture_settings.hpp>
#include <xtrack/hand.hpp>
#include <xtrack/stamp.hpp>

#include "gestures/recognise/body.hpp"

namespace xtrack::recognise {

/// What the session hears of one hand in a frame.
struct HandReport {
    const Hand* hand = nullptr;
    float length_mm = 0.0F;  ///< of the hand, as far as it is known; 0: not
    double speed_mmps = 0.0;
    bool present = false;               ///< it may act, and is not cut by the border
    bool summons = false;               ///< it has just waved, or was raised
    bool active = false;                ///< a gesture of it is, or has just been
    bool jumped = false;                ///< it is where that hand cannot be after its last samples
    Vec3f expected_mm = Vec3f::Zero();  ///< where it would be
    float reach_mm = 0.0F;              ///< and how far from there it may be
};

/// One hand, what is known of it, and whether it is taken for the owner's other one.
struct Acquaintance {
    int hand_id = 0;  ///< 0: free
    Arm arm;
    Arm first;  ///< when it was first seen
    Stamp first_seen;
    Stamp seen;

    // While nobody has the session.
    Stamp still_since;
    bool still = false;
    bool tired = false;  ///< its session timed out: it must move first

    // While somebody has.
    double trust = 0.0;       ///< joins at 1; below 0 there is something to make up for
    double against_ms = 0.0;  ///< so long its arm or its size forbids it
    double same_side_ms = 0.0;
    bool ruled_out = false;   ///< until it leaves
    bool asked = false;       ///< whose hand it was before it got this id
    double outside_ms = 0.0;  ///< of the zone
    Stamp met;                ///< last close to the owner: a tracker may have mixed them up

    void forget_trust() noexcept;
    /// Two trackers' ids have changed places.
    void trade_trust(Acquaintance& other) noexcept;
    /// @param settled it may act, is slow and in the zone
    /// @param in it has joined
    void weigh(const GestureSettings& s, SameBody verdict, bool settled, bool in,
               double ms) noexcept;
};

/// All hands that are seen, and those that were a moment ago.
class Company {
 public:
    /// Notes what is seen now. @return the time since the last call, ms
    double note(const GestureSettings& s, std::span<const HandReport> hands, Stamp now);
    /// Of a hand that was never noted: an empty one.
    [[nodiscard]] Acquaintance& of(int hand_id);
    /// The hand that this one was before it was lost and came back under another id; null: none.
    [[nodiscard]] const Acquaintance* before(const GestureSettings& s,
                                             const Acquaintance& one) const;
    void forget_trust() noexcept;
    void forget_stillness() noexcept;

 private:
    static constexpr std::size_t kMost = 4 * kMaxHands;
    std::array<Acquaintance, kMost> all_{};
    Stamp last_;
};

}  // namespace xtrack::recognise
