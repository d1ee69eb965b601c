// SPDX-License-Identifier: Apache-2.0
// What two whole cycles of three images say about what moves. A surface that slides along the
// fringes' axis carries its shape along but not its fringes: those stand still in space, so that
// images of one pattern match best where nothing is moved. The mean of a cycle has no fringes, and
// finds the move; the fringes' phase, a cycle apart on the same point of the surface, then says
// how far it came along the axis or in depth.
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <span>

#include "core/pipeline/motion.hpp"
#include "core/pipeline/motion_pixels.hpp"

namespace xtrack {
namespace {

using motion::grey_at;
using motion::inside;
using motion::kCostCap;

constexpr int kSampleStepPx = 2;
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
constexpr float kLeastCellSamples = 8.0F;
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
    for (std::size_t ago = 0; ago < 2; ++ago) {
        Cycle& cycle = cycles_[ago];
        for (const bool follow : {false, true}) {
            View& view = cycle.views[follow ? 1 : 0];
            std::array<double, kCycle> phases{};
            std::complex<double> turn;
            for (std::size_t p = 0; p < kCycle; ++p) {
                const Frame& frame = *cycle.frames[p];
                view.shift[p] = follow ? to(frame) : Shift{};
                phases[p] = settings_.phases_rad[p] +
                            (follow ? static_cast<double>(drift_rad_since(frame)) : 0.0);
                turn += std::polar(1.0 / static_cast<double>(kCycle), phases[p]);
            }
            view.usable = fit_taps(phases, view.taps);
            view.mean_turn = std::complex<float>(turn);
        }
    }
}

bool MotionEstimator::look(const Cycle& cycle, bool follow, int x, int y,
                           Fringe& out) const noexcept {
    const View& view = cycle.views[follow ? 1 : 0];
    float re = 0.0F;
    float im = 0.0F;
    float mean = 0.0F;
    for (std::size_t p = 0; p < kCycle; ++p) {
        const int at_x = x + view.shift[p].dx;
        const int at_y = y + view.shift[p].dy;
        if (!inside(at_x, at_y, size_)) {
            return false;
        }
        const auto grey = static_cast<float>(grey_at(*cycle.frames[p], at_x, at_y));
        re += view.taps.taps[p].re * grey;
        im += view.taps.taps[p].im * grey;
        mean += grey;
    }
    out.wave = {re, im};
    out.mean = mean / static_cast<float>(kCycle) -
               (re * view.mean_turn.real() - im * view.mean_turn.imag());
    return view.usable;
}

float MotionEstimator::mismatch(int x, int y, bool follow) const noexcept {
    if (!whole_cycles_) {
        return static_cast<float>(worst_difference(x, y, follow));
    }
    Fringe now;
    Fringe before;
    if (!look(cycles_[0], follow, x, y, now) || !look(cycles_[1], follow, x, y, before)) {
        return kNoMatch;
    }
    return std::max(std::abs(now.wave - before.wave), std::abs(now.mean - before.mean));
}

int MotionEstimator::add_turns(int cell_x, int cell_y, bool follow,
                               std::complex<float>& sum) const noexcept {
    int samples = 0;
    for (int j = 0; j < kCellPx; j += kSampleStepPx) {
        for (int i = 0; i < kCellPx; i += kSampleStepPx) {
            const int x = cell_x * kCellPx + i;
            const int y = cell_y * kCellPx + j;
            Fringe now;
            Fringe before;
            if (!inside(x, y, size_) || !look(cycles_[0], follow, x, y, now) ||
                !look(cycles_[1], follow, x, y, before) ||
                std::abs(now.mean - before.mean) > kSamePoint) {
                continue;
            }
            const float now_levels = std::abs(now.wave);
            const float before_levels = std::abs(before.wave);
            if (now_levels < kLeastAmplitude || before_levels < kLeastAmplitude) {
                continue;
            }
            sum += before.wave * std::conj(now.wave) / (before_levels * now_levels);
            ++samples;
        }
    }
    return samples;
}

// The phase that the fringes moved by in a cycle, beyond what the move along the image explains.
float MotionEstimator::measure_drift() noexcept {
    for (int round = 0; round < kRounds; ++round) {
        prepare_views();
        std::complex<float> sum;
        int samples = 0;
        for (const auto& cell : active_cells_) {
            samples += add_turns(cell[0], cell[1], true, sum);
        }
        if (samples < kLeastSamples) {
            break;
        }
        extra_rad_per_s_ += std::arg(sum) / static_cast<float>(seconds_per_cycle_);
        const auto most = static_cast<float>(std::numbers::pi / seconds_per_cycle_);
        extra_rad_per_s_ = std::clamp(extra_rad_per_s_, -most, most);
    }
    prepare_views();
    float cost = 0.0F;
    for (const auto& cell : active_cells_) {
        for (int j = 0; j < kCellPx; j += kSampleStepPx) {
            for (int i = 0; i < kCellPx; i += kSampleStepPx) {
                cost += std::min(mismatch(cell[0] * kCellPx + i, cell[1] * kCellPx + j, true),
                                 static_cast<float>(kCostCap));
            }
        }
    }
    return cost;
}

void MotionEstimator::choose_move(const Shift& by_pattern) noexcept {
    const float extra_rad_per_s = extra_rad_per_s_;
    const float pattern_cost = measure_drift();
    // The mean of a cycle is one image older than its newest.
    constexpr double kMeansAgo = 0.5 + 1.0 / kCycle;
    const Shift by_mean = search_cycles(seconds_per_cycle_);
    const float pattern_extra = extra_rad_per_s_;
    extra_rad_per_s_ = extra_rad_per_s;
    take_move(by_mean, kMeansAgo);
    if (measure_drift() >= pattern_cost) {
        extra_rad_per_s_ = pattern_extra;
        take_move(by_pattern, 0.5);
    }
}

void MotionEstimator::measure_cell_drift() noexcept {
    for (int cy = 0; cy < age_.height(); ++cy) {
        for (int cx = 0; cx < age_.width(); ++cx) {
            std::complex<float> turn;
            const int samples = disturbed(cx, cy) ? add_turns(cx, cy, follows(cx, cy), turn) : 0;
            turn_re_.at(cx, cy) = turn.real();
            turn_im_.at(cx, cy) = turn.imag();
            turn_samples_.at(cx, cy) = static_cast<float>(samples);
        }
    }
    for (int cy = 0; cy < age_.height(); ++cy) {
        for (int cx = 0; cx < age_.width(); ++cx) {
            float& drift_rad = cell_drift_rad_.at(cx, cy);
            drift_rad = 0.0F;
            if (!disturbed(cx, cy)) {
                continue;
            }
            std::complex<float> turn;
            float samples = 0.0F;
            for (int y = std::max(cy - kNear, 0); y <= std::min(cy + kNear, age_.height() - 1);
                 ++y) {
                for (int x = std::max(cx - kNear, 0); x <= std::min(cx + kNear, age_.width() - 1);
                     ++x) {
                    if (follows(x, y) == follows(cx, cy)) {
                        turn += std::complex<float>(turn_re_.at(x, y), turn_im_.at(x, y));
                        samples += turn_samples_.at(x, y);
                    }
                }
            }
            // Samples that disagree are of several surfaces: none of their phases is right.
            if (samples >= kLeastCellSamples && std::abs(turn) >= kLeastAgreement * samples) {
                drift_rad = std::clamp(std::arg(turn), -kMostCellDrift_rad, kMostCellDrift_rad);
            }
        }
    }
}

}  // namespace xtrack
