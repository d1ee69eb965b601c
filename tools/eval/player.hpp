// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <xtrack/session.hpp>

namespace xtrack::tools {

/// One item of a recording as the recogniser meets it.
struct Moment {
    Stamp now;         ///< of the item
    HandFrame hands;   ///< interaction frame; their stamp is the depth image's
    bool seen = true;  ///< false: the item gave no depth, and time alone went on
};

/// A recording up to its hands. Images are decoded once, gestures recognised as often as needed.
struct PlayedRecording {
    std::vector<Moment> moments;
    bool metric = true;  ///< Session::metric()
    Stamp begin;         ///< of the first hands
    Duration length = Duration::zero();
};

/// Fringes, depth or joints: the session finds out.
/// @errors as Session::open() and Session::run()
[[nodiscard]] Result<PlayedRecording> play_recording(const std::string& folder,
                                                     const SessionOptions& options);

/// The events that a session with these settings gives of the recording, every one of them.
/// @errors invalid_argument: a setting out of its range
[[nodiscard]] Result<std::vector<GestureEvent>> recognise(const PlayedRecording& recording,
                                                          GestureSettings settings);

}  // namespace xtrack::tools
