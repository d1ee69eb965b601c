// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include <xtrack/hand.hpp>
#include <xtrack/one_euro_filter.hpp>

namespace xtrack {

/// Sets Hand::pointer_mm of every hand. One filter a hand; a new id starts a new one, so that a
/// cursor never glides from one hand to another.
/// @thread one thread at a time
class Pointer {
 public:
    /// @param ahead how old the frame will be when its pointer is used: a hand that moves is put
    ///        where it will be by then, along its velocity; one at rest stays calm. At most 150 ms
    void update(HandFrame& frame, Duration ahead = Duration::zero()) noexcept;

 private:
    struct Slot {
        int hand_id = 0;  ///< 0: free
        Stamp seen;
        OneEuroFilter3 filter{OneEuroSettings{}};
    };
    Slot& slot_of(int hand_id, std::span<const Hand> in_frame) noexcept;

    std::array<Slot, kMaxHands> slots_;
};

}  // namespace xtrack
