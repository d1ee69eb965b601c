// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/motion.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>

#include <xtrack/pattern.hpp>

#include "core/pipeline/motion_pixels.hpp"

namespace xtrack {
namespace {

using motion::grey_at;
using motion::inside;
using motion::kCostCap;
using motion::saw_cells;

// Fewer moving cells than this share of the image are noise or a flicker, not a hand.
constexpr double kMinMovingShare = 0.002;
// Images of a cycle that is over before a hand changes its speed.
constexpr int kShortCycle = 4;
// A hand's: from rest to 2 m/s in 0.2 s, at 1 px a mm; px / s^2.
constexpr float kMaxAcceleration_px = 10000.0F;
// Pixels that are summed of a cell: every other row.
constexpr unsigned kCellSamples = MotionEstimator::kCellPx * MotionEstimator::kCellPx / 2;
// One sample in so many pixels each way when costs are summed.
constexpr int kSampleStepPx = 2;

// Eight pixels at a time in one register: sums of neighbours in four fields of 16 bits.
std::uint64_t sums_of_two(const std::uint8_t* eight) noexcept {
    std::uint64_t bytes = 0;
    std::memcpy(&bytes, eight, sizeof(bytes));
    constexpr std::uint64_t kEven = 0x00FF00FF00FF00FFU;
    return (bytes & kEven) + ((bytes >> 8U) & kEven);
}

std::uint64_t sum_of_four(std::uint64_t fields) noexcept {
    return (fields * 0x0001000100010001U) >> 48U;
}

}  // namespace

MotionEstimator::MotionEstimator(Size image, int patterns, const Settings& settings)
    : size_(image),
      patterns_(patterns),
      settings_(settings),
      small_(static_cast<std::size_t>(patterns)) {
    const int w = std::max(1, image.width / kCellPx);
    const int h = std::max(1, image.height / kCellPx);
    for (auto& slot : small_) {
        for (Small& small : slot) {
            small.cells.resize(w, h);
        }
    }
    for (Image<std::uint8_t>* cells : {&age_, &follows_}) {
        *cells = Image<std::uint8_t>(w, h, 0);
    }
    for (Small& small : mean_cells_) {
        small.cells.resize(w, h);
    }
    turns_.resize(w, h);
    cell_drift_rad_ = Image<float>(w, h, 0.0F);
    still_cost_.resize(w, h);
    follow_cost_.resize(w, h);
    row_disturbed_.resize(static_cast<std::size_t>(h), 0);
    blend_.shares.resize(static_cast<std::size_t>(h), 0);
    stretches_.reserve(kMostStretches);
    stretch_of_row_.resize(static_cast<std::size_t>(image.height), 0);
    active_cells_.reserve(static_cast<std::size_t>(w) * static_cast<std::size_t>(h));
    pairs_.reserve(2 * static_cast<std::size_t>(patterns));
}

void MotionEstimator::clear() noexcept {
    for (auto& slot : small_) {
        for (Small& small : slot) {
            small.frame = nullptr;
            small.count = 0;
        }
    }
    pairs_.clear();
    age_.fill(0);
    follows_.fill(0);
    std::fill(row_disturbed_.begin(), row_disturbed_.end(), std::uint8_t{0});
    history_count_ = 0;
    moving_ = false;
    held_ = false;
    whole_cycles_ = false;
    stretches_.clear();
    blend_.of = blend_.earlier = nullptr;
    velocity_ = acceleration_ = gradient_rad_ = Vec2f::Zero();
    extra_rad_per_s_ = lag_s_ = 0.0F;
    cell_drift_rad_.fill(0.0F);
}

void MotionEstimator::shrink(const Frame& frame, Image<std::uint8_t>& cells) const noexcept {
    const bool grey = frame.format == PixelFormat::grey8;
    const int pixel = grey ? 1 : 3;
    for (int cy = 0; cy < cells.height(); ++cy) {
        int first = 0;
        // Every other row is enough to beat the noise, and half the memory traffic.
        if (grey && (cy + 1) * kCellPx <= size_.height) {
            for (; (first + 1) * kCellPx <= size_.width; ++first) {
                std::uint64_t pairs = 0;  // four sums of 16 bits
                for (int j = 0; j < kCellPx; j += 2) {
                    pairs += sums_of_two(frame.pixels.row(cy * kCellPx + j) + first * kCellPx);
                }
                cells.at(first, cy) = static_cast<std::uint8_t>(sum_of_four(pairs) / kCellSamples);
            }
        }
        for (int cx = first; cx < cells.width(); ++cx) {
            unsigned sum = 0;
            unsigned count = 0;
            for (int j = 0; j < kCellPx && cy * kCellPx + j < size_.height; j += 2) {
                const std::uint8_t* p = frame.pixels.row(cy * kCellPx + j) + cx * kCellPx * pixel;
                const int columns = std::min(kCellPx, size_.width - cx * kCellPx);
                for (int i = 0; i < columns; ++i) {
                    sum += grey ? p[i] : static_cast<unsigned>(motion::mean_of(p + i * pixel));
                }
                count += static_cast<unsigned>(columns);
            }
            cells.at(cx, cy) = static_cast<std::uint8_t>(count == 0 ? 0 : sum / count);
        }
    }
}

MotionEstimator::Small& MotionEstimator::take_small(const FrameWindow& window,
                                                    int pattern) noexcept {
    SmallSlot& slot = small_[static_cast<std::size_t>(pattern)];
    const auto entries = window.entries(pattern);
    for (Small& small : slot) {
        const bool used = std::any_of(
            entries.begin(), entries.end(),
            [&](const FrameWindow::Entry& entry) { return entry.count == small.count; });
        if (small.count == 0 || !used) {
            return small;
        }
    }
    return slot.back();
}

const MotionEstimator::Small* MotionEstimator::find_small(
    const FrameWindow::Entry* entry) const noexcept {
    if (entry == nullptr) {
        return nullptr;
    }
    for (const Small& small : small_[static_cast<std::size_t>(entry->frame->pattern)]) {
        if (small.count == entry->count) {
            return &small;
        }
    }
    return nullptr;
}

void MotionEstimator::age_cells() noexcept {
    for (int cy = 0; cy < age_.height(); ++cy) {
        for (int cx = 0; cx < age_.width(); ++cx) {
            std::uint8_t& age = age_.at(cx, cy);
            age = static_cast<std::uint8_t>(age > 0 ? age - 1 : 0);
        }
    }
}

void MotionEstimator::mark_moving(const Small& now, const Small& before, int lifetime) noexcept {
    active_cells_.clear();
    const int threshold = static_cast<int>(std::ceil(settings_.noise_levels));
    for (int cy = 0; cy < age_.height(); ++cy) {
        if (!comparable(now, before, cy)) {
            continue;
        }
        for (int cx = 0; cx < age_.width(); ++cx) {
            if (cells_differ(now, before, cx, cy, 0, 0) >= threshold) {
                age_.at(cx, cy) = static_cast<std::uint8_t>(lifetime);
                active_cells_.push_back(
                    {static_cast<std::int16_t>(cx), static_cast<std::int16_t>(cy)});
            }
        }
    }
}

bool MotionEstimator::enough_moved() const noexcept {
    return static_cast<double>(active_cells_.size()) >=
           kMinMovingShare * age_.width() * age_.height();
}

Vec2f MotionEstimator::path_since(const Frame& frame) const noexcept {
    const auto age = static_cast<float>(to_seconds(now_ - frame.stamp));
    if (!held_) {
        // The velocity is a mean, reached so long ago; the acceleration bends the path. Where the
        // mean is that of the last cycle, its ends stay where they were found.
        return velocity_ * age + acceleration_ * (age * (lag_s_ - 0.5F * age));
    }
    // The velocity is known at the moments in the history, and even changes between.
    Vec2f path = Vec2f::Zero();
    float upto = 0.0F;  // s before now
    Vec2f velocity = velocity_;
    for (std::size_t n = 0; n < history_count_ && upto < age; ++n) {
        const auto known = static_cast<float>(to_seconds(now_ - history_[n].stamp));
        const float length = known - upto;
        const float part = std::min(age, known) - upto;
        if (!(length > 0.0F)) {
            continue;
        }
        const Vec2f slope = (history_[n].velocity - velocity) / length;
        path += velocity * part + slope * (0.5F * part * part);
        velocity = history_[n].velocity;
        upto = known;
    }
    if (upto < age) {
        path += velocity * (age - upto);
    }
    return path;
}

Shift MotionEstimator::to(const Frame& frame) const noexcept {
    return shift_along(path_since(frame));
}

Shift MotionEstimator::shift_along(const Vec2f& path_px) noexcept {
    // A path that leaves every image is as good as any other that does; stamps that are far apart,
    // or all but equal, lead beyond what an int holds.
    constexpr auto kFarthest_px = static_cast<float>(4 * kMaxImageSide_px);
    const Vec2f path = path_px.cwiseMax(-kFarthest_px).cwiseMin(kFarthest_px);
    return {-static_cast<int>(std::lround(path.x())), -static_cast<int>(std::lround(path.y()))};
}

void MotionEstimator::bend_path() noexcept {
    acceleration_ = Vec2f::Zero();
    // The slope over half a cycle: the estimates overlap, so closer ones say little.
    for (std::size_t n = 0; n < history_count_; ++n) {
        const Past& past = history_[n];
        const auto since = static_cast<float>(to_seconds(now_ - past.stamp));
        if (since >= 0.45F * static_cast<float>(seconds_per_cycle_)) {
            acceleration_ = (velocity_ - past.velocity) / since;
            break;
        }
    }
    const float fastest = kMaxAcceleration_px;
    acceleration_ = acceleration_.cwiseMax(-fastest).cwiseMin(fastest);
}

void MotionEstimator::remember(Stamp when) noexcept {
    std::rotate(history_.begin(), history_.end() - 1, history_.end());
    history_[0] = {when, velocity_};
    history_count_ = std::min(history_count_ + 1, history_.size());
}

// Patterns shown once: the move over a whole cycle.
void MotionEstimator::follow_cycle(const Small& now, const Small& before) noexcept {
    velocity_ = Vec2f::Zero();
    if (!enough_moved()) {
        history_count_ = 0;
        extra_rad_per_s_ = 0.0F;
        return;
    }
    const Shift shift = search(now, before, seconds_per_cycle_);
    take_move(shift, 0.5);
    moving_ = shift.dx != 0 || shift.dy != 0;
    if (whole_cycles_) {
        choose_move(shift);
        moving_ = true;  // whole cycles also show what comes nearer without moving in the image
    }
    remember(now_);
}

// `shift` leads from now to then; the velocity that it means was reached so many cycles ago.
void MotionEstimator::take_move(const Shift& shift, double cycles_ago) noexcept {
    const auto seconds = static_cast<float>(seconds_per_cycle_);
    velocity_ =
        Vec2f(static_cast<float>(-shift.dx) / seconds, static_cast<float>(-shift.dy) / seconds);
    lag_s_ = static_cast<float>(seconds_per_cycle_ * cycles_ago);
    bend_path();
}

void MotionEstimator::update(const FrameWindow& window, const Frame& newest) noexcept {
    Small& small = take_small(window, newest.pattern);
    shrink(newest, small.cells);
    small.frame = &newest;
    small.count = window.entries(newest.pattern)[0].count;
    now_ = newest.stamp;
    moving_ = false;
    pairs_.clear();  // they and the cycles point to frames that the window may have let go
    whole_cycles_ = false;
    blend_.of = nullptr;
    stretches_.clear();
    age_cells();
    const auto older = [&](const Small* found) {
        return found != nullptr && found->frame->stamp < newest.stamp ? found : nullptr;
    };
    const FrameWindow::Entry* last = window.fullest(newest.pattern, 1);
    const Small* cycle = older(find_small(last));
    const bool held = window.held(newest.pattern) != nullptr || window.frames_of_last_show() > 1;
    if (held != held_) {
        held_ = held;
        history_count_ = 0;
        velocity_ = acceleration_ = Vec2f::Zero();
        extra_rad_per_s_ = 0.0F;
    }
    if (cycle == nullptr) {
        return;
    }
    seconds_per_cycle_ = to_seconds(newest.stamp - last->frame->stamp);
    const std::uint64_t pushes = window.entries(newest.pattern)[0].count - last->count;
    const int lifetime = static_cast<int>(std::min<std::uint64_t>(2 * pushes, 255));
    mark_moving(small, *cycle, lifetime);
    whole_cycles_ = find_cycles(window, newest);
    if (whole_cycles_) {
        for (std::size_t ago = 0; ago < cycles_.size(); ++ago) {
            mean_cells(cycles_[ago], mean_cells_[ago].cells);
            mean_cells_[ago].frame = cycles_[ago].frames.front();
        }
    }
    if (!held_) {
        follow_cycle(small, *cycle);
    } else {
        const Small* before = older(find_last(window, small, 1));
        if (before != nullptr) {
            find_blend(small, *before, find_last(window, small, 2));
            mark_moving(small, *before, lifetime);
        }
        follow_held(small, before);
        find_stretches(window);
    }
    for (int cy = 0; cy < age_.height(); ++cy) {
        const std::uint8_t* row = age_.row(cy);
        row_disturbed_[static_cast<std::size_t>(cy)] =
            std::any_of(row, row + age_.width(), [](std::uint8_t age) { return age > 0; }) ? 1 : 0;
    }
    pair_images(window);
    if (whole_cycles_) {
        prepare_views();
    } else if (!stretches_.empty()) {
        prepare_stretches();
    }
    if (moving_) {
        choose_cells();
    }
    if (whole_cycles_) {
        measure_cell_drift();
    } else {
        cell_drift_rad_.fill(0.0F);
    }
}

int MotionEstimator::worst_difference(int x, int y, bool follow) const noexcept {
    int worst = 0;
    for (const Pair& pair : pairs_) {
        const Shift a = follow ? pair.to_now : Shift{};
        const Shift b = follow ? pair.to_before : Shift{};
        if (!inside(x + a.dx, y + a.dy, size_) || !inside(x + b.dx, y + b.dy, size_)) {
            return 255;
        }
        if (!saw(*pair.now, y + a.dy) || !saw(*pair.before, y + b.dy)) {
            continue;
        }
        const int difference = std::abs(grey_at(*pair.now, x + a.dx, y + a.dy) -
                                        grey_at(*pair.before, x + b.dx, y + b.dy));
        worst = std::max(worst, difference);
    }
    return worst;
}

void MotionEstimator::pair_images(const FrameWindow& window) noexcept {
    pairs_.clear();
    const auto add = [&](const Frame* now, const Frame* before) {
        if (now != nullptr && before != nullptr) {
            pairs_.push_back({now, before, to(*now), to(*before), {}, {}});
        }
    };
    for (int pattern = 0; pattern < patterns_; ++pattern) {
        const FrameWindow::Entry* now = window.fullest(pattern, 0);
        const FrameWindow::Entry* before = window.fullest(pattern, 1);
        // The move is even for a short time only: of a long cycle the newest images alone can be
        // held against those a cycle before. The oldest pattern's say nothing of the time since.
        const bool short_cycle = patterns_ <= kShortCycle && !held_;
        if (now != nullptr && before != nullptr &&
            (short_cycle || to_seconds(now_ - now->frame->stamp) < 0.5 * seconds_per_cycle_)) {
            add(now->frame.get(), before->frame.get());
        }
        const FrameWindow::Entry* held = window.held(pattern);
        add(window.newest(pattern), held == nullptr ? nullptr : held->frame.get());
    }
}

void MotionEstimator::choose_cells() noexcept {
    constexpr int kSamplesAlong = kCellPx / kSampleStepPx;
    constexpr auto kSamples = static_cast<float>(kSamplesAlong * kSamplesAlong);
    constexpr auto kCap = static_cast<float>(kCostCap);
    for (int cy = 0; cy < age_.height(); ++cy) {
        for (int cx = 0; cx < age_.width(); ++cx) {
            if (age_.at(cx, cy) == 0) {
                still_cost_.at(cx, cy) = 0.0F;
                follow_cost_.at(cx, cy) = 0.0F;
                continue;
            }
            float still = 0.0F;
            float follow = 0.0F;
            for (int j = 0; j < kCellPx; j += kSampleStepPx) {
                for (int i = 0; i < kCellPx; i += kSampleStepPx) {
                    const int x = cx * kCellPx + i;
                    const int y = cy * kCellPx + j;
                    still += std::min(mismatch(x, y, false), kCap);
                    follow += std::min(mismatch(x, y, true), kCap);
                }
            }
            still_cost_.at(cx, cy) = still / kSamples;
            follow_cost_.at(cx, cy) = follow / kSamples;
        }
    }
    Vec2f sum = Vec2f::Zero();
    int count = 0;
    for (int cy = 0; cy < age_.height(); ++cy) {
        for (int cx = 0; cx < age_.width(); ++cx) {
            float still = 0.0F;
            float follow = 0.0F;
            for (int y = std::max(cy - 1, 0); y <= std::min(cy + 1, age_.height() - 1); ++y) {
                for (int x = std::max(cx - 1, 0); x <= std::min(cx + 1, age_.width() - 1); ++x) {
                    still += still_cost_.at(x, y);
                    follow += follow_cost_.at(x, y);
                }
            }
            const bool follows = age_.at(cx, cy) > 0 && follow < still;
            follows_.at(cx, cy) = follows ? 1 : 0;
            if (follows) {
                sum += Vec2f(static_cast<float>(cx), static_cast<float>(cy));
                ++count;
            }
        }
    }
    if (count > 0) {
        const auto cell = static_cast<float>(kCellPx);
        centre_ = (sum / static_cast<float>(count)) * cell + Vec2f::Constant(0.5F * cell);
    } else {
        moving_ = false;
    }
}

}  // namespace xtrack
