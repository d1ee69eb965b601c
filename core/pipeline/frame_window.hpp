// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <xtrack/frame.hpp>

namespace xtrack {

/// The frames of the two newest shows of every pattern: what a sliding window can need. A show is a
/// stretch of frames that saw one pattern without another between: one frame where camera and
/// projector are locked, two or more where a pattern is held. The older show serves rows that the
/// newer did not see cleanly, taps that span more than one cycle, and the search for motion.
/// @ownership shares the frames
class FrameWindow {
 public:
    static constexpr std::size_t kFramesPerShow = 2;
    static constexpr std::size_t kDepth = 2 * kFramesPerShow;

    struct Entry {
        FramePtr frame;
        std::uint64_t count = 0;  // of pushes, from 1
        std::uint64_t show = 0;   // of shows, from 1
    };

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
    /// All frames of a pattern, newest first; those after the first empty entry are empty.
    [[nodiscard]] std::span<const Entry> entries(int pattern) const noexcept {
        return slot(pattern);
    }
    /// The frame with most clean rows of a pattern's newest show (0) or the one before it (1); null
    /// if there is none.
    [[nodiscard]] const Entry* fullest(int pattern, int shows_ago) const noexcept;
    /// The frame before the newest of a pattern, of the same show; null if there is none.
    [[nodiscard]] const Entry* held(int pattern) const noexcept;
    /// Frames of the show before the newest one, whatever its pattern.
    [[nodiscard]] int frames_of_last_show() const noexcept { return last_show_frames_; }

    /// The newest frame of a pattern that saw image row y cleanly; null if there is none.
    [[nodiscard]] const Frame* clean(int pattern, int y) const noexcept;
    /// The frames of one show of a pattern that saw row y cleanly, newest first, of the newest show
    /// of which one did.
    /// @return how many; 0: none
    [[nodiscard]] std::size_t clean_show(
        int pattern, int y, std::array<const Frame*, kFramesPerShow>& frames) const noexcept;

    /// The last `count` frames pushed, oldest first, if none was lost among them, they show the
    /// patterns in order, and all saw row y cleanly.
    /// @return false if not; `frames` is then unspecified
    [[nodiscard]] bool consecutive(int y, std::span<const Frame*> frames) const noexcept;

    /// Row numbers at which the choice of frames may change: 0 ... height, ascending.
    [[nodiscard]] std::span<const int> row_edges(int height) noexcept;

 private:
    using Slot = std::array<Entry, kDepth>;
    [[nodiscard]] const Slot& slot(int pattern) const noexcept {
        return slots_[static_cast<std::size_t>(pattern)];
    }
    static void make_room(Slot& slot, std::uint64_t show) noexcept;

    std::vector<Slot> slots_;
    std::vector<int> row_edges_;
    std::uint64_t pushed_ = 0;
    std::uint64_t shows_ = 0;
    int show_frames_ = 0;
    int last_show_frames_ = 0;
    int pattern_ = kUnknownPattern;  // of the newest frame
    std::uint64_t sequence_ = 0;     // of the newest frame
};

/// True where a frame saw row y with one pattern alone.
[[nodiscard]] inline bool saw(const Frame& frame, int y) noexcept {
    return y >= frame.clean_row_begin && y < frame.clean_row_end;
}

}  // namespace xtrack
