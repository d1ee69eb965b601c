// SPDX-License-Identifier: Apache-2.0
// What moves where every pattern is held for some frames: the move from one frame of a show to the
// next. The first of them often saw the switch of patterns; its rows are then a blend of two, whose
// shares what stands still tells.
#include <algorithm>
#include <cstdint>

#include "core/pipeline/motion.hpp"
#include "core/pipeline/motion_pixels.hpp"

namespace xtrack {
namespace {

using motion::saw_cells;

// Squared grey levels by which two patterns must differ in a row of cells, in all, to tell shares.
constexpr int kLeastContrast = 2000;

}  // namespace

void MotionEstimator::find_blend(const FrameWindow& window, const Small& now,
                                 const Small& show) noexcept {
    blend_.of = nullptr;
    for (int pattern = 0; pattern < patterns_; ++pattern) {
        for (const FrameWindow::Entry& entry : window.entries(pattern)) {
            if (entry.frame && entry.count + 1 == show.count &&
                entry.frame->sequence + 1 == show.frame->sequence) {
                blend_.earlier = find_small(&entry);
                blend_.of = blend_.earlier != nullptr ? &show : nullptr;
            }
        }
    }
    if (blend_.of == nullptr) {
        return;
    }
    for (int cy = 0; cy < age_.height(); ++cy) {
        int& share = blend_.shares[static_cast<std::size_t>(cy)];
        share = -1;
        // Later rows would have seen the pattern after.
        if (cy * kCellPx >= show.frame->clean_row_begin ||
            !saw_cells(*now.frame, cy, size_.height) ||
            !saw_cells(*blend_.earlier->frame, cy, size_.height)) {
            continue;
        }
        int contrast = 0;
        int seen = 0;
        for (int cx = 0; cx < age_.width(); ++cx) {
            if (disturbed(cx, cy)) {
                continue;
            }
            const int earlier = blend_.earlier->cells.at(cx, cy);
            const int change = now.cells.at(cx, cy) - earlier;
            contrast += change * change;
            seen += change * (show.cells.at(cx, cy) - earlier);
        }
        if (contrast >= kLeastContrast) {
            share = std::clamp(static_cast<int>(std::int64_t{kWhole} * seen / contrast), 0, kWhole);
        }
    }
    fill_shares(show.frame->clean_row_begin / kCellPx);
}

// Where what stands still is lit alike by both patterns, its neighbours tell: the shares change
// evenly from row to row, and are whole from the clean rows on.
void MotionEstimator::fill_shares(int clean_row) noexcept {
    const auto share_of = [&](int cy) -> int& {
        return blend_.shares[static_cast<std::size_t>(cy)];
    };
    int known = -1;
    for (int cy = 0; cy <= std::min(clean_row, age_.height() - 1); ++cy) {
        int share = cy == clean_row && share_of(cy) < 0 ? kWhole : share_of(cy);
        if (share < 0) {
            continue;
        }
        for (int between = known + 1; known >= 0 && between < cy; ++between) {
            share_of(between) =
                share_of(known) + (share - share_of(known)) * (between - known) / (cy - known);
        }
        share_of(cy) = share;
        known = cy;
    }
}

// Patterns that are held: the move from one frame of a show to the next. Without such a frame the
// velocity stays what it was.
void MotionEstimator::follow_held(const Small& now, const Small* before) noexcept {
    if (before != nullptr) {
        const Duration between = now_ - before->frame->stamp;
        velocity_ = Vec2f::Zero();
        if (enough_moved()) {
            const Shift shift = search(now, *before, to_seconds(between));
            const auto seconds = static_cast<float>(to_seconds(between));
            velocity_ = Vec2f(static_cast<float>(-shift.dx) / seconds,
                              static_cast<float>(-shift.dy) / seconds);
        }
        remember(now_ - between / 2);
    }
    for (std::size_t n = 0; n < history_count_; ++n) {
        const Past& past = history_[n];
        moving_ = moving_ || (to_seconds(now_ - past.stamp) <= seconds_per_cycle_ &&
                              past.velocity != Vec2f::Zero());
    }
}

}  // namespace xtrack
