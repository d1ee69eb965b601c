// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/motion.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>

namespace xtrack {
namespace {

// Fewer moving cells than this share of the image are noise or a flicker, not a hand.
constexpr double kMinMovingShare = 0.002;
// A mismatch costs at most this, grey levels: pixels that were covered or uncovered match nowhere
// and must not drag the estimate.
constexpr int kCostCap = 40;
// Following is chosen where its mismatch is below this share of that of standing still.
constexpr float kFollowAdvantage = 1.0F;
// Images of a cycle that is over before a hand changes its speed.
constexpr int kShortCycle = 4;
// A hand's: 2 m in a second, squared, at 1 px a mm; px / s^2.
constexpr float kMaxAcceleration_px = 10000.0F;
// A match that is farther from the one expected must be better by this much a cell, grey levels:
// fine fringes match themselves a period away.
constexpr float kExpectedAdvantage = 0.3F;
// Pixels that are summed of a cell: every other row.
constexpr unsigned kCellSamples = MotionEstimator::kCellPx * MotionEstimator::kCellPx / 2;
// One sample in so many pixels each way when costs are summed.
constexpr int kSampleStepPx = 2;

// Green stands for grey in colour images: differences are all that matters here.
int grey_at(const Frame& frame, int x, int y) noexcept {
    const std::uint8_t* row = frame.pixels.row(y);
    return frame.format == PixelFormat::grey8 ? row[x] : row[3 * x + 1];
}

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

bool inside(int x, int y, Size size) noexcept {
    return x >= 0 && y >= 0 && x < size.width && y < size.height;
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
    for (Image<std::uint8_t>* cells : {&age_, &active_, &follows_}) {
        *cells = Image<std::uint8_t>(w, h, 0);
    }
    still_cost_.resize(w, h);
    follow_cost_.resize(w, h);
    row_disturbed_.resize(static_cast<std::size_t>(h), 0);
    active_cells_.reserve(static_cast<std::size_t>(w) * static_cast<std::size_t>(h));
    pairs_.reserve(static_cast<std::size_t>(patterns));
}

void MotionEstimator::clear() noexcept {
    for (auto& slot : small_) {
        for (Small& small : slot) {
            small.frame = nullptr;
        }
    }
    age_.fill(0);
    follows_.fill(0);
    std::fill(row_disturbed_.begin(), row_disturbed_.end(), std::uint8_t{0});
    history_count_ = 0;
    moving_ = false;
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
                const std::uint8_t* p =
                    frame.pixels.row(cy * kCellPx + j) + cx * kCellPx * pixel + (grey ? 0 : 1);
                const int columns = std::min(kCellPx, size_.width - cx * kCellPx);
                for (int i = 0; i < columns; ++i) {
                    sum += p[i * pixel];
                }
                count += static_cast<unsigned>(columns);
            }
            cells.at(cx, cy) = static_cast<std::uint8_t>(count == 0 ? 0 : sum / count);
        }
    }
}

int MotionEstimator::mark_moving(const Image<std::uint8_t>& now,
                                 const Image<std::uint8_t>& before) noexcept {
    active_cells_.clear();
    const int threshold = static_cast<int>(std::ceil(settings_.noise_levels));
    const int lifetime = std::min(2 * patterns_, 255);
    for (int cy = 0; cy < age_.height(); ++cy) {
        for (int cx = 0; cx < age_.width(); ++cx) {
            const bool moved = std::abs(now.at(cx, cy) - before.at(cx, cy)) >= threshold;
            std::uint8_t& age = age_.at(cx, cy);
            age = moved ? static_cast<std::uint8_t>(lifetime)
                        : static_cast<std::uint8_t>(age > 0 ? age - 1 : 0);
            if (moved) {
                active_cells_.push_back(
                    {static_cast<std::int16_t>(cx), static_cast<std::int16_t>(cy)});
            }
        }
    }
    return static_cast<int>(active_cells_.size());
}

Shift MotionEstimator::search_cells(const Image<std::uint8_t>& now,
                                    const Image<std::uint8_t>& before) const noexcept {
    const int reach = settings_.max_shift_px / kCellPx;
    const Vec2f expected =
        history_count_ > 0 ? Vec2f(-history_[0].velocity * static_cast<float>(seconds_per_cycle_))
                           : Vec2f(Vec2f::Zero());
    Shift best;
    int best_cost = std::numeric_limits<int>::max();
    for (int dy = -reach; dy <= reach; ++dy) {
        for (int dx = -reach; dx <= reach; ++dx) {
            const Vec2f candidate(static_cast<float>(dx * kCellPx),
                                  static_cast<float>(dy * kCellPx));
            int cost = history_count_ == 0
                           ? 0
                           : static_cast<int>((candidate - expected).norm() *
                                              (kExpectedAdvantage / kCellPx) *
                                              static_cast<float>(active_cells_.size()));
            for (const auto& cell : active_cells_) {
                const int x = cell[0] + dx;
                const int y = cell[1] + dy;
                const int difference = inside(x, y, before.size())
                                           ? std::abs(now.at(cell[0], cell[1]) - before.at(x, y))
                                           : kCostCap;
                cost += std::min(difference, kCostCap);
                if (cost >= best_cost) {
                    break;
                }
            }
            if (cost < best_cost) {
                best_cost = cost;
                best = {dx * kCellPx, dy * kCellPx};
            }
        }
    }
    return best;
}

Shift MotionEstimator::search_pixels(const Frame& now, const Frame& before, Shift around,
                                     int radius, int step) const noexcept {
    Shift best = around;
    int best_cost = std::numeric_limits<int>::max();
    for (int dy = around.dy - radius; dy <= around.dy + radius; dy += step) {
        for (int dx = around.dx - radius; dx <= around.dx + radius; dx += step) {
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
                    const int difference =
                        inside(x + dx, y + dy, size_)
                            ? std::abs(grey_at(now, x, y) - grey_at(before, x + dx, y + dy))
                            : kCostCap;
                    cost += std::min(difference, kCostCap);
                }
                if (cost >= best_cost) {
                    break;
                }
            }
            if (cost < best_cost) {
                best_cost = cost;
                best = {dx, dy};
            }
        }
    }
    return best;
}

Shift MotionEstimator::to(const Frame& frame) const noexcept {
    // The velocity is the mean over the last cycle; the acceleration bends the path between its
    // ends, which stay where they were found.
    const auto age = static_cast<float>(to_seconds(now_ - frame.stamp));
    const auto cycle = static_cast<float>(seconds_per_cycle_);
    const Vec2f path = velocity_ * age + acceleration_ * (0.5F * age * (cycle - age));
    return {-static_cast<int>(std::lround(path.x())), -static_cast<int>(std::lround(path.y()))};
}

void MotionEstimator::remember() noexcept {
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
    std::rotate(history_.begin(), history_.end() - 1, history_.end());
    history_[0] = {now_, velocity_};
    history_count_ = std::min(history_count_ + 1, history_.size());
}

void MotionEstimator::update(const FrameWindow& window, const Frame& newest) noexcept {
    auto& slot = small_[static_cast<std::size_t>(newest.pattern)];
    std::swap(slot[0], slot[1]);
    shrink(newest, slot[0].cells);
    slot[0].frame = &newest;
    now_ = newest.stamp;
    const Frame* before = window.previous(newest.pattern);
    moving_ = false;
    if (before == nullptr || before != slot[1].frame || !(before->stamp < newest.stamp)) {
        return;
    }
    const int moved = mark_moving(slot[0].cells, slot[1].cells);
    for (int cy = 0; cy < age_.height(); ++cy) {
        const std::uint8_t* row = age_.row(cy);
        row_disturbed_[static_cast<std::size_t>(cy)] =
            std::any_of(row, row + age_.width(), [](std::uint8_t age) { return age > 0; }) ? 1 : 0;
    }
    velocity_ = Vec2f::Zero();
    seconds_per_cycle_ = to_seconds(newest.stamp - before->stamp);
    pair_images(window);
    if (moved < kMinMovingShare * age_.width() * age_.height()) {
        history_count_ = 0;
        return;
    }
    Shift shift = search_cells(slot[0].cells, slot[1].cells);
    shift = search_pixels(newest, *before, shift, kCellPx - 2, 2);
    shift = search_pixels(newest, *before, shift, 1, 1);
    const auto seconds = static_cast<float>(seconds_per_cycle_);
    // `shift` leads from now to then.
    velocity_ =
        Vec2f(static_cast<float>(-shift.dx) / seconds, static_cast<float>(-shift.dy) / seconds);
    remember();
    moving_ = shift.dx != 0 || shift.dy != 0;
    if (moving_) {
        pair_images(window);
        choose_cells();
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
        const int difference = std::abs(grey_at(*pair.now, x + a.dx, y + a.dy) -
                                        grey_at(*pair.before, x + b.dx, y + b.dy));
        worst = std::max(worst, difference);
    }
    return worst;
}

void MotionEstimator::pair_images(const FrameWindow& window) noexcept {
    pairs_.clear();
    for (int pattern = 0; pattern < patterns_; ++pattern) {
        const Frame* now = window.newest(pattern);
        const Frame* before = window.previous(pattern);
        // The move is even for a short time only: of a long cycle the newest images alone can be
        // held against those a cycle before.
        if (now != nullptr && before != nullptr &&
            (patterns_ <= kShortCycle ||
             to_seconds(now_ - now->stamp) < 0.5 * seconds_per_cycle_)) {
            pairs_.push_back({now, before, to(*now), to(*before)});
        }
    }
}

void MotionEstimator::choose_cells() noexcept {
    constexpr float kSamples = (kCellPx / kSampleStepPx) * (kCellPx / kSampleStepPx);
    for (int cy = 0; cy < age_.height(); ++cy) {
        for (int cx = 0; cx < age_.width(); ++cx) {
            if (age_.at(cx, cy) == 0) {
                still_cost_.at(cx, cy) = 0.0F;
                follow_cost_.at(cx, cy) = 0.0F;
                continue;
            }
            int still = 0;
            int follow = 0;
            for (int j = 0; j < kCellPx; j += kSampleStepPx) {
                for (int i = 0; i < kCellPx; i += kSampleStepPx) {
                    const int x = cx * kCellPx + i;
                    const int y = cy * kCellPx + j;
                    still += std::min(worst_difference(x, y, false), kCostCap);
                    follow += std::min(worst_difference(x, y, true), kCostCap);
                }
            }
            still_cost_.at(cx, cy) = static_cast<float>(still) / kSamples;
            follow_cost_.at(cx, cy) = static_cast<float>(follow) / kSamples;
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
            const bool follows = age_.at(cx, cy) > 0 && follow < kFollowAdvantage * still;
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
