// SPDX-License-Identifier: Apache-2.0
//
//          down (begin)              up, late, finished (end)
//  ready ──────────────▶ pressed ⟲ ──────────────────────────▶ lifting
//    ▲                     │  │ (update)                         │ ▲
//    │ dropped (cancel)    │  │ superseded (cancel)              │ │ up, finished
//    ├─────────────────────┘  └────────▶ carried ────────────────┼─┘
//    │          dropped                     │                    │
//    ├──────────────────────────────────────┘                    │
//    └───────────────────────────────────────────────────────────┘
//       risen, dropped
//
// A virtual force grows while the hand moves toward the screen, the faster the more for every
// millimetre, and shrinks while it moves back or aside (Ultraleap TouchFree, AirPush).
#include "gestures/recognise/machines/press.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "gestures/recognise/machines/angles.hpp"

namespace xtrack::recognise {

namespace {

constexpr float kConfidence = 0.9F;

}  // namespace

const char* PressMachine::name(State s) {
    switch (s) {
        case State::ready: return "ready";
        case State::pressed: return "pressed";
        case State::carried: return "carried";
        case State::lifting: return "lifting";
    }
    return "?";
}

const char* PressMachine::name(Event e) {
    switch (e) {
        case Event::weak: return "weak";
        case Event::down: return "down";
        case Event::strong: return "strong";
        case Event::up: return "up";
        case Event::risen: return "risen";
        case Event::late: return "late";
        case Event::superseded: return "superseded";
        case Event::dropped: return "dropped";
        case Event::finished: return "finished";
    }
    return "?";
}

/// Where the palm is, as the mean over the velocity's window.
Vec3f PressMachine::place_of(const Context& c) {
    const std::size_t samples = c.history.count_within(from_ms(c.settings.velocity_window_ms));
    Vec3f sum = Vec3f::Zero();
    for (std::size_t i = 0; i < samples; ++i) {
        sum += c.history.at(i).palm_mm;
    }
    return sum / static_cast<float>(samples);
}

/// The force of a press that is down: by places, because speeds that are added up drift with noise,
/// which a force that is cut at 1 would feel one way only.
void PressMachine::let_up(const Context& c) {
    const GestureSettings& s = c.settings;
    const Vec3f place_mm = place_of(c);
    if (place_mm.z() < deepest_mm_.z()) {
        // Aside as well, within the cone: a slanted press that goes on is none that lets up.
        const float deeper_mm = deepest_mm_.z() - place_mm.z();
        const double cone_rad = s.press_cone_without_drag_deg * std::numbers::pi / 180.0;
        const float most_mm = deeper_mm * static_cast<float>(std::tan(cone_rad));
        const Vec2f aside_mm = (place_mm - deepest_mm_).head<2>();
        const float share = std::min(1.0F, most_mm / std::max(aside_mm.norm(), most_mm));
        deepest_mm_.head<2>() += share * aside_mm;
        deepest_mm_.z() = place_mm.z();
    }
    const Vec3f off_mm = place_mm - deepest_mm_;
    force_ = 1.0 - static_cast<double>(off_mm.z()) / s.press_slow_way_mm;
    if (!s.drag) {
        force_ -= static_cast<double>(off_mm.head<2>().norm()) / s.press_decay_mm;
    }
    force_ = std::clamp(force_, 0.0, 1.0);
}

/// The force of a hand that is ready, after the newest sample.
void PressMachine::push_on(const Context& c) {
    const GestureSettings& s = c.settings;
    if (c.history.size() < 2) {
        return;
    }
    // Steps of the line fit: those of single samples are mostly noise, which sideways would add up.
    const Duration window = from_ms(s.velocity_window_ms);
    const Vec3f velocity = c.history.velocity(window);
    const double step_s = to_seconds(c.history.at(0).stamp - c.history.at(1).stamp);
    const auto toward_mmps = static_cast<double>(-velocity.z());
    const auto aside_mmps = static_cast<double>(velocity.head<2>().norm());
    const double toward_mm = toward_mmps * step_s;
    if (aside_mmps >= c.signal.still_mmps(0.0, window)) {
        force_ -= aside_mmps * step_s / s.press_decay_mm;
    }
    if (toward_mm < 0.0) {
        force_ += toward_mm / s.press_slow_way_mm;
    } else if (toward_mmps >= c.signal.still_mmps(s.press_slow_mmps, window)) {
        const double off_deg = degrees(std::atan2(aside_mmps, toward_mmps));
        const double cone_deg = s.drag ? s.press_cone_deg : s.press_cone_without_drag_deg;
        if (off_deg <= cone_deg) {
            const double fast = std::clamp(
                (toward_mmps - s.press_slow_mmps) / (s.press_fast_mmps - s.press_slow_mmps), 0.0,
                1.0);
            const double way_mm =
                s.press_slow_way_mm + fast * fast * (s.press_fast_way_mm - s.press_slow_way_mm);
            force_ += toward_mm / way_mm;
        } else {
            refusal_ = {"off the normal", off_deg, cone_deg};
        }
    } else {
        refusal_ = {"slow", toward_mmps, s.press_slow_mmps};
    }
    force_ = std::clamp(force_, 0.0, 1.0);
}

void PressMachine::update(const Context& c) {
    const GestureSettings& s = c.settings;
    if (c.gate != Gate::open || (c.taken && state() != State::carried)) {
        drop(c, c.taken ? CancelReason::superseded : reason_of(c.gate),
             c.taken ? "another gesture has the hand" : why(c.gate));
        force_ = 0.0;
        return;
    }
    const bool rested = force_ <= 0.0;
    refusal_ = {};
    state() == State::ready ? push_on(c) : let_up(c);
    const Stamp now = c.history.newest().stamp;
    if (rested && force_ > 0.0) {
        rising_since_ = now;
    }
    // Noise must not lift it.
    const double noise = c.signal.way_mm(from_ms(s.velocity_window_ms)) / s.press_slow_way_mm;
    const double up = std::min(s.press_up_force, 1.0 - noise);
    const double rearm = up - (s.press_up_force - s.press_rearm_force);
    switch (state()) {
        case State::ready: handle(c, force_ >= 1.0 ? Event::down : Event::weak, refusal_); return;
        case State::pressed:
            if (to_ms(now - pressed_at_) >= s.press_most_ms) {
                handle(c, Event::late,
                       {"down for long", to_ms(now - pressed_at_), s.press_most_ms});
                return;
            }
            handle(c, force_ < up ? Event::up : Event::strong);
            return;
        case State::carried: handle(c, force_ < up ? Event::up : Event::strong); return;
        case State::lifting: handle(c, force_ < rearm ? Event::risen : Event::weak); return;
    }
}

void PressMachine::drop(const Context& c, CancelReason reason, const char* why) {
    force_ = 0.0;
    if (state() != State::ready) {
        reason_ = reason;
        broke_ = closed() ? reason : CancelReason::none;
        handle(c, Event::dropped, {why, 0.0, 0.0});
    }
}

void PressMachine::finish(const Context& c) {
    if (closed()) {
        handle(c, Event::finished);
    }
}

void PressMachine::carry(const Context& c) {
    if (state() == State::pressed) {
        handle(c, Event::superseded);
    }
}

std::optional<PressState> PressMachine::next(const Context& c, Event event) {
    switch (state()) {
        case State::ready: return ready(c, event);
        case State::pressed: return pressed(c, event);
        case State::carried: return carried(event);
        case State::lifting: return lifting(event);
    }
    return std::nullopt;
}

std::optional<PressState> PressMachine::ready(const Context& c, Event event) {
    switch (event) {
        case Event::down:
            broke_ = CancelReason::none;
            deepest_mm_ = place_of(c);
            pressed_at_ = c.history.newest().stamp;
            gesture_id_ = c.next_gesture_id++;
            send(c, EventPhase::begin);
            return State::pressed;
        case Event::weak:
        case Event::dropped: return State::ready;
        case Event::strong:
        case Event::up:
        case Event::risen:
        case Event::late:
        case Event::superseded:
        case Event::finished: break;
    }
    return std::nullopt;
}

std::optional<PressState> PressMachine::pressed(const Context& c, Event event) {
    switch (event) {
        case Event::strong: send(c, EventPhase::update); return State::pressed;
        case Event::up:
        case Event::late:
        case Event::finished: send(c, EventPhase::end); return State::lifting;
        case Event::superseded:
            send(c, EventPhase::cancel, CancelReason::superseded);
            return State::carried;
        case Event::dropped: send(c, EventPhase::cancel, reason_); return State::ready;
        case Event::weak:
        case Event::down:
        case Event::risen: break;
    }
    return std::nullopt;
}

std::optional<PressState> PressMachine::carried(Event event) {
    switch (event) {
        case Event::strong: return State::carried;
        case Event::up:
        case Event::finished: return State::lifting;
        case Event::dropped: return State::ready;
        case Event::weak:
        case Event::down:
        case Event::risen:
        case Event::late:
        case Event::superseded: break;
    }
    return std::nullopt;
}

std::optional<PressState> PressMachine::lifting(Event event) {
    switch (event) {
        case Event::weak: return State::lifting;
        case Event::risen:
        case Event::dropped: return State::ready;
        case Event::down:
        case Event::strong:
        case Event::up:
        case Event::late:
        case Event::superseded:
        case Event::finished: break;
    }
    return std::nullopt;
}

void PressMachine::send(const Context& c, EventPhase phase, CancelReason reason) const {
    GestureEvent e = event_of(c, GestureType::press, phase);
    e.gesture_id = gesture_id_;
    e.cancel_reason = reason;
    e.onset = rising_since_;
    e.position_mm = c.history.newest().pointer_mm;
    e.progress = 1.0F;
    e.value = static_cast<float>(force_);
    e.confidence *= kConfidence;
    c.out.add(e);
}

}  // namespace xtrack::recognise
