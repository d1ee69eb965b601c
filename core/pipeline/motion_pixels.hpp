// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/pipeline/motion.hpp"

// What the parts of the motion estimator share about single pixels and cells.
namespace xtrack::motion {

// A mismatch costs at most this, grey levels: pixels that were covered or uncovered match nowhere
// and must not drag the estimate.
inline constexpr int kCostCap = 40;

// The mean of the colours stands for grey: colour fringes all but vanish in it, and what is left is
// what moves.
inline int mean_of(const std::uint8_t* bgr) noexcept {
    constexpr int kThird = 21846;  // 65536 / 3
    return ((bgr[0] + bgr[1] + bgr[2]) * kThird) >> 16;
}

inline int grey_at(const Frame& frame, int x, int y) noexcept {
    const std::uint8_t* row = frame.pixels.row(y);
    return frame.format == PixelFormat::grey8 ? row[x] : mean_of(row + 3 * x);
}

// Where the fringes are, the colour that sensors see best stands for grey.
inline int fringe_at(const Frame& frame, int x, int y) noexcept {
    const std::uint8_t* row = frame.pixels.row(y);
    return frame.format == PixelFormat::grey8 ? row[x] : row[3 * x + 1];
}

inline bool inside(int x, int y, Size size) noexcept {
    return x >= 0 && y >= 0 && x < size.width && y < size.height;
}

// True where the frame saw every row of a row of cells.
inline bool saw_cells(const Frame& frame, int cy, int rows) noexcept {
    return saw(frame, cy * MotionEstimator::kCellPx) &&
           saw(frame, std::min((cy + 1) * MotionEstimator::kCellPx, rows) - 1);
}

}  // namespace xtrack::motion
