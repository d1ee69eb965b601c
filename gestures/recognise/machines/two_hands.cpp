// SPDX-License-Identifier: Apache-2.0
//
//         held              moved (begin)
//  apart ──────▶ gripped ─────────────────▶ active ⟲ (update)
//    ▲             │                          │
//    │  released,  │                          │ released, finished (end)
//    │  dropped    │                          │ dropped (cancel)
//    ├─────────────┘                          │
//    └────────────────────────────────────────┘
#include "gestures/recognise/machines/two_hands.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace xtrack::recognise {

namespace {

constexpr double kHalfTurnDeg = 180.0;
// Hands that touch have no scale and no direction.
constexpr double kLeastApartMm = 20.0;

Vec3f between(const TwoGrips& grips) { return grips.other_palm_mm - grips.palm_mm; }

double apart_mm(const TwoGrips& grips) {
    return std::max(static_cast<double>(between(grips).norm()), kLeastApartMm);
}

/// How far the line between the hands has turned, clockwise as the user sees it.
double clockwise_deg(const TwoGrips& from, const TwoGrips& to) {
    const Vec3f a = between(from);
    const Vec3f b = between(to);
    const auto cross = static_cast<double>(a.x() * b.y() - a.y() * b.x());
    const auto dot = static_cast<double>(a.x() * b.x() + a.y() * b.y());
    return -std::atan2(cross, dot) * kHalfTurnDeg / std::numbers::pi;
}

}  // namespace

const char* TwoHandMachine::name(State s) {
    switch (s) {
        case State::apart: return "apart";
        case State::gripped: return "gripped";
        case State::active: return "active";
    }
    return "?";
}

const char* TwoHandMachine::name(Event e) {
    switch (e) {
        case Event::held: return "held";
        case Event::moved: return "moved";
        case Event::released: return "released";
        case Event::dropped: return "dropped";
        case Event::finished: return "finished";
    }
    return "?";
}

double TwoHandMachine::value_of(const TwoGrips& grips) const {
    return type_ == GestureType::two_hand_zoom ? apart_mm(grips) / apart_mm(first_) : turn_deg_;
}

double TwoHandMachine::way_of(const TwoGrips& grips) const {
    return type_ == GestureType::two_hand_zoom ? std::abs(apart_mm(grips) - apart_mm(first_))
                                               : std::abs(clockwise_deg(first_, grips));
}

bool TwoHandMachine::begins(const Context& c, const TwoGrips& grips) const {
    const double needed = type_ == GestureType::two_hand_zoom ? c.settings.two_hand_zoom_mm
                                                              : c.settings.two_hand_rotate_deg;
    return state() == State::gripped && grips.held && !grips.lost && way_of(grips) >= needed;
}

void TwoHandMachine::update(const Context& c, const TwoGrips& grips) {
    const bool goes = begins(c, grips);
    const bool same = grips.hand_id == now_.hand_id && grips.other_hand_id == now_.other_hand_id;
    if (state() != State::apart && (grips.lost || (grips.held && !same))) {
        drop(c, grips.lost ? grips.reason : CancelReason::superseded, "a hand is lost");
        return;
    }
    if (!grips.held) {
        if (state() != State::apart) {
            handle(c, Event::released);
        }
        return;
    }
    if (state() == State::active) {
        // Summed up, so that it goes on beyond half a turn.
        turn_deg_ += clockwise_deg(now_, grips);
    }
    now_ = grips;
    handle(c, goes ? Event::moved : Event::held);
}

void TwoHandMachine::drop(const Context& c, CancelReason reason, const char* why) {
    if (state() != State::apart) {
        reason_ = reason;
        handle(c, Event::dropped, {why, 0.0, 0.0});
    }
}

void TwoHandMachine::finish(const Context& c) {
    if (state() == State::active) {
        handle(c, Event::finished);
    }
}

std::optional<TwoHandState> TwoHandMachine::next(const Context& c, Event event) {
    switch (state()) {
        case State::apart: return apart(c, event);
        case State::gripped: return gripped(c, event);
        case State::active: return active(c, event);
    }
    return std::nullopt;
}

std::optional<TwoHandState> TwoHandMachine::apart(const Context& c, Event event) {
    switch (event) {
        case Event::held:
            first_ = now_;
            gripped_at_ = c.sensor;
            return State::gripped;
        case Event::moved:
        case Event::released:
        case Event::dropped:
        case Event::finished: break;
    }
    return std::nullopt;
}

std::optional<TwoHandState> TwoHandMachine::gripped(const Context& c, Event event) {
    switch (event) {
        case Event::held: return State::gripped;
        case Event::moved:
            turn_deg_ = clockwise_deg(first_, now_);
            gesture_id_ = c.next_gesture_id++;
            send(c, EventPhase::begin);
            return State::active;
        case Event::released:
        case Event::dropped: return State::apart;
        case Event::finished: break;
    }
    return std::nullopt;
}

std::optional<TwoHandState> TwoHandMachine::active(const Context& c, Event event) {
    switch (event) {
        case Event::held: send(c, EventPhase::update); return State::active;
        case Event::released:
        case Event::finished: send(c, EventPhase::end); return State::apart;
        case Event::dropped: send(c, EventPhase::cancel, reason_); return State::apart;
        case Event::moved: break;
    }
    return std::nullopt;
}

void TwoHandMachine::send(const Context& c, EventPhase phase, CancelReason reason) const {
    GestureEvent e = event_of(c, type_, phase);
    e.gesture_id = gesture_id_;
    e.cancel_reason = reason;
    e.hand_id = now_.hand_id;
    e.other_hand_id = now_.other_hand_id;
    e.hand = Chirality::unknown;
    e.hand_confidence = 0.0F;
    e.onset = gripped_at_;
    e.position_mm = 0.5F * (now_.palm_mm + now_.other_palm_mm);
    e.progress = 1.0F;
    e.value = static_cast<float>(value_of(now_));
    c.out.add(e);
}

}  // namespace xtrack::recognise
