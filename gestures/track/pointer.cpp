// SPDX-License-Identifier: Apache-2.0
#include "gestures/track/pointer.hpp"

#include <algorithm>

namespace xtrack {

Pointer::Slot& Pointer::slot_of(int hand_id) noexcept {
    for (Slot& slot : slots_) {
        if (slot.hand_id == hand_id) {
            return slot;
        }
    }
    // As many slots as hands, so the one that was seen longest ago is of a hand that is gone.
    Slot& oldest = *std::min_element(slots_.begin(), slots_.end(),
                                     [](const Slot& a, const Slot& b) { return a.seen < b.seen; });
    oldest.hand_id = hand_id;
    oldest.filter.reset();
    return oldest;
}

void Pointer::update(HandFrame& frame) noexcept {
    for (Hand& hand : frame.all()) {
        Slot& slot = slot_of(hand.id);
        slot.seen = frame.stamp;
        hand.pointer_mm = slot.filter.filter(hand.palm_mm, frame.stamp);
    }
}

}  // namespace xtrack
