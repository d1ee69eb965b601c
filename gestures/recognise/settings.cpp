// SPDX-License-Identifier: Apache-2.0
#include <xtrack/gesture_settings.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <string>

namespace xtrack {

namespace {

struct Range {
    const char* name;
    double GestureSettings::*value;
    double min;
    double max;
};

using S = GestureSettings;
constexpr std::array kRanges{
    Range{"hand_confidence", &S::hand_confidence, 0.0, 1.0},
    Range{"hand_valid_ms", &S::hand_valid_ms, 0.0, 1000.0},
    Range{"lost_freeze_ms", &S::lost_freeze_ms, 20.0, 1000.0},
    Range{"gone_ms", &S::gone_ms, 120.0, 2000.0},
    Range{"entry_lockout_ms", &S::entry_lockout_ms, 0.0, 2000.0},
    Range{"velocity_window_ms", &S::velocity_window_ms, 60.0, 200.0},
    Range{"swipe_speed_mmps", &S::swipe_speed_mmps, 100.0, 3000.0},
    Range{"swipe_paddle_speed_mmps", &S::swipe_paddle_speed_mmps, 100.0, 3000.0},
    Range{"swipe_length_mm", &S::swipe_length_mm, 40.0, 600.0},
    Range{"swipe_dies_mmps", &S::swipe_dies_mmps, 50.0, 1000.0},
    Range{"swipe_horizontal_deg", &S::swipe_horizontal_deg, 5.0, 44.0},
    Range{"swipe_vertical_deg", &S::swipe_vertical_deg, 5.0, 44.0},
    Range{"swipe_depth_deg", &S::swipe_depth_deg, 10.0, 60.0},
    Range{"swipe_sideways_mm", &S::swipe_sideways_mm, 5.0, 200.0},
    Range{"swipe_sideways_share", &S::swipe_sideways_share, 0.0, 1.0},
    Range{"swipe_return_bar_ms", &S::swipe_return_bar_ms, 0.0, 2000.0},
    Range{"swipe_rest_mmps", &S::swipe_rest_mmps, 10.0, 200.0},
    Range{"swipe_return_memory_ms", &S::swipe_return_memory_ms, 0.0, 5000.0},
    Range{"swipe_return_share", &S::swipe_return_share, 0.0, 1.0},
    Range{"swipe_facing", &S::swipe_facing, 0.1, 1.0},
    Range{"swipe_back_speed_mmps", &S::swipe_back_speed_mmps, 100.0, 3000.0},
    Range{"swipe_back_length_mm", &S::swipe_back_length_mm, 40.0, 600.0},
    Range{"swipe_carried_speed_mmps", &S::swipe_carried_speed_mmps, 100.0, 3000.0},
    Range{"swipe_carried_length_mm", &S::swipe_carried_length_mm, 40.0, 600.0},
    Range{"swipe_pointing_extension", &S::swipe_pointing_extension, 0.0, 1.0},
    Range{"swipe_tip_share", &S::swipe_tip_share, 0.0, 1.0},
    Range{"push_speed_mmps", &S::push_speed_mmps, 100.0, 3000.0},
    Range{"push_window_ms", &S::push_window_ms, 100.0, 600.0},
    Range{"push_cone_deg", &S::push_cone_deg, 5.0, 60.0},
    Range{"push_turn_deg", &S::push_turn_deg, 0.0, 180.0},
    Range{"push_stable_mmps", &S::push_stable_mmps, 20.0, 500.0},
    Range{"push_stable_ms", &S::push_stable_ms, 0.0, 2000.0},
    Range{"push_facing", &S::push_facing, 0.0, 1.0},
    Range{"pinch_close_mm", &S::pinch_close_mm, 5.0, 40.0},
    Range{"pinch_close_share", &S::pinch_close_share, 0.0, 0.3},
    Range{"pinch_release_mm", &S::pinch_release_mm, 10.0, 80.0},
    Range{"pinch_noise_mm", &S::pinch_noise_mm, 0.0, 20.0},
    Range{"pinch_hold_ms", &S::pinch_hold_ms, 0.0, 1000.0},
    Range{"pinch_open_mm", &S::pinch_open_mm, 20.0, 120.0},
    Range{"pinch_approach_ms", &S::pinch_approach_ms, 50.0, 3000.0},
    Range{"pinch_palm_mmps", &S::pinch_palm_mmps, 20.0, 1000.0},
    Range{"pinch_blur_mm", &S::pinch_blur_mm, 2.0, 1000.0},
    Range{"pinch_settle_ms", &S::pinch_settle_ms, 0.0, 5000.0},
    Range{"pinch_others_fold", &S::pinch_others_fold, 0.05, 1.0},
    Range{"pinch_thumb_free_mm", &S::pinch_thumb_free_mm, 0.0, 100.0},
    Range{"pinch_bunch_mm", &S::pinch_bunch_mm, 0.0, 60.0},
    Range{"pinch_bunch_extension", &S::pinch_bunch_extension, 0.0, 1.0},
    Range{"pinch_index_share", &S::pinch_index_share, 0.0, 0.9},
    Range{"wave_within_ms", &S::wave_within_ms, 300.0, 5000.0},
    Range{"wave_stroke_mm", &S::wave_stroke_mm, 20.0, 300.0},
    Range{"wave_off_axis_mm", &S::wave_off_axis_mm, 10.0, 200.0},
    Range{"wave_rest_mmps", &S::wave_rest_mmps, 10.0, 200.0},
    Range{"wave_rest_ms", &S::wave_rest_ms, 0.0, 2000.0},
};

std::string text(double value) {
    if (!std::isfinite(value)) {
        return "not a number";
    }
    std::array<char, 32> buffer{};
    const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                   std::chars_format::general, 6);
    return {buffer.data(), end.ptr};
}

Error refuse(const std::string& what) {
    return {ErrorCode::invalid_argument, "gesture settings: " + what};
}

}  // namespace

// A gesture needs less than all of the hand: measured, those that are made at twice the speed at
// which the whole hand is seen are still found.
constexpr double kShareOfSpeed = 0.5;

GestureDemands demands_of(const GestureSettings& settings) noexcept {
    GestureDemands demands;
    if (settings.swipe) {
        demands.hand_mmps = std::max(demands.hand_mmps, settings.swipe_speed_mmps);
    }
    if (settings.push) {
        demands.hand_mmps = std::max(demands.hand_mmps, settings.push_speed_mmps);
    }
    if (settings.pinch) {
        // It begins at rest, and is an aperture of so many mm.
        demands.hand_mmps = std::max(demands.hand_mmps, settings.pinch_palm_mmps);
        demands.metric = true;
    }
    if (settings.wave) {
        // The fastest of a stroke that is a sine, as slow as strokes may follow each other.
        constexpr double kFastest = std::numbers::pi / 2.0;
        demands.hand_mmps =
            std::max(demands.hand_mmps, kFastest * settings.wave_stroke_mm * settings.wave_turns /
                                            (1e-3 * settings.wave_within_ms));
    }
    demands.hand_mmps *= kShareOfSpeed;
    return demands;
}

Result<void> validate(const GestureSettings& s) {
    for (const Range& r : kRanges) {
        const double value = s.*r.value;
        if (!(value >= r.min && value <= r.max)) {
            return refuse(std::string{r.name} + " is " + text(value) + "; give " + text(r.min) +
                          " to " + text(r.max));
        }
    }
    constexpr int kLeastTurns = 2;
    constexpr int kMostTurns = 12;
    if (s.wave_turns < kLeastTurns || s.wave_turns > kMostTurns) {
        return refuse("wave_turns is " + text(s.wave_turns) + "; give " + text(kLeastTurns) +
                      " to " + text(kMostTurns));
    }
    // Less hysteresis than three sigma chatters at the edge.
    const double release_min_mm = s.pinch_close_mm + 3.0 * s.pinch_noise_mm;
    if (s.pinch_release_mm < release_min_mm) {
        return refuse("pinch_release_mm is " + text(s.pinch_release_mm) + "; give at least " +
                      text(release_min_mm) + " (pinch_close_mm + 3 pinch_noise_mm)");
    }
    if (s.pinch_open_mm < s.pinch_release_mm) {
        return refuse("pinch_open_mm is " + text(s.pinch_open_mm) +
                      "; give at least pinch_release_mm, " + text(s.pinch_release_mm));
    }
    if (s.gone_ms < s.lost_freeze_ms) {
        return refuse("gone_ms is " + text(s.gone_ms) + "; give at least lost_freeze_ms, " +
                      text(s.lost_freeze_ms));
    }
    if (std::min(s.swipe_speed_mmps, s.swipe_paddle_speed_mmps) < s.swipe_dies_mmps ||
        s.swipe_rest_mmps >= s.swipe_dies_mmps) {
        return refuse("swipe_dies_mmps is " + text(s.swipe_dies_mmps) +
                      "; give more than swipe_rest_mmps and at most swipe_speed_mmps and "
                      "swipe_paddle_speed_mmps");
    }
    return {};
}

}  // namespace xtrack
