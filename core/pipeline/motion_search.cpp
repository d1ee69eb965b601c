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
            const int x = cell[0] + dx;
            const int y = cell[1] + dy;
            const int difference =
                inside(x, y, before.cells.size()) && saw_cells(*before.frame, y, size_.height)
                    ? std::abs(now.cells.at(cell[0], cell[1]) - before.cells.at(x, y))
                    : kCostCap;
            cost += std::min(difference, kCostCap);
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

template <class Now, class Before, class Saw>
Shift MotionEstimator::search_pixels(const Now& now, const Before& before, const Saw& saw_row,
                                     Shift around, int radius, int step) const noexcept {
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
                if (!inside(x, y, size_)) {
                    continue;
                }
                const int difference = inside(x + dx, y + dy, size_) && saw_row(y + dy)
                                           ? std::abs(now(x, y) - before(x + dx, y + dy))
                                           : kCostCap;
                cost += std::min(difference, kCostCap);
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
    const auto now_at = [&](int x, int y) { return grey_at(*now.frame, x, y); };
    const auto before_at = [&](int x, int y) { return grey_at(*before.frame, x, y); };
    const auto saw_row = [&](int y) { return saw(*before.frame, y); };
    Shift shift = search_cells(now, before, seconds);
    shift = search_pixels(now_at, before_at, saw_row, shift, kCellPx - 2, 2);
    return search_pixels(now_at, before_at, saw_row, shift, 1, 1);
}

Shift MotionEstimator::search_cycles(double seconds) const noexcept {
    const auto now_at = [&](int x, int y) { return mean_at(cycles_[0], x, y); };
    const auto before_at = [&](int x, int y) { return mean_at(cycles_[1], x, y); };
    const auto saw_row = [](int) { return true; };
    Shift shift = search_cells(mean_cells_[0], mean_cells_[1], seconds);
    shift = search_pixels(now_at, before_at, saw_row, shift, kCellPx - 2, 2);
    return search_pixels(now_at, before_at, saw_row, shift, 1, 1);
}

}  // namespace xtrack
