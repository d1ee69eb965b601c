// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include <xtrack/result.hpp>

#include "tools/bench/timing.hpp"

namespace xtrack::tools::bench {

/// The 2012 paper's table on this machine: 640 x 480 pixels, 307,200 points of float x, y, z.
struct PaperTimes {
    Times read;             ///< three grey PNG images, from memory to pixels
    Times decode;           ///< wrapped phase, unwrapping in space, points of float x, y, z
    Times decode_relative;  ///< the same without a rig: heights before a plane
    Times decode_depth;     ///< with one, to u16 depth and u8 quality, without float points
    std::size_t points = 0;
    double period_px = 0.0;
    double depth_error_mm = 0.0;  ///< median; what is wrong takes no time that means anything
};

/// What the paper reports, of a 2.66 GHz Core 2 Duo.
inline constexpr double kPaperRead_ms = 10.0;
inline constexpr double kPaperDecode_ms = 30.0;
inline constexpr double kPaperDisplay_ms = 33.0;

[[nodiscard]] Result<PaperTimes> measure_paper(std::size_t rounds,
                                               const std::function<void()>& step);

}  // namespace xtrack::tools::bench
