// SPDX-License-Identifier: Apache-2.0
//
//         outside              inside (begin)
//  unseen ───────▶ outside ──────────────────▶ touching ⟲ (update)
//    ▲               │  ▲                        │  │
//    │  dropped      │  │  outside, finished     │  │
//    ├───────────────┘  └────────(end)───────────┘  │
//    └──────────────────────────────────────────────┘
//       dropped (cancel)
//
// The finger that is nearest to the screen touches; where no fingertip is known, the palm. It must
// have been seen outside before: a hand that comes into view inside the plane has touched nothing.
#include "gestures/recognise/machines/touch.hpp"

#include <algorithm>

namespace xtrack::recognise {

const char* TouchMachine::name(State s) {
    switch (s) {
        case State::unseen: return "unseen";
        case State::outside: return "outside";
        case State::touching: return "touching";
    }
    return "?";
}

const char* TouchMachine::name(Event e) {
    switch (e) {
        case Event::outside: return "outside";
        case Event::inside: return "inside";
        case Event::dropped: return "dropped";
        case Event::finished: return "finished";
    }
    return "?";
}

double TouchMachine::progress(const GestureSettings& s) const noexcept {
    return std::clamp((s.touch_progress_mm - distance_mm_) / (s.touch_progress_mm - s.touch_mm),
                      0.0, 1.0);
}

void TouchMachine::update(const Context& c) {
    const GestureSettings& s = c.settings;
    if (c.gate != Gate::open || c.taken) {
        drop(c, c.taken ? CancelReason::superseded : reason_of(c.gate),
             c.taken ? "another gesture has the hand" : why(c.gate));
        return;
    }
    finger_mm_ = c.hand.palm_mm;
    for (const TrackedPoint& tip : c.hand.fingertips) {
        if (tip.valid && tip.position_mm.allFinite() && tip.position_mm.z() < finger_mm_.z()) {
            finger_mm_ = tip.position_mm;
        }
    }
    const bool was_far = distance_mm_ > s.touch_progress_mm;
    distance_mm_ = static_cast<double>(finger_mm_.z()) - s.touch_plane_mm;
    if (was_far && distance_mm_ <= s.touch_progress_mm) {
        approached_ = c.sensor;
    }
    const double apart_mm = Signal::apart(s.touch_release_mm - s.touch_mm, c.signal.palm_noise_mm);
    const double limit_mm = state() == State::outside ? s.touch_mm : s.touch_mm + apart_mm;
    const bool inside = distance_mm_ < limit_mm;
    const Refusal refusal = inside && state() == State::unseen
                                ? Refusal{"it was not seen outside", distance_mm_, limit_mm}
                                : Refusal{};
    handle(c, inside ? Event::inside : Event::outside, refusal);
}

void TouchMachine::drop(const Context& c, CancelReason reason, const char* why) {
    distance_mm_ = 1e9;
    if (state() != State::unseen) {
        reason_ = reason;
        handle(c, Event::dropped, {why, 0.0, 0.0});
    }
}

void TouchMachine::finish(const Context& c) {
    if (state() == State::touching) {
        handle(c, Event::finished);
    }
}

std::optional<TouchState> TouchMachine::next(const Context& c, Event event) {
    switch (state()) {
        case State::unseen: return unseen(event);
        case State::outside: return outside(c, event);
        case State::touching: return touching(c, event);
    }
    return std::nullopt;
}

std::optional<TouchState> TouchMachine::unseen(Event event) {
    switch (event) {
        case Event::outside: return State::outside;
        case Event::inside:
        case Event::dropped: return State::unseen;
        case Event::finished: break;
    }
    return std::nullopt;
}

std::optional<TouchState> TouchMachine::outside(const Context& c, Event event) {
    switch (event) {
        case Event::outside: return State::outside;
        case Event::inside:
            gesture_id_ = c.next_gesture_id++;
            send(c, EventPhase::begin);
            return State::touching;
        case Event::dropped: return State::unseen;
        case Event::finished: break;
    }
    return std::nullopt;
}

std::optional<TouchState> TouchMachine::touching(const Context& c, Event event) {
    switch (event) {
        case Event::inside: send(c, EventPhase::update); return State::touching;
        case Event::outside:
        case Event::finished: send(c, EventPhase::end); return State::outside;
        case Event::dropped: send(c, EventPhase::cancel, reason_); return State::unseen;
    }
    return std::nullopt;
}

void TouchMachine::send(const Context& c, EventPhase phase, CancelReason reason) const {
    GestureEvent e = event_of(c, GestureType::touch, phase);
    e.gesture_id = gesture_id_;
    e.cancel_reason = reason;
    e.onset = approached_;
    e.position_mm = finger_mm_;
    e.progress = 1.0F;
    e.value = static_cast<float>(distance_mm_);
    c.out.add(e);
}

}  // namespace xtrack::recognise
