// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <xtrack/frame.hpp>
#include <xtrack/stamp.hpp>

namespace xtrack {

/// From `start` on the projector shows `pattern`, until the next show begins.
/// @since 0.1
struct PatternShow {
    Stamp start;  ///< the moment the new picture is on the wall, on the clock of the frames
    int pattern = kUnknownPattern;  ///< index into the PatternSequence; unknown = black or other
};

/// When the rows of a frame were exposed. Row r of n is read out (r + 0.5 - n/2) * readout / n
/// after the middle row, so a global shutter is a readout of zero.
/// @since 0.1
struct FrameTiming {
    Stamp stamp;        ///< middle of the exposure of the middle row: Frame::stamp
    Duration exposure;  ///< of each row
    Duration readout;   ///< from the first row's exposure to one row after the last's
    int rows = 0;
};

/// Which pattern a frame saw, and in which rows it saw that pattern and no other.
/// @since 0.1
struct PatternAssignment {
    int pattern = kUnknownPattern;  ///< unknown when no row is clean
    int clean_row_begin = 0;        ///< Frame::clean_row_begin
    int clean_row_end = 0;          ///< Frame::clean_row_end; equal to begin when no row is clean
    friend bool operator==(const PatternAssignment&, const PatternAssignment&) = default;
};

/// Assigns a pattern to a frame when camera and projector run on their own clocks: a rolling
/// shutter beside a projector that holds each pattern for some time. A row is clean when its whole
/// exposure lies within the time of one pattern (shows of the same pattern in a row count as one).
/// The longest run of clean rows of one pattern wins; of two equally long ones the earlier rows.
/// Rows exposed before the first show are not clean; the last show has no end.
/// @param shows ordered by `start`; equal starts are allowed, the later entry wins
/// @param timing of the frame; a negative exposure or readout, or no row, gives the unknown pattern
/// @thread any; pure, allocates nothing
/// @since 0.1
[[nodiscard]] PatternAssignment assign_pattern(std::span<const PatternShow> shows,
                                               const FrameTiming& timing) noexcept;

}  // namespace xtrack
