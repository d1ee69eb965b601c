// SPDX-License-Identifier: Apache-2.0
// What moves where every pattern is held for some frames: the move from one frame to the next. One
// of them often saw the switch of patterns; its rows are then a blend of two, whose shares what
// stands still tells.
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/pipeline/motion.hpp"
#include "core/pipeline/motion_pixels.hpp"

namespace xtrack {
namespace {

using motion::fringe_at;
using motion::inside;
using motion::saw_cells;

// Squared grey levels by which two patterns must differ in a row of cells, in all, to tell shares.
constexpr int kLeastContrast = 2000;

}  // namespace

// The frame so many before the newest, whatever its pattern; null if it was lost.
const MotionEstimator::Small* MotionEstimator::find_last(const FrameWindow& window,
                                                         const Small& now,
                                                         std::uint64_t ago) const noexcept {
    for (int pattern = 0; pattern < patterns_; ++pattern) {
        for (const FrameWindow::Entry& entry : window.entries(pattern)) {
            if (entry.frame && entry.count + ago == now.count &&
                entry.frame->sequence + ago == now.frame->sequence) {
                return find_small(&entry);
            }
        }
    }
    return nullptr;
}

bool MotionEstimator::saw_alike(const Small& now, const Small& before, int cy) const noexcept {
    return before.frame->pattern == now.frame->pattern &&
           saw_cells(*before.frame, cy, size_.height);
}

bool MotionEstimator::comparable(const Small& now, const Small& before, int cy) const noexcept {
    return saw_cells(*now.frame, cy, size_.height) &&
           (saw_alike(now, before, cy) ||
            (&before == blend_.of && blend_.shares[static_cast<std::size_t>(cy)] >= 0 &&
             saw_cells(*blend_.earlier->frame, cy, size_.height)));
}

void MotionEstimator::find_blend(const Small& now, const Small& before,
                                 const Small* earlier) noexcept {
    blend_.of = nullptr;
    const bool same = before.frame->pattern == now.frame->pattern;
    // Of the three frames two neighbours must be of one show, or nobody knows what was between.
    if (earlier == nullptr || same == (before.frame->pattern == earlier->frame->pattern)) {
        return;
    }
    blend_.of = &before;
    blend_.earlier = earlier;
    for (int cy = 0; cy < age_.height(); ++cy) {
        int& share = blend_.shares[static_cast<std::size_t>(cy)];
        share = -1;
        if (saw_cells(*before.frame, cy, size_.height)) {
            share = same ? kWhole : 0;
            continue;
        }
        // On the clean rows' other side another pattern would be in it.
        const bool switched = same ? cy * kCellPx < before.frame->clean_row_begin
                                   : (cy + 1) * kCellPx > before.frame->clean_row_end;
        if (!switched || !saw_cells(*now.frame, cy, size_.height) ||
            !saw_cells(*earlier->frame, cy, size_.height)) {
            continue;
        }
        int contrast = 0;
        int seen = 0;
        for (int cx = 0; cx < age_.width(); ++cx) {
            if (disturbed(cx, cy)) {
                continue;
            }
            const int first = earlier->cells.at(cx, cy);
            const int change = now.cells.at(cx, cy) - first;
            contrast += change * change;
            seen += change * (before.cells.at(cx, cy) - first);
        }
        if (contrast >= kLeastContrast) {
            share = std::clamp(static_cast<int>(std::int64_t{kWhole} * seen / contrast), 0, kWhole);
        }
    }
    fill_shares();
}

// Where what stands still is lit alike by both patterns, its neighbours tell: the shares change
// evenly from row to row.
void MotionEstimator::fill_shares() noexcept {
    const auto share_of = [&](int cy) -> int& {
        return blend_.shares[static_cast<std::size_t>(cy)];
    };
    int known = -1;
    for (int cy = 0; cy < age_.height(); ++cy) {
        const int share = share_of(cy);
        if (share < 0) {
            continue;
        }
        for (int between = known + 1; known >= 0 && between < cy; ++between) {
            share_of(between) =
                share_of(known) + (share - share_of(known)) * (between - known) / (cy - known);
        }
        known = cy;
    }
}

// Patterns that are held: the move from one frame to the next, where that shows most of what moves.
// Else the velocity stays what it was.
void MotionEstimator::follow_held(const Small& now, const Small* before) noexcept {
    int moved = 0;
    int shown = 0;
    std::int64_t shares = 0;
    for (int cy = 0; before != nullptr && cy < age_.height(); ++cy) {
        const bool both = comparable(now, *before, cy);
        const int share =
            saw_alike(now, *before, cy) ? kWhole : blend_.shares[static_cast<std::size_t>(cy)];
        for (int cx = 0; cx < age_.width(); ++cx) {
            if (disturbed(cx, cy)) {
                ++moved;
                shown += both ? 1 : 0;
                shares += both ? share : 0;
            }
        }
    }
    if (2 * shown > moved) {
        const Duration between = now_ - before->frame->stamp;
        velocity_ = Vec2f::Zero();
        if (enough_moved()) {
            const Shift shift = search(now, *before, to_seconds(between));
            const auto seconds = static_cast<float>(to_seconds(between));
            velocity_ = Vec2f(static_cast<float>(-shift.dx) / seconds,
                              static_cast<float>(-shift.dy) / seconds);
        }
        // Of a blend, the less of the newest pattern is in it the longer ago.
        const double ago =
            1.5 - static_cast<double>(shares) / (static_cast<double>(kWhole) * shown);
        remember(now_ -
                 Duration{static_cast<Duration::rep>(ago * static_cast<double>(between.count()))});
    }
    for (std::size_t n = 0; n < history_count_; ++n) {
        const Past& past = history_[n];
        moving_ = moving_ || (to_seconds(now_ - past.stamp) <= seconds_per_cycle_ &&
                              past.velocity != Vec2f::Zero());
    }
}

void MotionEstimator::find_stretches(const FrameWindow& window) noexcept {
    stretches_.clear();
    if (settings_.phases_rad.size() != kCycle || patterns_ != static_cast<int>(kCycle)) {
        return;
    }
    for (int y = 0; y < size_.height; ++y) {
        std::array<const Frame*, kCycle> frames{};
        for (std::size_t p = 0; p < kCycle; ++p) {
            frames[p] = window.clean(static_cast<int>(p), y);
            if (frames[p] == nullptr) {
                stretches_.clear();
                return;
            }
        }
        if (stretches_.empty() || frames != stretches_.back().cycle.frames) {
            stretches_.emplace_back().cycle.frames = frames;
        }
        stretches_.back().end = y + 1;
        stretch_of_row_[static_cast<std::size_t>(y)] =
            static_cast<std::uint8_t>(stretches_.size() - 1);
    }
}

void MotionEstimator::prepare_stretches() noexcept {
    for (const bool follow : {false, true}) {
        const std::size_t way = follow ? 1 : 0;
        for (Stretch& stretch : stretches_) {
            prepare_view(stretch.cycle, follow, stretch.cycle.views[way]);
        }
        for (Pair& pair : pairs_) {
            const double phase = phase_in(*pair.before, pair.before->pattern, follow);
            pair.cosine[way] = static_cast<float>(std::cos(phase));
            pair.sine[way] = static_cast<float>(std::sin(phase));
        }
    }
}

float MotionEstimator::surprise(int x, int y, bool follow) const noexcept {
    if (!inside(x, y, size_)) {
        return kNoMatch;
    }
    Fringe fringe;
    const std::size_t stretch = stretch_of_row_[static_cast<std::size_t>(y)];
    if (!look(stretches_[stretch].cycle, follow, x, y, fringe)) {
        return kNoMatch;
    }
    const std::size_t way = follow ? 1 : 0;
    float worst = 0.0F;
    for (const Pair& pair : pairs_) {
        const Shift shift = follow ? pair.to_before : Shift{};
        if (!inside(x + shift.dx, y + shift.dy, size_)) {
            return kNoMatch;
        }
        if (saw(*pair.before, y + shift.dy)) {
            const float expected =
                fringe.mean + fringe.re * pair.cosine[way] - fringe.im * pair.sine[way];
            const int seen = fringe_at(*pair.before, x + shift.dx, y + shift.dy);
            worst = std::max(worst, std::abs(static_cast<float>(seen) - expected));
        }
    }
    return worst;
}

}  // namespace xtrack
