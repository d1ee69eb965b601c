// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <xtrack/hand.hpp>
#include <xtrack/result.hpp>

namespace xtrack {

/// Moments that a joints.csv may hold: an hour at 60 a second, where a moment takes over a
/// kilobyte.
/// @since 0.1
inline constexpr std::size_t kMaxJointMoments = 250'000;

/// Reads joints.csv: one line a hand and moment, lines of equal `t_us` are one HandFrame, and an
/// empty `hand` is a moment without one (its other fields are not read). Each Hand carries id,
/// chirality, confidence (also the chirality's) and the joints that are there; nothing else is
/// worked out here. A joint needs all three of its coordinates or none; columns of joints may be
/// missing. Coordinates are the interaction frame's.
/// @return an Error that names the line and field: NaN, infinity or over 100 m, time that goes
///         backwards, more than kMaxHands hands or one hand_id twice in a moment (refused, not cut:
///         a reader that chose two would hide a broken tracker), a missing column, a row of fewer
///         fields than the header has, no line at all, over kMaxJointMoments, a file over 256 MiB
/// @thread any
/// @since 0.1
[[nodiscard]] Result<std::vector<HandFrame>> read_joint_recording(
    const std::filesystem::path& file);

/// The same of a text. @param name of the file, for messages
/// @since 0.1
[[nodiscard]] Result<std::vector<HandFrame>> parse_joint_recording(std::string_view text,
                                                                   const std::string& name);

/// The text that parse_joint_recording() reads back, to 0.01 mm.
/// @since 0.1
[[nodiscard]] std::string joint_recording_text(std::span<const HandFrame> frames);

/// That text in pieces, for what grows while it is recorded: the first line, and those of a moment.
/// @since 0.1
[[nodiscard]] std::string joint_recording_head();
[[nodiscard]] std::string joint_recording_lines(const HandFrame& frame);

/// Writes joints.csv, whole or not at all; an existing file is replaced.
/// @return an Error: a position is not finite, stamps decrease, the disk refuses
/// @since 0.1
[[nodiscard]] Result<void> write_joint_recording(const std::filesystem::path& file,
                                                 std::span<const HandFrame> frames);

}  // namespace xtrack
