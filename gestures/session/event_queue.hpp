// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <xtrack/gesture_event.hpp>

#include "core/base/mutex.hpp"

namespace xtrack {

/// Events for a program that polls. Holds the newest kCapacity events; when it is full the oldest
/// is dropped, so that a reader which stalls finds the present and not the past. Drops are counted
/// from the first pop() on: a program that never polls has lost nothing.
/// @thread any
class EventQueue {
 public:
    static constexpr std::size_t kCapacity = 256;

    void push(const GestureEvent& event);
    /// False when there is none.
    bool pop(GestureEvent& event);
    [[nodiscard]] std::uint64_t dropped() const;

 private:
    mutable Mutex mutex_;
    std::array<GestureEvent, kCapacity> ring_ XTRACK_GUARDED_BY(mutex_);
    std::size_t oldest_ XTRACK_GUARDED_BY(mutex_) = 0;
    std::size_t count_ XTRACK_GUARDED_BY(mutex_) = 0;
    std::uint64_t dropped_ XTRACK_GUARDED_BY(mutex_) = 0;
    bool has_reader_ XTRACK_GUARDED_BY(mutex_) = false;
};

}  // namespace xtrack
