// SPDX-License-Identifier: Apache-2.0
#include "gestures/track/pointer.hpp"

#include <algorithm>
#include <chrono>

namespace xtrack {

Pointer::Slot& Pointer::slot_of(int hand_id, std::span<const Hand> in_frame) noexcept {
    for (Slot& slot : slots_) {
        if (slot.hand_id == hand_id) {
            return slot;
        }
    }
    // As many slots as hands, so one at least is of a hand that is gone: until its turn comes a
    // hand of this frame looks as old as one that left just now.
    const auto is_gone = [&](const Slot& slot) {
        return std::none_of(in_frame.begin(), in_frame.end(),
                            [&](const Hand& hand) { return hand.id == slot.hand_id; });
    };
    Slot& oldest =
        *std::min_element(slots_.begin(), slots_.end(), [&](const Slot& a, const Slot& b) {
            return is_gone(a) != is_gone(b) ? is_gone(a) : a.seen < b.seen;
        });
    oldest.hand_id = hand_id;
    oldest.filter.reset();
    return oldest;
}

namespace {

// A hand's velocity holds no longer; more would overshoot where it turns.
constexpr Duration kFarthest = std::chrono::milliseconds{150};
// Velocity is a line fit over 100 ms, in which 2 mm of noise make 23 mm/s at 60 Hz: below three
// sigma nothing is known, from twice that on it is believed.
constexpr float kStillMmps = 70.0F;
constexpr float kMovingMmps = 140.0F;

/// How far the hand goes meanwhile.
Vec3f way_ahead(const Hand& hand, Duration ahead) {
    const auto seconds =
        static_cast<float>(to_seconds(std::clamp(ahead, Duration::zero(), kFarthest)));
    const float mmps = hand.palm_velocity_mmps.norm();
    if (!(mmps > kStillMmps)) {  // false for NaN
        return Vec3f::Zero();
    }
    const float share = std::min((mmps - kStillMmps) / (kMovingMmps - kStillMmps), 1.0F);
    return share * seconds * hand.palm_velocity_mmps;
}

}  // namespace

void Pointer::update(HandFrame& frame, Duration ahead) noexcept {
    for (Hand& hand : frame.all()) {
        Slot& slot = slot_of(hand.id, frame.all());
        slot.seen = frame.stamp;
        hand.pointer_mm = slot.filter.filter(hand.palm_mm, frame.stamp) + way_ahead(hand, ahead);
    }
}

}  // namespace xtrack
