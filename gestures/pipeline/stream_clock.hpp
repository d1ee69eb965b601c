// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <optional>

#include <xtrack/session.hpp>
#include <xtrack/stamp.hpp>

namespace xtrack {

/// The one place that relates a stream's stamps to the wall clock.
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

    /// When an item with this stamp may be processed. @pre begin()
    [[nodiscard]] Wall::time_point due(Stamp stamp) const {
        return pace_ == Pace::own_pace ? start_ + (stamp - *first_) + delivery_delay_
                                       : Wall::time_point::min();
    }

    /// Now, on the stream's clock; `newest` is the newest stamp seen, which is all the time there
    /// is in a replay.
    [[nodiscard]] Stamp now(Stamp newest) const {
        switch (pace_) {
            case Pace::replay: return newest;
            case Pace::own_pace:
                return first_ ? *first_ + std::chrono::duration_cast<Duration>(Wall::now() - start_)
                              : newest;
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
