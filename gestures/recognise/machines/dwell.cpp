// SPDX-License-Identifier: Apache-2.0
//
//            still (begin)            filled (end)
//  moving ──────────────▶ filling ⟲ ─────────────▶ spent
//    ▲                      │ (update)                │ left, dropped
//    │  left, dropped       │                         │
//    │  (cancel)            │                         │
//    ├──────────────────────┘                         │
//    └────────────────────────────────────────────────┘
//
// Only where the hand points counts: its way to and from the screen does not. A place that was
// dwelt on is spent until the hand has left it.
#include "gestures/recognise/machines/dwell.hpp"

#include <algorithm>

namespace xtrack::recognise {

namespace {

// The line of samples covers so much of the time that is asked for; the rest is one frame's length.
constexpr double kCoverShare = 0.85;

double apart_mm(const Vec3f& a, const Vec3f& b) {
    return static_cast<double>((a - b).head<2>().norm());
}

}  // namespace

const char* DwellMachine::name(State s) {
    switch (s) {
        case State::moving: return "moving";
        case State::filling: return "filling";
        case State::spent: return "spent";
    }
    return "?";
}

const char* DwellMachine::name(Event e) {
    switch (e) {
        case Event::still: return "still";
        case Event::moving: return "moving";
        case Event::filled: return "filled";
        case Event::left: return "left";
        case Event::dropped: return "dropped";
    }
    return "?";
}

/// All pointer positions of dwell_still_ms lie round the newest one.
bool DwellMachine::is_still(const Context& c, Refusal& refusal) const {
    const Stamp now = c.history.newest().stamp;
    const Vec3f& here = c.history.newest().pointer_mm;
    const std::size_t samples = c.history.count_within(from_ms(c.settings.dwell_still_ms));
    const Stamp first = c.history.at(samples - 1).stamp;
    const double lasted_ms = to_ms(now - first);
    if (first < not_before_ || lasted_ms < kCoverShare * c.settings.dwell_still_ms) {
        refusal = {"seen too short", lasted_ms, c.settings.dwell_still_ms};
        return false;
    }
    const double radius_mm = c.signal.still_mm(c.settings.dwell_radius_mm);
    for (std::size_t i = 0; i < samples; ++i) {
        const double off_mm = apart_mm(c.history.at(i).pointer_mm, here);
        if (off_mm > radius_mm) {
            refusal = {"it moves", off_mm, radius_mm};
            return false;
        }
    }
    return true;
}

void DwellMachine::update(const Context& c) {
    const Stamp now = c.history.newest().stamp;
    if (c.gate != Gate::open || c.taken) {
        drop(c, c.taken ? CancelReason::superseded : reason_of(c.gate),
             c.taken ? "another gesture has the hand" : why(c.gate));
        not_before_ = now;
        return;
    }
    const double off_mm = apart_mm(c.history.newest().pointer_mm, anchor_mm_);
    Refusal refusal;
    switch (state()) {
        case State::moving:
            handle(c, is_still(c, refusal) ? Event::still : Event::moving, refusal);
            return;
        case State::filling:
            if (off_mm > c.settings.dwell_cancel_mm) {
                reason_ = CancelReason::superseded;
                handle(c, Event::left, {"it left", off_mm, c.settings.dwell_cancel_mm});
            } else {
                const bool filled = to_ms(now - begun_) >= c.settings.dwell_fill_ms;
                handle(c, filled ? Event::filled : Event::still);
            }
            return;
        case State::spent:
            handle(c, off_mm >= c.settings.dwell_rearm_mm ? Event::left : Event::still);
            return;
    }
}

void DwellMachine::drop(const Context& c, CancelReason reason, const char* why) {
    if (state() != State::moving) {
        reason_ = reason;
        handle(c, Event::dropped, {why, 0.0, 0.0});
    }
}

void DwellMachine::finish(const Context& c) {
    if (state() == State::filling) {
        handle(c, Event::filled);
    }
}

std::optional<DwellState> DwellMachine::next(const Context& c, Event event) {
    switch (state()) {
        case State::moving: return moving(c, event);
        case State::filling: return filling(c, event);
        case State::spent: return spent(event);
    }
    return std::nullopt;
}

std::optional<DwellState> DwellMachine::moving(const Context& c, Event event) {
    switch (event) {
        case Event::still:
            anchor_mm_ = c.history.newest().pointer_mm;
            begun_ = c.history.newest().stamp;
            onset_ = begun_ - from_ms(c.settings.dwell_still_ms);
            gesture_id_ = c.next_gesture_id++;
            send(c, EventPhase::begin);
            return State::filling;
        case Event::moving:
        case Event::dropped: return State::moving;
        case Event::filled:
        case Event::left: break;
    }
    return std::nullopt;
}

std::optional<DwellState> DwellMachine::filling(const Context& c, Event event) {
    switch (event) {
        case Event::still: send(c, EventPhase::update); return State::filling;
        case Event::filled: send(c, EventPhase::end); return State::spent;
        case Event::left:
        case Event::dropped: send(c, EventPhase::cancel, reason_); return State::moving;
        case Event::moving: break;
    }
    return std::nullopt;
}

std::optional<DwellState> DwellMachine::spent(Event event) {
    switch (event) {
        case Event::still: return State::spent;
        case Event::left:
        case Event::dropped: return State::moving;
        case Event::moving:
        case Event::filled: break;
    }
    return std::nullopt;
}

void DwellMachine::send(const Context& c, EventPhase phase, CancelReason reason) const {
    GestureEvent e = event_of(c, GestureType::dwell, phase);
    e.gesture_id = gesture_id_;
    e.cancel_reason = reason;
    e.onset = onset_;
    e.position_mm = anchor_mm_;
    e.progress = static_cast<float>(
        std::clamp(to_ms(c.sensor - begun_) / c.settings.dwell_fill_ms, 0.0, 1.0));
    if (phase == EventPhase::end) {
        e.progress = 1.0F;
    }
    e.value = e.progress;
    c.out.add(e);
}

}  // namespace xtrack::recognise
