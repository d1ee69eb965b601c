// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <CLI/App.hpp>
#include <xtrack/recording.hpp>
#include <xtrack/session.hpp>

#include "tools/event_output.hpp"

namespace xtrack::tools {

/// What `run` and `replay` share: which gestures, and what is printed.
struct StreamOptions {
    std::optional<std::string> gestures;
    EventFormat events = EventFormat::text;
    EventFormat hands = EventFormat::none;
    std::vector<std::string> changes;  ///< of settings of decoder and gestures, NAME=VALUE
    bool why = false;                  ///< the gestures' state machines tell what they do
    bool statistics = false;
    bool json = false;
    std::optional<CaptureMode> mode;  ///< wanted: fringes are unwrapped in space
    bool without_rig = false;
    bool control = false;  ///< settings are read from standard input while it runs
};

void add_stream_options(CLI::App& command, StreamOptions& options);

/// Turns a list such as `swipe,pinch` into switches.
/// @errors invalid_argument: names the one that is not known, and those that are
[[nodiscard]] Result<void> choose_gestures(const std::optional<std::string>& list,
                                           GestureSettings& settings);

/// What the options ask of a session.
/// @errors invalid_argument: a gesture or a setting that is none
[[nodiscard]] Result<SessionOptions> session_options(const StreamOptions& stream, Pace pace);

/// Whether the source allows what was asked for.
/// @errors unsupported: a gesture that compares what is smaller than a hand, without a calibration;
///         invalid_argument: there is no calibration to do without, or a setting that would do
///         nothing
[[nodiscard]] Result<void> check_stream(const Session& session, const StreamOptions& options);

/// Runs a session to its end and prints. @param whole what is interrupted is not the whole answer:
/// a recording's @param items how many the source holds, for a progress bar; 0 = not known
/// @return the exit status
int play(Session& session, const StreamOptions& options, Pace pace, bool whole,
         std::size_t items = 0);

/// Where the mend is to unwrap in space: how that is said to run and replay.
[[nodiscard]] Error with_mode(Error error);

/// Where stderr is closed or full nothing can be said any more, and the exit status must do.
void print_error(const std::string& text);

/// Print `xtrack: message` on stderr. @return the exit status of a failure, 1, or of wrong usage, 2
int fail(const Error& error);
int usage(const Error& error);

/// Of a fringe recording that gave no depth at all.
[[nodiscard]] Error no_complete_set(const RecordingReader& recording);

}  // namespace xtrack::tools
