// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "core/pipeline/motion.hpp"
#include "core/pipeline/motion_pixels.hpp"

namespace xtrack {
namespace {

using motion::grey_at;
using motion::inside;
using motion::kCostCap;
using motion::saw_cells;

// A match that is farther from the one expected must be better by this much a cell, grey levels:
// fine fringes match themselves a period away.
constexpr float kExpectedAdvantage = 0.3F;
// Cells that are enough to tell where the others went, spread over all of them.
constexpr std::size_t kEnoughCells = 256;

}  // namespace

Shift MotionEstimator::search_cells(const Small& now, const Small& before,
                                    double seconds) const noexcept {
    const int reach = settings_.max_shift_px / kCellPx;
    // No farther than the search goes: the cost of being far from it must fit an int.
    const auto farthest = static_cast<float>(settings_.max_shift_px);
    const Vec2f expected = history_count_ > 0
                               ? Vec2f((-history_[0].velocity * static_cast<float>(seconds))
                                           .cwiseMax(-farthest)
                                           .cwiseMin(farthest))
                               : Vec2f(Vec2f::Zero());
    const std::size_t every = 1 + active_cells_.size() / kEnoughCells;
    const std::size_t cells = active_cells_.size() / every;
    const auto looked_at = static_cast<float>(cells);
    // Stops once it is no better than `limit`.
    const auto cost_of = [&](int dx, int dy, int limit) {
        const Vec2f candidate(static_cast<float>(dx * kCellPx), static_cast<float>(dy * kCellPx));
        int cost = history_count_ == 0
                       ? 0
                       : static_cast<int>((candidate - expected).norm() *
                                          (kExpectedAdvantage / kCellPx) * looked_at);
        for (std::size_t n = 0; n < active_cells_.size() && cost < limit; n += every) {
            const auto& cell = active_cells_[n];
            cost += std::min(cells_differ(now, before, cell[0], cell[1], dx, dy), kCostCap);
        }
        return cost;
    };
    // What is likely comes first: the rest is then soon given up.
    const auto cell_of = [&](float px) {
        return std::clamp(static_cast<int>(std::lround(px / kCellPx)), -reach, reach);
    };
    Shift best{cell_of(expected.x()), cell_of(expected.y())};
    int best_cost = cost_of(best.dx, best.dy, std::numeric_limits<int>::max());
    for (int dy = -reach; dy <= reach; ++dy) {
        for (int dx = -reach; dx <= reach; ++dx) {
            const int cost = cost_of(dx, dy, best_cost);
            if (cost < best_cost) {
                best_cost = cost;
                best = {dx, dy};
            }
        }
    }
    return {best.dx * kCellPx, best.dy * kCellPx};
}

template <class Differ>
Shift MotionEstimator::search_pixels(const Differ& differ, Shift around, int radius,
                                     int step) const noexcept {
    const auto cost_of = [&](int dx, int dy, int limit) {
        int cost = 0;
        for (const auto& cell : active_cells_) {
            // Four spread pixels stand for the cell.
            constexpr int kNear = kCellPx / 4;
            constexpr int kFar = kCellPx - kNear;
            constexpr int kSamples[4][2] = {
                {kNear, kNear}, {kFar, kNear}, {kNear, kFar}, {kFar, kFar}};
            for (const auto& sample : kSamples) {
                const int x = cell[0] * kCellPx + sample[0];
                const int y = cell[1] * kCellPx + sample[1];
                if (inside(x, y, size_)) {
                    cost += std::min(differ(x, y, dx, dy), kCostCap);
                }
            }
            if (cost >= limit) {
                break;
            }
        }
        return cost;
    };
    Shift best = around;
    int best_cost = cost_of(around.dx, around.dy, std::numeric_limits<int>::max());
    for (int dy = around.dy - radius; dy <= around.dy + radius; dy += step) {
        for (int dx = around.dx - radius; dx <= around.dx + radius; dx += step) {
            const int cost = cost_of(dx, dy, best_cost);
            if (cost < best_cost) {
                best_cost = cost;
                best = {dx, dy};
            }
        }
    }
    return best;
}

Shift MotionEstimator::search(const Small& now, const Small& before,
                              double seconds) const noexcept {
    const auto differ = [&](int x, int y, int dx, int dy) {
        return pixels_differ(now, before, x, y, dx, dy);
    };
    Shift shift = search_cells(now, before, seconds);
    shift = search_pixels(differ, shift, kCellPx - 2, 2);
    return search_pixels(differ, shift, 1, 1);
}

Shift MotionEstimator::search_cycles(double seconds) const noexcept {
    const auto differ = [&](int x, int y, int dx, int dy) {
        return inside(x + dx, y + dy, size_)
                   ? std::abs(mean_at(cycles_[0], x, y) - mean_at(cycles_[1], x + dx, y + dy))
                   : kCostCap;
    };
    Shift shift = search_cells(mean_cells_[0], mean_cells_[1], seconds);
    shift = search_pixels(differ, shift, kCellPx - 2, 2);
    return search_pixels(differ, shift, 1, 1);
}

int MotionEstimator::cells_differ(const Small& now, const Small& before, int cx, int cy, int dx,
                                  int dy) const noexcept {
    const Size cells = before.cells.size();
    if (!inside(cx + dx, cy + dy, cells)) {
        return kCostCap;
    }
    const int here = now.cells.at(cx, cy);
    const int there = before.cells.at(cx + dx, cy + dy);
    if (saw_alike(now, before, cy + dy)) {
        return std::abs(here - there);
    }
    // What moves at constant velocity was as far away again in the image before that.
    if (&before != blend_.of || !inside(cx + 2 * dx, cy + 2 * dy, cells)) {
        return kCostCap;
    }
    return blend_differs(here, there, blend_.earlier->cells.at(cx + 2 * dx, cy + 2 * dy), cy + dy,
                         cy + 2 * dy);
}

int MotionEstimator::pixels_differ(const Small& now, const Small& before, int x, int y, int dx,
                                   int dy) const noexcept {
    if (!inside(x + dx, y + dy, size_)) {
        return kCostCap;
    }
    const int here = grey_at(*now.frame, x, y);
    const int there = grey_at(*before.frame, x + dx, y + dy);
    if (before.frame->pattern == now.frame->pattern && saw(*before.frame, y + dy)) {
        return std::abs(here - there);
    }
    if (&before != blend_.of || !inside(x + 2 * dx, y + 2 * dy, size_)) {
        return kCostCap;
    }
    const int last = age_.height() - 1;
    return blend_differs(here, there, grey_at(*blend_.earlier->frame, x + 2 * dx, y + 2 * dy),
                         std::min((y + dy) / kCellPx, last),
                         std::min((y + 2 * dy) / kCellPx, last));
}

int MotionEstimator::blend_differs(int now, int mixed, int earlier, int mixed_row,
                                   int earlier_row) const noexcept {
    const int share = blend_.shares[static_cast<std::size_t>(mixed_row)];
    if (share < 0 || !saw_cells(*blend_.earlier->frame, earlier_row, size_.height)) {
        return kCostCap;
    }
    return std::abs(mixed * kWhole - now * share - earlier * (kWhole - share)) / kWhole;
}

}  // namespace xtrack
