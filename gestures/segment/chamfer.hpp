// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "gestures/segment/grid.hpp"

namespace xtrack::segment {

/// Distances are counted in fifths of a grid pixel: chamfer 5-7-11 (Borgefors 1986), within 2 %.
inline constexpr int kChamferUnit = 5;
/// Distances are written as nearness: this where the distance is 0, less by kChamferUnit a pixel,
/// and 0 where it is not known.
inline constexpr std::uint16_t kNearnessMax = 65535;

/// Raises every value in the box to the largest of its neighbours' minus the step to it: turns
/// seeds of nearness into nearness to the nearest seed. A rim of kPad pixels round the box is read.
/// @param label where not empty: nothing spreads from one label to another; the rim is read, too
void spread(const Grid& grid, const Box& box, std::span<std::uint16_t> value,
            std::span<const std::uint16_t> label = {});

/// The distance that a nearness stands for, grid px.
[[nodiscard]] inline float distance_px(std::uint16_t nearness) noexcept {
    return static_cast<float>(kNearnessMax - nearness) * (1.0F / static_cast<float>(kChamferUnit));
}

/// What spread() does, for the forms of it.
struct SpreadRows {
    std::uint16_t* value = nullptr;        ///< first pixel of the box
    const std::uint16_t* label = nullptr;  ///< the same; nullptr: all is one
    std::ptrdiff_t stride = 0;             ///< pixels from one row to the next
    int count = 0;                         ///< pixels of a row
    int rows = 0;
};
inline constexpr int kChamferDiagonal = 7;
inline constexpr int kChamferKnight = 11;

/// The reference form, plain C++.
void spread_rows_scalar(const SpreadRows& box) noexcept;

#if XTRACK_WITH_HIGHWAY
/// The same values by the fastest form that this CPU has.
void spread_rows_highway(const SpreadRows& box) noexcept;
#endif

}  // namespace xtrack::segment
