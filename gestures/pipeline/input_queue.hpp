// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "core/base/mutex.hpp"
#include "gestures/pipeline/input.hpp"

namespace xtrack {

/// Between the thread that reads a live source and the one that processes. Holds kCapacity items;
/// when full the oldest is dropped and counted: a late frame is worth less than a fresh one. Four
/// frames ride out a hiccup of 67 ms at 60 fps. The last word of a source (end, failed) is never
/// dropped.
/// @thread one producer, one consumer
class InputQueue {
 public:
    static constexpr std::size_t kCapacity = 4;

    /// Swaps `item` in; what comes back in it are buffers to fill again.
    void push(InputItem& item) {
        {
            const MutexLock lock(mutex_);
            if (count_ == kCapacity) {
                oldest_ = (oldest_ + 1) % kCapacity;
                --count_;
                ++dropped_;
            }
            std::swap(ring_[(oldest_ + count_) % kCapacity], item);
            ++count_;
        }
        changed_.notify_one();
    }

    /// Swaps the oldest item out. False when none came within `timeout` or the queue was closed.
    bool pop(InputItem& item, Duration timeout) {
        const auto deadline = std::chrono::steady_clock::now() + timeout;
        const MutexLock lock(mutex_);
        while (count_ == 0 && !closed_) {
            if (changed_.wait_until(mutex_, deadline) == std::cv_status::timeout) {
                break;
            }
        }
        if (count_ == 0 || closed_) {
            return false;
        }
        std::swap(ring_[oldest_], item);
        oldest_ = (oldest_ + 1) % kCapacity;
        --count_;
        return true;
    }

    /// Waits until `due`; false as soon as the queue is closed.
    bool wait_until(std::chrono::steady_clock::time_point due) {
        const MutexLock lock(mutex_);
        while (!closed_) {
            if (closing_.wait_until(mutex_, due) == std::cv_status::timeout) {
                break;
            }
        }
        return !closed_;
    }

    void close() {
        {
            const MutexLock lock(mutex_);
            closed_ = true;
        }
        changed_.notify_all();
        closing_.notify_all();
    }

    [[nodiscard]] bool closed() const {
        const MutexLock lock(mutex_);
        return closed_;
    }
    [[nodiscard]] std::uint64_t dropped() const {
        const MutexLock lock(mutex_);
        return dropped_;
    }

 private:
    mutable Mutex mutex_;
    ConditionVariable changed_;
    ConditionVariable closing_;
    std::array<InputItem, kCapacity> ring_ XTRACK_GUARDED_BY(mutex_);
    std::size_t oldest_ XTRACK_GUARDED_BY(mutex_) = 0;
    std::size_t count_ XTRACK_GUARDED_BY(mutex_) = 0;
    std::uint64_t dropped_ XTRACK_GUARDED_BY(mutex_) = 0;
    bool closed_ XTRACK_GUARDED_BY(mutex_) = false;
};

}  // namespace xtrack
