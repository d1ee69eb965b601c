// SPDX-License-Identifier: Apache-2.0
#include <xtrack/gesture_settings.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <type_traits>

#include "core/base/text.hpp"

namespace xtrack {

namespace {

// One way to read and write every type of field.
template <auto kMember>
double get(const GestureSettings& settings) {
    return static_cast<double>(settings.*kMember);
}
template <auto kMember>
void set(GestureSettings& settings, double value) {
    using Value = std::remove_reference_t<decltype(settings.*kMember)>;
    settings.*kMember = static_cast<Value>(value);
}

template <auto kMember>
constexpr GestureField toggle(const char* name) {
    return {name, 0.0, 1.0, true, true, get<kMember>, set<kMember>};
}
/// A switch that is no gesture's.
template <auto kMember>
constexpr GestureField rule(const char* name) {
    return {name, 0.0, 1.0, false, true, get<kMember>, set<kMember>};
}
template <auto kMember>
constexpr GestureField number(const char* name, double least, double most) {
    return {name, least, most, false, false, get<kMember>, set<kMember>};
}
template <auto kMember>
constexpr GestureField whole(const char* name, double least, double most) {
    return {name, least, most, false, true, get<kMember>, set<kMember>};
}

using S = GestureSettings;
constexpr std::array kFields{
    toggle<&S::swipe>("swipe"),
    toggle<&S::push>("push"),
    toggle<&S::pull>("pull"),
    toggle<&S::pinch>("pinch"),
    toggle<&S::double_pinch>("double_pinch"),
    toggle<&S::grab>("grab"),
    toggle<&S::tap>("tap"),
    toggle<&S::double_tap>("double_tap"),
    toggle<&S::circle>("circle"),
    toggle<&S::wave>("wave"),
    toggle<&S::raise>("raise"),
    toggle<&S::dwell>("dwell"),
    toggle<&S::press>("press"),
    toggle<&S::touch>("touch"),
    toggle<&S::drag>("drag"),
    toggle<&S::open_palm>("open_palm"),
    toggle<&S::fist>("fist"),
    toggle<&S::point>("point"),
    toggle<&S::victory>("victory"),
    toggle<&S::thumb_up>("thumb_up"),
    toggle<&S::thumb_down>("thumb_down"),
    toggle<&S::two_hand_zoom>("two_hand_zoom"),
    toggle<&S::two_hand_rotate>("two_hand_rotate"),
    toggle<&S::engage>("engage"),
    number<&S::hand_confidence>("hand_confidence", 0.0, 1.0),
    number<&S::hand_valid_ms>("hand_valid_ms", 0.0, 1000.0),
    number<&S::lost_freeze_ms>("lost_freeze_ms", 20.0, 1000.0),
    number<&S::gone_ms>("gone_ms", 120.0, 2000.0),
    number<&S::entry_lockout_ms>("entry_lockout_ms", 0.0, 2000.0),
    number<&S::velocity_window_ms>("velocity_window_ms", 60.0, 200.0),
    number<&S::silence_fist>("silence_fist", 0.5, 1.0),
    number<&S::silence_ms>("silence_ms", 100.0, 3000.0),
    number<&S::silence_open>("silence_open", 0.0, 0.95),
    number<&S::zone_left_mm>("zone_left_mm", -3000.0, 3000.0),
    number<&S::zone_right_mm>("zone_right_mm", -3000.0, 3000.0),
    number<&S::zone_bottom_mm>("zone_bottom_mm", -3000.0, 3000.0),
    number<&S::zone_top_mm>("zone_top_mm", -3000.0, 3000.0),
    number<&S::zone_near_mm>("zone_near_mm", -3000.0, 3000.0),
    number<&S::zone_far_mm>("zone_far_mm", -3000.0, 3000.0),
    number<&S::zone_margin_mm>("zone_margin_mm", 0.0, 200.0),
    rule<&S::engage_by_stillness>("engage_by_stillness"),
    rule<&S::engage_by_wave>("engage_by_wave"),
    rule<&S::engage_by_raise>("engage_by_raise"),
    number<&S::engage_still_mmps>("engage_still_mmps", 20.0, 500.0),
    number<&S::engage_ms>("engage_ms", 50.0, 3000.0),
    number<&S::engage_leave_ms>("engage_leave_ms", 50.0, 3000.0),
    number<&S::engage_idle_ms>("engage_idle_ms", 1000.0, 600000.0),
    number<&S::engage_idle_mm>("engage_idle_mm", 5.0, 300.0),
    number<&S::engage_return_ms>("engage_return_ms", 0.0, 10000.0),
    number<&S::engage_return_mm>("engage_return_mm", 20.0, 1000.0),
    number<&S::body_width_mm>("body_width_mm", 100.0, 2000.0),
    number<&S::body_height_mm>("body_height_mm", 100.0, 2000.0),
    number<&S::body_depth_mm>("body_depth_mm", 100.0, 2000.0),
    number<&S::swipe_speed_mmps>("swipe_speed_mmps", 100.0, 3000.0),
    number<&S::swipe_paddle_speed_mmps>("swipe_paddle_speed_mmps", 100.0, 3000.0),
    number<&S::swipe_length_mm>("swipe_length_mm", 40.0, 600.0),
    rule<&S::swipe_vertical>("swipe_vertical"),
    number<&S::swipe_dies_mmps>("swipe_dies_mmps", 50.0, 1000.0),
    number<&S::swipe_horizontal_deg>("swipe_horizontal_deg", 5.0, 44.0),
    number<&S::swipe_vertical_deg>("swipe_vertical_deg", 5.0, 44.0),
    number<&S::swipe_depth_deg>("swipe_depth_deg", 10.0, 60.0),
    number<&S::swipe_body_deg>("swipe_body_deg", 10.0, 60.0),
    number<&S::swipe_below_mm>("swipe_below_mm", 60.0, 2000.0),
    rule<&S::swipe_prepared>("swipe_prepared"),
    number<&S::swipe_prepared_mm>("swipe_prepared_mm", 0.0, 200.0),
    number<&S::swipe_flick_mmps>("swipe_flick_mmps", 100.0, 3000.0),
    number<&S::swipe_sideways_mm>("swipe_sideways_mm", 5.0, 200.0),
    number<&S::swipe_sideways_share>("swipe_sideways_share", 0.0, 1.0),
    number<&S::swipe_bend_deg>("swipe_bend_deg", 10.0, 180.0),
    number<&S::swipe_open>("swipe_open", 0.0, 1.0),
    number<&S::swipe_grab>("swipe_grab", 0.0, 1.0),
    number<&S::swipe_return_bar_ms>("swipe_return_bar_ms", 0.0, 2000.0),
    number<&S::swipe_rest_mmps>("swipe_rest_mmps", 10.0, 200.0),
    number<&S::swipe_return_memory_ms>("swipe_return_memory_ms", 0.0, 5000.0),
    number<&S::swipe_return_share>("swipe_return_share", 0.0, 1.0),
    number<&S::swipe_facing>("swipe_facing", 0.1, 1.0),
    number<&S::swipe_back_speed_mmps>("swipe_back_speed_mmps", 100.0, 3000.0),
    number<&S::swipe_back_length_mm>("swipe_back_length_mm", 40.0, 600.0),
    number<&S::swipe_carried_speed_mmps>("swipe_carried_speed_mmps", 100.0, 3000.0),
    number<&S::swipe_carried_length_mm>("swipe_carried_length_mm", 40.0, 600.0),
    number<&S::swipe_pointing_extension>("swipe_pointing_extension", 0.0, 1.0),
    number<&S::swipe_tip_share>("swipe_tip_share", 0.0, 1.0),
    number<&S::push_speed_mmps>("push_speed_mmps", 100.0, 3000.0),
    number<&S::push_window_ms>("push_window_ms", 100.0, 600.0),
    number<&S::push_cone_deg>("push_cone_deg", 5.0, 60.0),
    number<&S::push_turn_deg>("push_turn_deg", 0.0, 180.0),
    number<&S::push_stable_mmps>("push_stable_mmps", 20.0, 500.0),
    number<&S::push_stable_ms>("push_stable_ms", 0.0, 2000.0),
    number<&S::push_return_memory_ms>("push_return_memory_ms", 0.0, 5000.0),
    number<&S::push_facing>("push_facing", 0.0, 1.0),
    number<&S::pull_length_mm>("pull_length_mm", 40.0, 600.0),
    number<&S::pinch_close_mm>("pinch_close_mm", 5.0, 40.0),
    number<&S::pinch_close_share>("pinch_close_share", 0.0, 0.3),
    number<&S::pinch_release_mm>("pinch_release_mm", 10.0, 80.0),
    number<&S::pinch_noise_mm>("pinch_noise_mm", 0.0, 20.0),
    number<&S::pinch_hold_ms>("pinch_hold_ms", 0.0, 1000.0),
    number<&S::pinch_open_mm>("pinch_open_mm", 20.0, 120.0),
    number<&S::pinch_approach_ms>("pinch_approach_ms", 50.0, 3000.0),
    number<&S::pinch_palm_mmps>("pinch_palm_mmps", 20.0, 1000.0),
    number<&S::pinch_blur_mm>("pinch_blur_mm", 2.0, 1000.0),
    number<&S::pinch_settle_ms>("pinch_settle_ms", 0.0, 5000.0),
    number<&S::pinch_others_fold>("pinch_others_fold", 0.05, 1.0),
    number<&S::pinch_thumb_free_mm>("pinch_thumb_free_mm", 0.0, 100.0),
    number<&S::pinch_bunch_mm>("pinch_bunch_mm", 0.0, 60.0),
    number<&S::pinch_bunch_extension>("pinch_bunch_extension", 0.0, 1.0),
    number<&S::pinch_index_share>("pinch_index_share", 0.0, 0.9),
    number<&S::grab_strength>("grab_strength", 0.3, 1.0),
    number<&S::grab_release>("grab_release", 0.1, 0.9),
    number<&S::grab_hold_ms>("grab_hold_ms", 0.0, 1000.0),
    number<&S::grab_open>("grab_open", 0.0, 0.6),
    number<&S::grab_approach_ms>("grab_approach_ms", 50.0, 3000.0),
    number<&S::grab_palm_mmps>("grab_palm_mmps", 20.0, 2000.0),
    number<&S::grab_settle_ms>("grab_settle_ms", 0.0, 5000.0),
    number<&S::grab_thumb_share>("grab_thumb_share", 0.05, 1.0),
    number<&S::tap_flexion_deg>("tap_flexion_deg", 10.0, 120.0),
    number<&S::tap_lean_deg>("tap_lean_deg", 10.0, 60.0),
    number<&S::tap_speed_degps>("tap_speed_degps", 50.0, 2000.0),
    number<&S::tap_open_deg>("tap_open_deg", 5.0, 90.0),
    number<&S::tap_open_share>("tap_open_share", 0.1, 1.0),
    number<&S::tap_within_ms>("tap_within_ms", 100.0, 3000.0),
    number<&S::tap_pointing_extension>("tap_pointing_extension", 0.0, 1.0),
    number<&S::tap_palm_mm>("tap_palm_mm", 10.0, 500.0),
    number<&S::tap_others_bend>("tap_others_bend", 0.0, 2.0),
    number<&S::tap_others_stretch>("tap_others_stretch", 0.0, 2.0),
    number<&S::double_within_ms>("double_within_ms", 100.0, 2000.0),
    number<&S::circle_least_mm>("circle_least_mm", 10.0, 200.0),
    number<&S::circle_most_mm>("circle_most_mm", 100.0, 1000.0),
    number<&S::circle_turns>("circle_turns", 0.5, 2.0),
    number<&S::circle_error>("circle_error", 0.05, 0.6),
    number<&S::circle_stale_ms>("circle_stale_ms", 50.0, 2000.0),
    number<&S::circle_within_ms>("circle_within_ms", 500.0, 10000.0),
    number<&S::press_slow_mmps>("press_slow_mmps", 20.0, 1000.0),
    number<&S::press_slow_way_mm>("press_slow_way_mm", 5.0, 200.0),
    number<&S::press_fast_mmps>("press_fast_mmps", 20.0, 1000.0),
    number<&S::press_fast_way_mm>("press_fast_way_mm", 5.0, 200.0),
    number<&S::press_cone_deg>("press_cone_deg", 5.0, 85.0),
    number<&S::press_cone_without_drag_deg>("press_cone_without_drag_deg", 5.0, 85.0),
    number<&S::press_decay_mm>("press_decay_mm", 10.0, 500.0),
    number<&S::press_up_force>("press_up_force", 0.5, 0.99),
    number<&S::press_rearm_force>("press_rearm_force", 0.0, 0.95),
    number<&S::press_most_ms>("press_most_ms", 200.0, 60000.0),
    number<&S::touch_plane_mm>("touch_plane_mm", -2000.0, 2000.0),
    number<&S::touch_mm>("touch_mm", 5.0, 300.0),
    number<&S::touch_release_mm>("touch_release_mm", 10.0, 400.0),
    number<&S::touch_progress_mm>("touch_progress_mm", 20.0, 1000.0),
    number<&S::dwell_radius_mm>("dwell_radius_mm", 1.0, 50.0),
    number<&S::dwell_still_ms>("dwell_still_ms", 100.0, 3000.0),
    number<&S::dwell_fill_ms>("dwell_fill_ms", 100.0, 2000.0),
    number<&S::dwell_cancel_mm>("dwell_cancel_mm", 2.0, 100.0),
    number<&S::dwell_rearm_mm>("dwell_rearm_mm", 2.0, 200.0),
    number<&S::drag_mm>("drag_mm", 3.0, 200.0),
    number<&S::drag_grab_mm>("drag_grab_mm", 3.0, 200.0),
    number<&S::two_hand_zoom_mm>("two_hand_zoom_mm", 5.0, 200.0),
    number<&S::two_hand_rotate_deg>("two_hand_rotate_deg", 2.0, 90.0),
    whole<&S::wave_turns>("wave_turns", 2.0, 12.0),
    number<&S::wave_within_ms>("wave_within_ms", 300.0, 5000.0),
    number<&S::wave_stroke_mm>("wave_stroke_mm", 20.0, 300.0),
    number<&S::wave_off_axis_mm>("wave_off_axis_mm", 10.0, 200.0),
    number<&S::wave_rest_mmps>("wave_rest_mmps", 10.0, 200.0),
    number<&S::wave_rest_ms>("wave_rest_ms", 0.0, 2000.0),
    number<&S::raise_mm>("raise_mm", 50.0, 600.0),
    number<&S::raise_within_ms>("raise_within_ms", 200.0, 1000.0),
    number<&S::raise_still_mmps>("raise_still_mmps", 10.0, 200.0),
    number<&S::raise_still_ms>("raise_still_ms", 0.0, 700.0),
    number<&S::pose_begin>("pose_begin", 0.3, 1.0),
    number<&S::pose_end>("pose_end", 0.0, 0.9),
    number<&S::pose_hold_ms>("pose_hold_ms", 0.0, 3000.0),
    number<&S::pose_palm_mmps>("pose_palm_mmps", 20.0, 1000.0),
    number<&S::pose_end_ms>("pose_end_ms", 0.0, 1000.0),
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

bool allowed(const GestureField& field, double value) {
    // False for NaN.
    return value >= field.least && value <= field.most &&
           (!field.whole || value == std::floor(value));
}

Error refusal(const GestureField& field, const std::string& value) {
    const std::string range =
        field.is_switch ? "on or off" : text(field.least) + " to " + text(field.most);
    return refuse(std::string{field.name} + " is " + value + "; give " +
                  (field.whole && !field.is_switch ? "a whole number from " : "") + range);
}

/// Of a field that is a number.
std::string name_of(double S::*member) {
    // Fields are functions: the one that reads what was written here is the field.
    S probe;
    probe.*member = std::numeric_limits<double>::infinity();
    const auto* field = std::ranges::find_if(
        kFields, [&](const GestureField& one) { return std::isinf(one.get(probe)); });
    return field->name;
}

std::optional<double> value_of(const GestureField& field, std::string_view text) {
    if (field.is_switch && (text == "on" || text == "off")) {
        return text == "on" ? 1.0 : 0.0;
    }
    return base::parse_double(text);
}

}  // namespace

namespace {

std::array<GestureType, kGestureTypeCount> all_types() {
    std::array<GestureType, kGestureTypeCount> types{};
    for (std::size_t t = 0; t < types.size(); ++t) {
        types[t] = static_cast<GestureType>(t);
    }
    return types;
}

// A gesture needs less than all of the hand: measured, those that are made at twice the speed at
// which the whole hand is seen are still found.
constexpr double kShareOfSpeed = 0.5;

}  // namespace

bool needs_millimetres(GestureType type) noexcept {
    switch (type) {
        case GestureType::pinch:
        case GestureType::double_pinch:
        case GestureType::tap:
        case GestureType::double_tap:
        case GestureType::press:
        case GestureType::touch:
        case GestureType::drag:
        case GestureType::two_hand_zoom:
        case GestureType::two_hand_rotate: return true;
        case GestureType::hand:
        case GestureType::engage:
        case GestureType::swipe:
        case GestureType::push:
        case GestureType::pull:
        case GestureType::grab:
        case GestureType::circle:
        case GestureType::wave:
        case GestureType::raise:
        case GestureType::dwell:
        case GestureType::open_palm:
        case GestureType::fist:
        case GestureType::point:
        case GestureType::victory:
        case GestureType::thumb_up:
        case GestureType::thumb_down: break;
    }
    return false;
}

GestureSettings without_millimetres(const GestureSettings& settings) {
    GestureSettings left = settings;
    for (const GestureType type : all_types()) {
        if (needs_millimetres(type)) {
            (void)set_field(left, to_string(type), "off");
        }
    }
    return left;
}

GestureDemands demands_of(const GestureSettings& settings) noexcept {
    GestureDemands demands;
    if (settings.swipe) {
        demands.hand_mmps = std::max(demands.hand_mmps, settings.swipe_speed_mmps);
    }
    if (settings.push || settings.pull) {
        demands.hand_mmps = std::max(demands.hand_mmps, settings.push_speed_mmps);
    }
    if (settings.pinch) {
        // It begins at rest, and is an aperture of so many mm.
        demands.hand_mmps = std::max(demands.hand_mmps, settings.pinch_palm_mmps);
    }
    if (settings.wave) {
        // The fastest of a stroke that is a sine, as slow as strokes may follow each other.
        constexpr double kFastest = std::numbers::pi / 2.0;
        demands.hand_mmps =
            std::max(demands.hand_mmps, kFastest * settings.wave_stroke_mm * settings.wave_turns /
                                            (1e-3 * settings.wave_within_ms));
    }
    demands.hand_mmps *= kShareOfSpeed;
    demands.metric = std::ranges::any_of(all_types(), [&](GestureType type) {
        return needs_millimetres(type) && is_wanted(settings, type);
    });
    return demands;
}

std::span<const GestureField> gesture_fields() noexcept { return kFields; }

Result<void> set_field(GestureSettings& settings, std::string_view name, std::string_view text) {
    const auto* field =
        std::ranges::find_if(kFields, [&](const GestureField& one) { return name == one.name; });
    if (field == kFields.end()) {
        // Those that begin alike, so that a slip of the pen is seen.
        constexpr std::size_t kAlike = 3;
        std::string alike;
        for (const GestureField& one : kFields) {
            if (name.size() >= kAlike &&
                std::string_view(one.name).starts_with(name.substr(0, kAlike))) {
                alike += std::string(alike.empty() ? "; there is " : ", ") + one.name;
            }
        }
        return refuse(base::quoted(name) + " is none of them" + alike);
    }
    const std::optional<double> value = value_of(*field, text);
    if (!value || !allowed(*field, *value)) {
        return refusal(*field, base::quoted(text));
    }
    field->set(settings, *value);
    return {};
}

bool is_wanted(const GestureSettings& s, GestureType type) noexcept {
    switch (type) {
        case GestureType::hand: return true;
        case GestureType::engage: return s.engage;
        case GestureType::swipe: return s.swipe;
        case GestureType::push: return s.push;
        case GestureType::pull: return s.pull;
        case GestureType::pinch: return s.pinch;
        case GestureType::double_pinch: return s.double_pinch;
        case GestureType::grab: return s.grab;
        case GestureType::tap: return s.tap;
        case GestureType::double_tap: return s.double_tap;
        case GestureType::circle: return s.circle;
        case GestureType::wave: return s.wave;
        case GestureType::raise: return s.raise;
        case GestureType::dwell: return s.dwell;
        case GestureType::press: return s.press;
        case GestureType::touch: return s.touch;
        case GestureType::drag: return s.drag;
        case GestureType::open_palm: return s.open_palm;
        case GestureType::fist: return s.fist;
        case GestureType::point: return s.point;
        case GestureType::victory: return s.victory;
        case GestureType::thumb_up: return s.thumb_up;
        case GestureType::thumb_down: return s.thumb_down;
        case GestureType::two_hand_zoom: return s.two_hand_zoom;
        case GestureType::two_hand_rotate: return s.two_hand_rotate;
    }
    return false;
}

Result<void> validate(const GestureSettings& s) {
    for (const GestureField& field : kFields) {
        if (!allowed(field, field.get(s))) {
            return refusal(field, text(field.get(s)));
        }
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
    struct Order {
        double S::*less;
        double S::*more;
    };
    constexpr std::array kOrders{
        Order{&S::silence_open, &S::silence_fist},
        Order{&S::zone_left_mm, &S::zone_right_mm},
        Order{&S::zone_bottom_mm, &S::zone_top_mm},
        Order{&S::zone_near_mm, &S::zone_far_mm},
        Order{&S::press_slow_mmps, &S::press_fast_mmps},
        Order{&S::press_fast_way_mm, &S::press_slow_way_mm},
        Order{&S::press_rearm_force, &S::press_up_force},
        Order{&S::touch_mm, &S::touch_release_mm},
        Order{&S::touch_release_mm, &S::touch_progress_mm},
        Order{&S::dwell_radius_mm, &S::dwell_cancel_mm},
        Order{&S::dwell_cancel_mm, &S::dwell_rearm_mm},
    };
    for (const Order& order : kOrders) {
        if (!(s.*order.less < s.*order.more)) {
            return refuse(name_of(order.less) + " is " + text(s.*order.less) + "; give less than " +
                          name_of(order.more) + ", " + text(s.*order.more));
        }
    }
    if (s.drag && !s.pinch && !s.grab && !s.press) {
        return refuse("drag is on; switch pinch, grab or press on, which it goes on from");
    }
    // Strengths and scores scatter by a few hundredths.
    constexpr double kApart = 0.1;
    if (s.grab_strength - s.grab_release < kApart) {
        return refuse("grab_release is " + text(s.grab_release) + "; give at most " +
                      text(s.grab_strength - kApart) + " (grab_strength - 0.1)");
    }
    if (s.grab_open >= s.grab_release) {
        return refuse("grab_open is " + text(s.grab_open) + "; give less than grab_release, " +
                      text(s.grab_release));
    }
    if (s.pose_begin - s.pose_end < kApart) {
        return refuse("pose_end is " + text(s.pose_end) + "; give at most " +
                      text(s.pose_begin - kApart) + " (pose_begin - 0.1)");
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
