// SPDX-License-Identifier: Apache-2.0
#include "gestures/segment/background.hpp"

#include <algorithm>
#include <cmath>

namespace xtrack::segment {

namespace {

/// Share of the way to a new value of the same surface a second: follows warm-up drift, not hands.
constexpr float kDriftPerSecond = 0.5F;
/// A rival that is not seen loses its standing this much faster than it was won.
constexpr float kForget = 4.0F;
/// Longest step of time that one image may count for, ms: a stream that stalled proves nothing.
constexpr std::int64_t kStepMaxMs = 200;

}  // namespace

void Background::create(std::size_t pixels, const Settings& settings) {
    settings_ = settings;
    depth_.assign(pixels, 0.0F);
    rival_.assign(pixels, 0.0F);
    rival_seen_.assign(pixels, 0.0F);
}

void Background::reset() {
    std::fill(depth_.begin(), depth_.end(), 0.0F);
    std::fill(rival_.begin(), rival_.end(), 0.0F);
    std::fill(rival_seen_.begin(), rival_seen_.end(), 0.0F);
    elapsed_before_ms_ = 0.0F;
    upper_is_newer_ = false;
}

void Background::mask(std::span<const float> z, std::span<float> foreground) const {
    const float margin = settings_.margin_mm;
    for (std::size_t i = 0; i < z.size(); ++i) {
        const bool known = (depth_[i] > 0.0F) & (z[i] > depth_[i] - margin);
        foreground[i] = known ? 0.0F : z[i];
    }
}

void Background::learn(std::span<const float> z, std::span<const std::uint8_t> hand_labels,
                       std::int64_t elapsed_ms) {
    // Half of the pixels at a time: nothing here is in a hurry.
    const std::size_t middle = z.size() / 2;
    const bool upper = !upper_is_newer_;
    upper_is_newer_ = upper;
    const auto elapsed = static_cast<float>(std::clamp<std::int64_t>(elapsed_ms, 0, kStepMaxMs));
    const float step = elapsed + elapsed_before_ms_;
    elapsed_before_ms_ = elapsed;
    const float drift = std::min(1.0F, kDriftPerSecond * step * 1e-3F);
    const float gain = step / static_cast<float>(std::max<std::int64_t>(1, settings_.hold_ms));
    const float hand_gain =
        step / static_cast<float>(std::max<std::int64_t>(1, settings_.hand_rest_ms));
    const float margin = settings_.margin_mm;
    const std::size_t end = upper ? middle : z.size();
    for (std::size_t i = upper ? 0 : middle; i < end; ++i) {
        const float v = z[i];
        if (v <= 0.0F) {
            continue;  // a shadow says nothing about the surface in it
        }
        const float bg = depth_[i];
        if (bg > 0.0F && v > bg - margin) {
            const bool behind = v > bg + margin;
            depth_[i] = behind ? 0.0F : bg + drift * (v - bg);
            rival_[i] = behind ? v : rival_[i];
            rival_seen_[i] = behind ? gain : std::max(0.0F, rival_seen_[i] - kForget * gain);
            continue;
        }
        const bool same = std::abs(v - rival_[i]) < margin;
        if (!same) {
            rival_seen_[i] -= kForget * gain;
            if (rival_seen_[i] <= 0.0F) {
                rival_[i] = v;
                rival_seen_[i] = 0.0F;
            }
            continue;
        }
        rival_[i] += drift * (v - rival_[i]);
        rival_seen_[i] += hand_labels[i] != 0 ? hand_gain : gain;
        if (rival_seen_[i] >= 1.0F) {
            depth_[i] = rival_[i];
            rival_seen_[i] = 0.0F;
        }
    }
}

}  // namespace xtrack::segment
