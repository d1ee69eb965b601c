// SPDX-License-Identifier: Apache-2.0
// What two whole cycles of three images say about what moves. A surface that slides along the
// fringes' axis carries its shape along but not its fringes: those stand still in space, so that
// images of one pattern match best where nothing is moved. The mean of a cycle has no fringes, and
// finds the move; the fringes' phase, a cycle apart on the same point of the surface, then says
// how far it came along the axis or in depth.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#include "core/pipeline/motion.hpp"
#include "core/pipeline/motion_pixels.hpp"

namespace xtrack {
namespace {

using motion::grey_at;
using motion::kCostCap;

// One sample in so many pixels each way: of a cell, of all that moves.
constexpr int kSampleStepPx = 2;
constexpr int kSparseStepPx = 2;
// Samples whose mean changes by more are not of the same point, grey levels.
constexpr float kSamePoint = 10.0F;
// Fringe amplitude of a sample that has a say, grey levels.
constexpr float kLeastAmplitude = 6.0F;
// Samples below which the phase says nothing.
constexpr int kLeastSamples = 60;
// Cells each way whose phase speaks for a cell: fewer follow noise and edges, more blur fingers.
constexpr int kNear = 3;
// The same of a cell with its neighbours, and how much of their length the sum of their turns
// keeps.
constexpr int kLeastCellSamples = 8;
constexpr float kLeastAgreement = 0.8F;
constexpr float kMostCellDrift_rad = 1.0F;
// How often the drift is measured with taps that the last measurement corrected.
constexpr int kRounds = 2;

}  // namespace

bool MotionEstimator::find_cycles(const FrameWindow& window, const Frame& newest) noexcept {
    if (settings_.phases_rad.size() != kCycle || patterns_ != static_cast<int>(kCycle) || held_) {
        return false;
    }
    for (std::size_t p = 0; p < kCycle; ++p) {
        for (std::size_t ago = 0; ago < 2; ++ago) {
            const FrameWindow::Entry* entry =
                window.fullest(static_cast<int>(p), static_cast<int>(ago));
            const Small* small = find_small(entry);
            if (small == nullptr || !saw(*entry->frame, 0) ||
                !saw(*entry->frame, size_.height - 1) ||
                newest.sequence - entry->frame->sequence >= kCycle * (ago + 1) ||
                newest.sequence - entry->frame->sequence < kCycle * ago) {
                return false;
            }
            cycles_[ago].frames[p] = entry->frame.get();
            cycles_[ago].cells[p] = small;
        }
    }
    return true;
}

int MotionEstimator::mean_at(const Cycle& cycle, int x, int y) noexcept {
    int sum = 0;
    for (const Frame* frame : cycle.frames) {
        sum += grey_at(*frame, x, y);
    }
    return sum / static_cast<int>(kCycle);
}

void MotionEstimator::mean_cells(const Cycle& cycle, Image<std::uint8_t>& cells) const noexcept {
    for (int y = 0; y < cells.height(); ++y) {
        for (int x = 0; x < cells.width(); ++x) {
            int sum = 0;
            for (const Small* small : cycle.cells) {
                sum += small->cells.at(x, y);
            }
            cells.at(x, y) = static_cast<std::uint8_t>(sum / static_cast<int>(kCycle));
        }
    }
}

float MotionEstimator::drift_rad_since(const Frame& frame) const noexcept {
    const auto age = static_cast<float>(to_seconds(now_ - frame.stamp));
    return extra_rad_per_s_ * age - gradient_rad_.dot(path_since(frame));
}

void MotionEstimator::prepare_views() noexcept {
    for (Cycle& cycle : cycles_) {
        for (const bool follow : {false, true}) {
            prepare_view(cycle, follow, cycle.views[follow ? 1 : 0]);
        }
    }
}

void MotionEstimator::prepare_view(const Cycle& cycle, bool follow, View& view) const noexcept {
    view.left = 0;
    view.right = size_.width;
    view.top = 0;
    view.bottom = size_.height;
    view.mean_re = 0.0F;
    view.mean_im = 0.0F;
    std::array<double, kCycle> phases{};
    for (std::size_t p = 0; p < kCycle; ++p) {
        const Frame& frame = *cycle.frames[p];
        const Shift shift = follow ? to(frame) : Shift{};
        const bool grey = frame.format == PixelFormat::grey8;
        view.step[p] = grey ? 1 : 3;
        view.stride[p] = frame.pixels.stride();
        view.origin[p] = frame.pixels.row(0) + (grey ? 0 : 1) + shift.dy * view.stride[p] +
                         shift.dx * view.step[p];
        view.left = std::max(view.left, -shift.dx);
        view.right = std::min(view.right, size_.width - shift.dx);
        view.top = std::max(view.top, frame.clean_row_begin - shift.dy);
        view.bottom = std::min(view.bottom, frame.clean_row_end - shift.dy);
        phases[p] = phase_in(frame, static_cast<int>(p), follow);
        view.mean_re += static_cast<float>(std::cos(phases[p]) / kCycle);
        view.mean_im += static_cast<float>(std::sin(phases[p]) / kCycle);
    }
    if (!fit_taps(phases, view.taps)) {
        view.right = view.left;  // nothing to see
    }
}

double MotionEstimator::phase_in(const Frame& frame, int pattern, bool follow) const noexcept {
    return settings_.phases_rad[static_cast<std::size_t>(pattern)] +
           (follow ? static_cast<double>(drift_rad_since(frame)) : 0.0);
}

bool MotionEstimator::look(const Cycle& cycle, bool follow, int x, int y, Fringe& out) noexcept {
    const View& view = cycle.views[follow ? 1 : 0];
    if (x < view.left || x >= view.right || y < view.top || y >= view.bottom) {
        return false;
    }
    out = {};
    for (std::size_t p = 0; p < kCycle; ++p) {
        const auto grey = static_cast<float>(view.origin[p][y * view.stride[p] + x * view.step[p]]);
        out.re += view.taps.taps[p].re * grey;
        out.im += view.taps.taps[p].im * grey;
        out.mean += grey / static_cast<float>(kCycle);
    }
    out.mean -= out.re * view.mean_re - out.im * view.mean_im;
    return true;
}

float MotionEstimator::mismatch(int x, int y, bool follow) const noexcept {
    if (!stretches_.empty()) {
        return surprise(x, y, follow);
    }
    if (!whole_cycles_) {
        return static_cast<float>(worst_difference(x, y, follow));
    }
    Fringe now;
    Fringe before;
    if (!look(cycles_[0], follow, x, y, now) || !look(cycles_[1], follow, x, y, before)) {
        return kNoMatch;
    }
    const float re = now.re - before.re;
    const float im = now.im - before.im;
    return std::max(std::sqrt(re * re + im * im), std::abs(now.mean - before.mean));
}

void MotionEstimator::add_turns(int cell_x, int cell_y, bool follow, int step_px,
                                Turn& turn) const noexcept {
    constexpr float kLeastPower = kLeastAmplitude * kLeastAmplitude;
    for (int j = 0; j < kCellPx; j += step_px) {
        for (int i = 0; i < kCellPx; i += step_px) {
            const int x = cell_x * kCellPx + i;
            const int y = cell_y * kCellPx + j;
            Fringe now;
            Fringe before;
            if (!look(cycles_[0], follow, x, y, now) || !look(cycles_[1], follow, x, y, before) ||
                std::abs(now.mean - before.mean) > kSamePoint) {
                continue;
            }
            const float now_power = now.re * now.re + now.im * now.im;
            const float before_power = before.re * before.re + before.im * before.im;
            if (now_power < kLeastPower || before_power < kLeastPower) {
                continue;
            }
            // before * conj(now), of length 1
            const float scale = 1.0F / std::sqrt(now_power * before_power);
            turn.re += scale * (before.re * now.re + before.im * now.im);
            turn.im += scale * (before.im * now.re - before.re * now.im);
            ++turn.samples;
        }
    }
}

// The phase that the fringes moved by in a cycle, beyond what the move along the image explains.
float MotionEstimator::measure_drift() noexcept {
    for (int round = 0; round < kRounds; ++round) {
        prepare_views();
        Turn turn;
        for (const auto& cell : active_cells_) {
            add_turns(cell[0], cell[1], true, kSparseStepPx, turn);
        }
        if (turn.samples < kLeastSamples) {
            break;
        }
        extra_rad_per_s_ += std::atan2(turn.im, turn.re) / static_cast<float>(seconds_per_cycle_);
        const auto most = static_cast<float>(std::numbers::pi / seconds_per_cycle_);
        extra_rad_per_s_ = std::clamp(extra_rad_per_s_, -most, most);
    }
    prepare_views();
    float cost = 0.0F;
    for (const auto& cell : active_cells_) {
        for (int j = 0; j < kCellPx; j += kSparseStepPx) {
            for (int i = 0; i < kCellPx; i += kSparseStepPx) {
                cost += std::min(mismatch(cell[0] * kCellPx + i, cell[1] * kCellPx + j, true),
                                 static_cast<float>(kCostCap));
            }
        }
    }
    return cost;
}

void MotionEstimator::choose_move(const Shift& by_pattern) noexcept {
    struct Move {
        Shift shift;
        double cycles_ago = 0.5;
    };
    // The mean of a cycle is one image older than its newest.
    constexpr double kMeansAgo = 0.5 + 1.0 / kCycle;
    std::array<Move, 3> moves{Move{by_pattern}, Move{search_cycles(seconds_per_cycle_), kMeansAgo}};
    std::size_t count = 2;
    // What is fast uncovers much, and the searches may match that: to go on as before is worth a
    // look.
    if (history_count_ > 0) {
        const Shift goes_on =
            shift_along(history_[0].velocity * static_cast<float>(seconds_per_cycle_));
        if (goes_on.dx != by_pattern.dx || goes_on.dy != by_pattern.dy) {
            moves[count++].shift = goes_on;
        }
    }
    const float extra_before = extra_rad_per_s_;
    float best_extra = extra_before;
    float best_cost = std::numeric_limits<float>::infinity();
    std::size_t best = 0;
    for (std::size_t n = 0; n < count; ++n) {
        extra_rad_per_s_ = extra_before;
        take_move(moves[n].shift, moves[n].cycles_ago);
        const float cost = measure_drift();
        if (cost < best_cost) {
            best_cost = cost;
            best_extra = extra_rad_per_s_;
            best = n;
        }
    }
    extra_rad_per_s_ = best_extra;
    take_move(moves[best].shift, moves[best].cycles_ago);
}

void MotionEstimator::measure_cell_drift() noexcept {
    for (int cy = 0; cy < age_.height(); ++cy) {
        for (int cx = 0; cx < age_.width(); ++cx) {
            Turn& turn = turns_.at(cx, cy);
            turn = {};
            if (disturbed(cx, cy)) {
                add_turns(cx, cy, follows(cx, cy), kSampleStepPx, turn);
            }
        }
    }
    for (int cy = 0; cy < age_.height(); ++cy) {
        for (int cx = 0; cx < age_.width(); ++cx) {
            float& drift_rad = cell_drift_rad_.at(cx, cy);
            drift_rad = 0.0F;
            if (!disturbed(cx, cy)) {
                continue;
            }
            Turn sum;
            for (int y = std::max(cy - kNear, 0); y <= std::min(cy + kNear, age_.height() - 1);
                 ++y) {
                for (int x = std::max(cx - kNear, 0); x <= std::min(cx + kNear, age_.width() - 1);
                     ++x) {
                    if (follows(x, y) == follows(cx, cy)) {
                        sum.re += turns_.at(x, y).re;
                        sum.im += turns_.at(x, y).im;
                        sum.samples += turns_.at(x, y).samples;
                    }
                }
            }
            // Samples that disagree are of several surfaces: none of their phases is right.
            const float agreement = std::sqrt(sum.re * sum.re + sum.im * sum.im);
            if (sum.samples >= kLeastCellSamples &&
                agreement >= kLeastAgreement * static_cast<float>(sum.samples)) {
                drift_rad =
                    std::clamp(std::atan2(sum.im, sum.re), -kMostCellDrift_rad, kMostCellDrift_rad);
            }
        }
    }
}

}  // namespace xtrack
