// SPDX-License-Identifier: Apache-2.0
#include "gestures/track/pointer.hpp"

#include <algorithm>

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

void Pointer::update(HandFrame& frame) noexcept {
    for (Hand& hand : frame.all()) {
        Slot& slot = slot_of(hand.id, frame.all());
        slot.seen = frame.stamp;
        hand.pointer_mm = slot.filter.filter(hand.palm_mm, frame.stamp);
    }
}

}  // namespace xtrack
