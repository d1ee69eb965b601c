// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <optional>

#include <xtrack/session.hpp>
#include <xtrack/stamp.hpp>

namespace xtrack {

/// The one place that relates a stream's stamps to the wall clock.
/// @thread begin(), note_read() and due(): the one that reads the source; now(): any
class StreamClock {
 public:
    using Wall = std::chrono::steady_clock;

    /// @param delivery_delay from an item's stamp to the moment it can be had
    explicit StreamClock(Pace pace, Duration delivery_delay = Duration::zero())
        : pace_(pace), delivery_delay_(delivery_delay) {}

    /// Tells the first stamp of the stream; later calls change nothing.
    void begin(Stamp first) {
        if (!first_) {
            first_ = first;
            start_ = Wall::now();
        }
    }

    /// Tells how long the source took to make an item. A simulator may be slower than the time it
    /// simulates, as no camera is: for as long as that made the item late the clock stands still.
    /// What is late for any other reason stays so.
    /// @param took all that was spent on asking for it, time-outs in between included @pre begin()
    void note_read(Stamp stamp, Wall::duration took, Wall::time_point got) {
        if (pace_ == Pace::own_pace) {
            start_ += std::clamp(got - due(stamp), Wall::duration::zero(), took);
        }
    }

    /// When an item with this stamp may be processed. @pre begin()
    [[nodiscard]] Wall::time_point due(Stamp stamp) const {
        return pace_ == Pace::own_pace ? start_ + (stamp - *first_) + delivery_delay_
                                       : Wall::time_point::min();
    }

    /// Now, on the stream's clock; `newest` is the newest stamp seen, which is all the time there
    /// is in a replay, and `was_due` the due() of its item.
    [[nodiscard]] Stamp now(Stamp newest, Wall::time_point was_due) const {
        switch (pace_) {
            case Pace::replay: return newest;
            case Pace::own_pace: return newest + delivery_delay_ + (Wall::now() - was_due);
            case Pace::live: break;
        }
        return {std::chrono::duration_cast<Duration>(Wall::now().time_since_epoch()).count()};
    }

 private:
    Pace pace_;
    Duration delivery_delay_;
    std::optional<Stamp> first_;
    Wall::time_point start_;
};

}  // namespace xtrack
