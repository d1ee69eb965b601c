// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <xtrack/frame.hpp>

namespace xtrack {

/// The two newest frames of every pattern: what a sliding window can need. The older one serves
/// rows that the newer did not see cleanly, and taps that span more than one cycle.
/// @ownership shares the frames
class FrameWindow {
 public:
    static constexpr std::size_t kDepth = 2;

    explicit FrameWindow(int patterns) : slots_(static_cast<std::size_t>(patterns)) {
        row_edges_.reserve(2 * kDepth * slots_.size() + 2);
    }

    /// @pre frame->pattern is an index into the sequence
    void push(const FramePtr& frame) noexcept;
    void clear() noexcept;

    [[nodiscard]] bool has(int pattern) const noexcept { return newest(pattern) != nullptr; }
    /// The newest frame of a pattern; null if there is none.
    [[nodiscard]] const Frame* newest(int pattern) const noexcept {
        return slot(pattern)[0].frame.get();
    }
    /// The frame of a pattern before its newest; null if there is none.
    [[nodiscard]] const Frame* previous(int pattern) const noexcept {
        return slot(pattern)[1].frame.get();
    }
    /// The newest frame of a pattern that saw image row y cleanly; null if there is none.
    [[nodiscard]] const Frame* clean(int pattern, int y) const noexcept;

    /// The last `count` frames pushed, oldest first, if none was lost among them, they show the
    /// patterns in order, and all saw row y cleanly.
    /// @return false if not; `frames` is then unspecified
    [[nodiscard]] bool consecutive(int y, std::span<const Frame*> frames) const noexcept;

    /// Row numbers at which the choice of frames may change: 0 ... height, ascending.
    [[nodiscard]] std::span<const int> row_edges(int height) noexcept;

 private:
    struct Entry {
        FramePtr frame;
        std::uint64_t count = 0;  // of pushes, from 1
    };
    using Slot = std::array<Entry, kDepth>;
    [[nodiscard]] const Slot& slot(int pattern) const noexcept {
        return slots_[static_cast<std::size_t>(pattern)];
    }

    std::vector<Slot> slots_;
    std::vector<int> row_edges_;
    std::uint64_t pushed_ = 0;
};

}  // namespace xtrack
