// SPDX-License-Identifier: Apache-2.0
#include "gestures/session/event_queue.hpp"

namespace xtrack {

void EventQueue::push(const GestureEvent& event) {
    const MutexLock lock(mutex_);
    if (count_ == kCapacity) {
        oldest_ = (oldest_ + 1) % kCapacity;
        --count_;
        dropped_ += has_reader_ ? 1U : 0U;
    }
    ring_[(oldest_ + count_) % kCapacity] = event;
    ++count_;
}

bool EventQueue::pop(GestureEvent& event) {
    const MutexLock lock(mutex_);
    has_reader_ = true;
    if (count_ == 0) {
        return false;
    }
    event = ring_[oldest_];
    oldest_ = (oldest_ + 1) % kCapacity;
    --count_;
    return true;
}

std::uint64_t EventQueue::dropped() const {
    const MutexLock lock(mutex_);
    return dropped_;
}

}  // namespace xtrack
