// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/still_scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/unwrap/unwrap_row.hpp"

namespace xtrack {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
constexpr double kTurn_rad = 2.0 * std::numbers::pi;
// A phase that is off by no more is the same: six sigma of a weak fringe, and what a surface that
// is taken for another now and then makes of it.
constexpr float kSame_rad = 0.4F;
// A modulation is the same up to this share more, and in the penumbra of a shadow much less.
constexpr float kBrighter = 1.25F;
constexpr float kDarker = 0.3F;
constexpr float kNoise_grey = 2.0F;
// How long a thing must rest to be taken in: where nothing is known; where it lies behind what is;
// where only its light is another; where it lies before it.
constexpr float kNew_ms = 100.0F;
constexpr float kBehind_ms = 250.0F;
constexpr float kRelit_ms = 500.0F;
constexpr float kBefore_ms = 10000.0F;
// Share of the way to a new value of the same thing, each time.
constexpr float kDrift = 0.1F;
// It learns from one in so many images, at first from all.
constexpr unsigned kEvery = 4;
constexpr unsigned kAtFirst = 30;
// A stream that stalled proves nothing.
constexpr float kLongest_ms = 200.0F;

// Across two pixels light changes by no more within one surface: a share of it, and noise.
constexpr float kEdgeShare = 0.22F;
constexpr float kEdge_grey = 3.0F;

// How far apart pixels are of which one goes on from the other, px, and its light, as a factor.
constexpr int kReach_px = 3;
constexpr float kAlike = 1.2F;

bool is_edge(float a, float b) noexcept {
    return std::fabs(a - b) > 0.5F * kEdgeShare * (a + b) + kEdge_grey;
}

bool as_bright(float modulation, float known) noexcept {
    return modulation <= kBrighter * known + kNoise_grey && modulation >= kDarker * known;
}

}  // namespace

StillScene::StillScene(Size image)
    : size_(image),
      known_(image.width, image.height, kNone),
      known_modulation_(image.width, image.height, 0.0F),
      still_(image.width, image.height, kNone),
      moving_(image.width, image.height, kNone),
      rivals_(image.width, image.height, Rival{}) {}

void StillScene::divide(ImageView<const float> phase_rad,
                        ImageView<const float> modulation) noexcept {
    UnwrapRow row;
    row.count = size_.width;
    row.period_px = kTurn_rad;  // coordinates that are phases
    row.tolerance = static_cast<float>(static_cast<double>(kSame_rad) / kTurn_rad);
    still_pixels_ = 0;
    int unknown = 0;
    for (int y = 0; y < size_.height; ++y) {
        float* still = still_.row(y);
        row.phase_rad = phase_rad.row(y);
        row.reference_px = known_.row(y);
        row.coordinate_px = still;
        unwrap_row(row);
        const float* seen = modulation.row(y);
        const float* known = known_modulation_.row(y);
        float* moving = moving_.row(y);
        int count = 0;
        for (int x = 0; x < size_.width; ++x) {
            const bool same = as_bright(seen[x], known[x]) && still[x] == still[x];
            still[x] = same ? still[x] : kNone;
            moving[x] = same ? kNone : row.phase_rad[x];
            count += same ? 1 : 0;
            unknown +=
                row.reference_px[x] == row.reference_px[x] || row.phase_rad[x] != row.phase_rad[x]
                    ? 0
                    : 1;
        }
        still_pixels_ += count;
    }
    if (still_pixels_ > 0 && unknown > 0) {
        uncover(phase_rad, modulation);
    }
    cut_edges(modulation);
}

// What nobody has seen yet, as something was before it, is taken for still where it goes on from
// what is still beside it, in phase and in light. Over a few pixels, as borders are soft.
void StillScene::grow(int x, int y, int dx, int dy, ImageView<const float> phase_rad,
                      ImageView<const float> modulation) noexcept {
    const int near_x = x - kReach_px * dx;
    const int near_y = y - kReach_px * dy;
    const float near = still_.at(near_x, near_y);
    const float far = still_.at(near_x - kReach_px * dx, near_y - kReach_px * dy);
    const float wanted = 2.0F * near - far;
    const float off = std::remainder(phase_rad.at(x, y) - wanted, static_cast<float>(kTurn_rad));
    const float here = modulation.at(x, y);
    const float there = modulation.at(near_x, near_y);
    if (std::fabs(off) < kSame_rad && here < kAlike * there && there < kAlike * here) {
        still_.at(x, y) = wanted + off;
        moving_.at(x, y) = kNone;
        ++still_pixels_;
    }
}

void StillScene::uncover(ImageView<const float> phase_rad,
                         ImageView<const float> modulation) noexcept {
    constexpr int kMargin = 2 * kReach_px;
    const auto wanted = [&](int x, int y) {
        return std::isnan(known_.at(x, y)) && !std::isnan(moving_.at(x, y));
    };
    for (int y = 0; y < size_.height; ++y) {
        for (int x = 0; x < size_.width; ++x) {
            if (x >= kMargin && wanted(x, y)) {
                grow(x, y, 1, 0, phase_rad, modulation);
            }
            if (y >= kMargin && wanted(x, y)) {
                grow(x, y, 0, 1, phase_rad, modulation);
            }
        }
    }
    for (int y = size_.height - 1; y >= 0; --y) {
        for (int x = size_.width - 1; x >= 0; --x) {
            if (x + kMargin < size_.width && wanted(x, y)) {
                grow(x, y, -1, 0, phase_rad, modulation);
            }
            if (y + kMargin < size_.height && wanted(x, y)) {
                grow(x, y, 0, -1, phase_rad, modulation);
            }
        }
    }
}

// What moves is cut out along its outline, whose pixels are of two surfaces.
void StillScene::cut_edges(ImageView<const float> modulation) noexcept {
    for (int y = 1; y + 1 < size_.height; ++y) {
        const float* above = modulation.row(y - 1);
        const float* here = modulation.row(y);
        const float* below = modulation.row(y + 1);
        float* moving = moving_.row(y);
        for (int x = 1; x + 1 < size_.width; ++x) {
            const bool edge = is_edge(here[x - 1], here[x + 1]) || is_edge(above[x], below[x]);
            moving[x] = edge ? kNone : moving[x];
        }
    }
}

void StillScene::learn_pixel(Rival& rival, int x, int y, float phase_rad, float modulation,
                             float front, float elapsed_ms) noexcept {
    float& known = known_.at(x, y);
    float& light = known_modulation_.at(x, y);
    if (still_.at(x, y) == still_.at(x, y)) {
        known += kDrift * (phase_rad - known);
        // In a penumbra the thing is as bright as ever.
        light += modulation > light / kBrighter ? kDrift * (modulation - light) : 0.0F;
        rival.seen_ms = 0.0F;
        return;
    }
    const bool same = std::fabs(phase_rad - rival.phase_rad) < kSame_rad &&
                      as_bright(modulation, rival.modulation) &&
                      as_bright(rival.modulation, modulation);
    if (!same) {
        rival = {phase_rad, modulation, 0.0F};
        return;
    }
    rival.phase_rad += kDrift * (phase_rad - rival.phase_rad);
    rival.modulation += kDrift * (modulation - rival.modulation);
    rival.seen_ms += elapsed_ms;
    const float off = rival.phase_rad - known;
    const float before = front == 0.0F ? std::fabs(off) : front * off;
    const float hold = before > kSame_rad     ? kBefore_ms
                       : before >= -kSame_rad ? kRelit_ms
                       : before < -kSame_rad  ? kBehind_ms
                                              : kNew_ms;
    if (rival.seen_ms >= hold) {
        known = rival.phase_rad;
        light = rival.modulation;
        rival.seen_ms = 0.0F;
    }
}

void StillScene::learn(ImageView<const float> unwrapped_rad,
                       ImageView<const std::uint16_t> component, ImageView<const float> modulation,
                       double front, Stamp stamp) noexcept {
    if (images_++ > kAtFirst && images_ % kEvery != 0) {
        return;
    }
    const double since_s = images_ > 1 ? to_seconds(stamp - last_stamp_) : 0.0;
    last_stamp_ = stamp;
    const float elapsed_ms = std::min(static_cast<float>(1e3 * since_s), kLongest_ms);
    for (int y = 0; y < size_.height; ++y) {
        const float* phase = unwrapped_rad.row(y);
        const float* light = modulation.row(y);
        const std::uint16_t* ids = component.row(y);
        Rival* rivals = rivals_.row(y);
        for (int x = 0; x < size_.width; ++x) {
            if (ids[x] != 0) {  // a shadow says nothing of the surface in it
                learn_pixel(rivals[x], x, y, phase[x], light[x], static_cast<float>(front),
                            elapsed_ms);
            }
        }
    }
}

void StillScene::forget() noexcept {
    known_.fill(kNone);
    known_modulation_.fill(0.0F);
    still_.fill(kNone);
    rivals_.fill(Rival{});
    still_pixels_ = 0;
    images_ = 0;
}

void StillScene::show_known() noexcept {
    for (int y = 0; y < size_.height; ++y) {
        std::transform(known_.row(y), known_.row(y) + size_.width, moving_.row(y), [](float known) {
            return std::remainder(known, static_cast<float>(kTurn_rad));
        });
    }
    still_.fill(kNone);
    still_pixels_ = 0;
}

void StillScene::replace_known(ImageView<const float> unwrapped_rad) noexcept {
    for (int y = 0; y < size_.height; ++y) {
        std::copy_n(unwrapped_rad.row(y), size_.width, known_.row(y));
    }
    rivals_.fill(Rival{});
}

}  // namespace xtrack
