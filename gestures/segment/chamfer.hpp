// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <span>

#include "gestures/segment/grid.hpp"

namespace xtrack::segment {

/// Distances are counted in fifths of a grid pixel: chamfer 5-7-11 (Borgefors 1986), within 2 %.
inline constexpr std::int32_t kChamferUnit = 5;
inline constexpr std::int32_t kChamferFar = std::numeric_limits<std::int32_t>::max() / 2;

/// Pixels [x_begin, x_end) x [y_begin, y_end) of the grid without padding.
struct Box {
    int x_begin = 0, y_begin = 0, x_end = 0, y_end = 0;
};

/// Lowers every distance in the box to the least of its neighbours' plus the step to it. Call with
/// seeds set to their start (0, or kChamferUnit) and everything else kChamferFar, including a rim
/// of kPad pixels round the box.
void spread_distance(const Grid& grid, Box box, std::span<std::int32_t> distance);

/// Raises every value in the box to the largest of its neighbours' minus the step to it, within one
/// label: the union of balls round seeds.
void spread_balls(const Grid& grid, Box box, std::span<const int> label,
                  std::span<std::int32_t> ball);

}  // namespace xtrack::segment
