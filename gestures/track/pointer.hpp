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
    void update(HandFrame& frame) noexcept;

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
