// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <xtrack/hand.hpp>
#include <xtrack/source.hpp>

namespace xtrack {

/// Hands from any tracker: a recording of joints, a headset, a test.
/// @thread one thread at a time
/// @since 0.1
class HandSource {
 public:
    HandSource() = default;
    HandSource(const HandSource&) = delete;
    HandSource& operator=(const HandSource&) = delete;
    virtual ~HandSource() = default;

    /// Waits up to `timeout` and fills `hands` when the status is ok: interaction frame, and
    /// `hands.coordinates` says so. Sets `message` when lost or failed. Stamps never decrease.
    virtual SourceStatus next(Duration timeout, HandFrame& hands, std::string& message) = 0;
};

/// Hands that are in memory, one after the other.
/// @thread one thread at a time
/// @since 0.1
class HandSequence final : public HandSource {
 public:
    /// @param frames interaction frame; stamps must not decrease
    explicit HandSequence(std::vector<HandFrame> frames) : frames_(std::move(frames)) {}

    SourceStatus next(Duration /*timeout*/, HandFrame& hands, std::string& /*message*/) override {
        if (next_ == frames_.size()) {
            return SourceStatus::end;
        }
        hands = frames_[next_++];
        return SourceStatus::ok;
    }

 private:
    std::vector<HandFrame> frames_;
    std::size_t next_ = 0;
};

}  // namespace xtrack
