// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include <xtrack/result.hpp>

#include "tools/bench/motion/stroke.hpp"

namespace xtrack::tools::bench {

/// A recording with true depth and mask, decoded as it comes and with what moves followed.
struct RecordingReport {
    std::string name;
    std::string method;         ///< its patterns
    std::string not_decoded;    ///< why DepthDecoder refuses it; empty: it does not
    std::size_t frames = 0;     ///< in which the hand moves; of a hand that never does, all
    double mean_move_mm = 0.0;  ///< of the middle of the hand, from frame to frame, over these
    HandAccuracy as_it_comes;   ///< MotionHandling::off
    HandAccuracy followed;      ///< the decoder's defaults
};

/// A hand moves in a frame if it does so far since the frame before, mm.
inline constexpr double kMoves_mm = 2.5;

/// @return an Error: not a fringe recording with truth, or it cannot be read
[[nodiscard]] Result<RecordingReport> measure_recording(const std::filesystem::path& folder);

}  // namespace xtrack::tools::bench
