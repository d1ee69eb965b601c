// SPDX-License-Identifier: Apache-2.0
//
//          bends
//  ready ─────────▶ bent
//    ▲                │ opens (begin and end are sent)
//    │                │ late, astray, dropped (silent)
//    └────────────────┘
//
// The index bends quickly and alone, and straightens again: that is when a tap is known to be one.
// Joints say how far it bends. Of a camera's hand it is how far the way from palm to index tip
// leans toward the screen, the median of a moment, because tips are taken for one another.
#include "gestures/recognise/machines/tap.hpp"

#include <algorithm>
#include <cmath>

#include "gestures/recognise/line_fit.hpp"

namespace xtrack::recognise {

namespace {

constexpr float kConfidence = 0.9F;
constexpr float kDegrees = 57.29578F;
// How far back the straight finger is looked for. At tap_speed_degps a bend takes half of it.
constexpr Duration kLookBack = std::chrono::milliseconds{300};
// Tips of a camera's hand: the median over it, of so many at least, of slow cameras over the longer
// time. Half of it is what a tap comes late by.
constexpr Duration kMedianOver = std::chrono::milliseconds{80};
constexpr Duration kMedianOverMost = std::chrono::milliseconds{140};
constexpr std::size_t kMedianOf = 3;
constexpr std::size_t kMostTips = 9;
constexpr float kShortestMm = 20.0F;  // palm to tip; a nearer one is no finger
// An open hand taps with its index alone, faster than its fingers fidget, and with a still palm:
// shares of the index's bend, of tap_speed_degps and of tap_palm_mm. What is over sooner is a
// tracker's mistake. Measured: fidgets 200..370 degrees a second.
constexpr double kOpenOthersShare = 0.2;
constexpr double kOpenSpeedShare = 2.5;
constexpr double kOpenPalmShare = 0.25;
constexpr double kOpenLeastMs = 200.0;
constexpr double kUnknown = static_cast<double>(kFlexionUnknown);

double lean_deg(const MotionSample& sample) {
    if (!sample.index_tip_known) {
        return kUnknown;
    }
    const Vec3f reach = sample.index_tip_mm - sample.palm_mm;
    const float length_mm = reach.norm();
    return length_mm < kShortestMm
               ? kUnknown
               : static_cast<double>(kDegrees *
                                     std::asin(std::clamp(-reach.z() / length_mm, -1.0F, 1.0F)));
}

/// How far the index is bent, degrees from where it is straight.
double bend_deg(const MotionHistory& history, std::size_t back) {
    const MotionSample& sample = history.at(back);
    if (sample.from_joints) {
        return static_cast<double>(
            sample.flexion[static_cast<std::size_t>(Finger::index)].inner_deg);
    }
    std::array<double, kMostTips> known{};
    std::size_t n = 0;
    for (std::size_t i = back; i < history.size() && n < kMostTips; ++i) {
        if (sample.stamp - history.at(i).stamp > (n < kMedianOf ? kMedianOverMost : kMedianOver)) {
            break;
        }
        const double deg = lean_deg(history.at(i));
        if (deg > kUnknown) {
            known[n++] = deg;
        }
    }
    if (n < kMedianOf) {
        return kUnknown;
    }
    std::nth_element(known.begin(), known.begin() + static_cast<std::ptrdiff_t>(n / 2),
                     known.begin() + static_cast<std::ptrdiff_t>(n));
    return known[n / 2];
}

/// Line fit over `window`.
double bending_degps(const MotionHistory& history, Duration window) {
    const Stamp now = history.newest().stamp;
    LineFit fit(Vec3f::Zero());
    for (std::size_t i = 0; i < history.size(); ++i) {
        if (i >= 2 && now - history.at(i).stamp > window) {
            break;
        }
        const double deg = bend_deg(history, i);
        if (deg > kUnknown) {
            fit.add(-to_seconds(now - history.at(i).stamp),
                    Vec3f{static_cast<float>(deg), 0.0F, 0.0F});
        }
    }
    return static_cast<double>(fit.slope().x());
}

}  // namespace

const char* TapMachine::name(State s) {
    switch (s) {
        case State::ready: return "ready";
        case State::bent: return "bent";
    }
    return "?";
}

const char* TapMachine::name(Event e) {
    switch (e) {
        case Event::moving: return "moving";
        case Event::bends: return "bends";
        case Event::opens: return "opens";
        case Event::late: return "late";
        case Event::astray: return "astray";
        case Event::dropped: return "dropped";
    }
    return "?";
}

void TapMachine::update(const Context& c) {
    if (c.gate != Gate::open || c.taken) {
        drop(c, CancelReason::none, c.taken ? "another gesture has the hand" : why(c.gate));
        return;
    }
    const double deg = bend_deg(c.history, 0);
    const double degps = bending_degps(c.history, from_ms(c.settings.velocity_window_ms));
    Refusal refusal;
    const Event event = state() == State::ready ? look_for_press(c, deg, degps, refusal)
                                                : follow_press(c, deg, degps, refusal);
    handle(c, event, refusal);
}

void TapMachine::drop(const Context& c, CancelReason /*reason*/, const char* why) {
    not_before_ = c.sensor;
    if (state() != State::ready) {
        handle(c, Event::dropped, {why, 0.0, 0.0});
    }
}

std::optional<TapMachine::State> TapMachine::next(const Context& c, Event event) {
    switch (state()) {
        case State::ready: return ready(c, event);
        case State::bent: return bent(c, event);
    }
    return std::nullopt;
}

std::optional<TapMachine::State> TapMachine::ready(const Context& /*c*/, Event event) {
    switch (event) {
        case Event::moving:
        case Event::dropped: return State::ready;
        case Event::bends: return State::bent;
        case Event::opens:
        case Event::late:
        case Event::astray: break;
    }
    return std::nullopt;
}

std::optional<TapMachine::State> TapMachine::bent(const Context& c, Event event) {
    switch (event) {
        case Event::moving: return State::bent;
        case Event::opens: commit(c); return State::ready;
        case Event::late:
        case Event::astray:
        case Event::dropped: return State::ready;
        case Event::bends: break;
    }
    return std::nullopt;
}

TapMachine::Event TapMachine::look_for_press(const Context& c, double deg, double degps,
                                             Refusal& refusal) {
    const GestureSettings& s = c.settings;
    if (deg <= kUnknown || degps < s.tap_speed_degps) {
        return Event::moving;
    }
    const Stamp now = c.history.newest().stamp;
    Bend base{now, deg, 0};
    for (std::size_t i = 1; i < c.history.size(); ++i) {
        const MotionSample& past = c.history.at(i);
        if (now - past.stamp > kLookBack || past.stamp < not_before_) {
            break;
        }
        const double past_deg = bend_deg(c.history, i);
        if (past_deg > kUnknown && past_deg < base.deg) {
            base = {past.stamp, past_deg, i};
        }
    }
    const MotionSample& before = c.history.at(base.back);
    const double least_deg = before.from_joints ? s.tap_flexion_deg : s.tap_lean_deg;
    if (deg - base.deg < least_deg) {
        refusal = {"bends little", deg - base.deg, least_deg};
        return Event::moving;
    }
    const double smear_mm = c.history.smear_mm(from_ms(s.velocity_window_ms), base.back);
    if (smear_mm > s.pinch_blur_mm) {
        refusal = {"the palm moved too fast to see fingers", smear_mm, s.pinch_blur_mm};
        return Event::moving;
    }
    press_ = {};
    press_.base = base;
    press_.of_open_hand = before.from_joints &&
                          static_cast<double>(before.outer_extension()) > s.tap_pointing_extension;
    press_.palm_mm = before.palm_mm;
    press_.others = before.flexion;
    press_.peak_deg = deg;
    press_.others_at_peak = c.history.newest().flexion;
    press_.speed_degps = degps;
    return Event::bends;
}

TapMachine::Event TapMachine::follow_press(const Context& c, double deg, double degps,
                                           Refusal& refusal) {
    const GestureSettings& s = c.settings;
    const MotionSample& now = c.history.newest();
    const double lasted_ms = to_ms(now.stamp - press_.base.stamp);
    if (lasted_ms > s.tap_within_ms) {
        refusal = {"stays bent", lasted_ms, s.tap_within_ms};
        return Event::late;
    }
    const auto strays_mm = static_cast<double>((now.palm_mm - press_.palm_mm).norm());
    const double most_mm = press_.of_open_hand ? kOpenPalmShare * s.tap_palm_mm : s.tap_palm_mm;
    if (strays_mm > most_mm) {
        refusal = {"the palm moves", strays_mm, most_mm};
        return Event::astray;
    }
    if (deg <= kUnknown) {
        return Event::moving;
    }
    press_.speed_degps = std::max(press_.speed_degps, degps);
    if (deg > press_.peak_deg) {
        press_.peak_deg = deg;
        press_.others_at_peak = now.flexion;
    }
    const double bent = press_.peak_deg - press_.base.deg;
    if (press_.peak_deg - deg < std::max(s.tap_open_deg, s.tap_open_share * bent)) {
        return Event::moving;
    }
    if (press_.of_open_hand) {
        if (press_.speed_degps < kOpenSpeedShare * s.tap_speed_degps) {
            refusal = {"slow for an open hand", press_.speed_degps,
                       kOpenSpeedShare * s.tap_speed_degps};
            return Event::astray;
        }
        if (lasted_ms < kOpenLeastMs) {
            refusal = {"too short for a finger", lasted_ms, kOpenLeastMs};
            return Event::astray;
        }
    }
    refusal = other_fingers(c);
    return *refusal.why == '\0' ? Event::opens : Event::astray;
}

/// Fingers that bend with the index make a fist, ones that stretch with it show a number.
Refusal TapMachine::other_fingers(const Context& c) const {
    const GestureSettings& s = c.settings;
    const double index_deg = press_.peak_deg - press_.base.deg;
    for (const Finger finger : {Finger::middle, Finger::ring, Finger::little}) {
        const auto f = static_cast<std::size_t>(finger);
        const float was_deg = press_.others[f].inner_deg;
        const float is_deg = press_.others_at_peak[f].inner_deg;
        if (was_deg <= kFlexionUnknown || is_deg <= kFlexionUnknown) {
            continue;
        }
        const auto deg = static_cast<double>(is_deg - was_deg);
        if (press_.of_open_hand && std::abs(deg) > kOpenOthersShare * index_deg) {
            return {"another finger of an open hand moves", std::abs(deg),
                    kOpenOthersShare * index_deg};
        }
        if (deg > s.tap_others_bend * index_deg) {
            return {"another finger bends with it", deg, s.tap_others_bend * index_deg};
        }
        if (-deg > s.tap_others_stretch * index_deg) {
            return {"another finger stretches", -deg, s.tap_others_stretch * index_deg};
        }
    }
    const MotionSample& now = c.history.newest();
    const auto outer = static_cast<double>(now.outer_extension());
    if (!press_.of_open_hand && now.from_joints && outer > s.tap_pointing_extension) {
        return {"the hand opens", outer, s.tap_pointing_extension};
    }
    return {};
}

void TapMachine::commit(const Context& c) {
    gesture_id_ = c.next_gesture_id++;
    GestureEvent e = event_of(c, GestureType::tap, EventPhase::begin);
    e.gesture_id = gesture_id_;
    e.onset = press_.base.stamp;
    if (c.history.newest().index_tip_known) {
        e.position_mm = c.history.newest().index_tip_mm;
    }
    e.progress = 1.0F;
    e.value = static_cast<float>(press_.speed_degps);
    e.confidence *= kConfidence;
    c.out.add(e);
    e.phase = EventPhase::end;
    c.out.add(e);
}

}  // namespace xtrack::recognise
