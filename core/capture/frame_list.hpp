// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <xtrack/recording.hpp>
#include <xtrack/result.hpp>

namespace xtrack::capture {

/// Reads frames.csv. Names must stay inside the folder and end in png, jpg or jpeg; stamps must not
/// decrease; pattern indices must be below `patterns`, and one row at least names its own.
/// `clean_begin` and `clean_end` may be missing, and empty where all rows are clean.
/// @param name of the file, for messages
/// @param patterns how many there are; 0 for depth, where the column may be missing and is not read
[[nodiscard]] Result<std::vector<RecordingEntry>> parse_frame_list(std::string_view text,
                                                                   const std::string& name,
                                                                   std::size_t patterns);

/// The text that parse_frame_list() reads back; its first line; the line of an image.
[[nodiscard]] std::string frame_list_text(const std::vector<RecordingEntry>& entries);
[[nodiscard]] std::string frame_list_head();
[[nodiscard]] std::string frame_list_line(const RecordingEntry& entry);

}  // namespace xtrack::capture
