// SPDX-License-Identifier: Apache-2.0
#include "gestures/segment/chamfer.hpp"

#include <algorithm>
#include <array>

namespace xtrack::segment {

namespace {

constexpr std::int32_t kDiagonal = 7;
constexpr std::int32_t kKnight = 11;

struct Step {
    int offset;
    std::int32_t cost;
};

/// The neighbours that a forward raster pass has already visited; negated: the backward pass.
std::array<Step, 8> forward_steps(int w) {
    return {{{-1, kChamferUnit},
             {-w, kChamferUnit},
             {-w - 1, kDiagonal},
             {-w + 1, kDiagonal},
             {-w - 2, kKnight},
             {-w + 2, kKnight},
             {-2 * w - 1, kKnight},
             {-2 * w + 1, kKnight}}};
}

/// Calls f(index) for the box in raster order, then g(index) in the opposite order.
template <typename F, typename G>
void there_and_back(const Grid& grid, Box box, F&& f, G&& g) {
    for (int y = box.y_begin; y < box.y_end; ++y) {
        const int row = grid.index(0, y);
        for (int i = row + box.x_begin; i < row + box.x_end; ++i) {
            f(static_cast<std::size_t>(i));
        }
    }
    for (int y = box.y_end - 1; y >= box.y_begin; --y) {
        const int row = grid.index(0, y);
        for (int i = row + box.x_end - 1; i >= row + box.x_begin; --i) {
            g(static_cast<std::size_t>(i));
        }
    }
}

}  // namespace

void spread_distance(const Grid& grid, Box box, std::span<std::int32_t> distance) {
    const auto w = static_cast<std::ptrdiff_t>(grid.width);
    std::int32_t* const all = distance.data();
    // Written out: this is the busiest loop of the segmentation.
    const auto lower = [all](std::size_t i, std::ptrdiff_t one, std::ptrdiff_t row) {
        std::int32_t* const d = all + i;
        if (*d <= kChamferUnit) {
            return;
        }
        const std::int32_t straight = std::min(d[one], d[row]) + kChamferUnit;
        const std::int32_t diagonal = std::min(d[row - one], d[row + one]) + kDiagonal;
        const std::int32_t knight = std::min(std::min(d[row - 2 * one], d[row + 2 * one]),
                                             std::min(d[2 * row - one], d[2 * row + one])) +
                                    kKnight;
        *d = std::min(std::min(*d, straight), std::min(diagonal, knight));
    };
    there_and_back(
        grid, box, [&](std::size_t i) { lower(i, -1, -w); },
        [&](std::size_t i) { lower(i, 1, w); });
}

void spread_balls(const Grid& grid, Box box, std::span<const int> label,
                  std::span<std::int32_t> ball) {
    const auto steps = forward_steps(grid.width);
    const auto raise = [&](std::size_t i, int sign) {
        if (label[i] == 0) {
            return;
        }
        std::int32_t b = ball[i];
        for (const Step s : steps) {
            const auto m = static_cast<std::size_t>(static_cast<int>(i) + sign * s.offset);
            const std::int32_t v = ball[m] - s.cost;
            b = v > b && label[m] == label[i] ? v : b;
        }
        ball[i] = b;
    };
    there_and_back(
        grid, box, [&](std::size_t i) { raise(i, 1); }, [&](std::size_t i) { raise(i, -1); });
}

}  // namespace xtrack::segment
