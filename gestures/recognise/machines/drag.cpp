// SPDX-License-Identifier: Apache-2.0
//
//         held              moved (begin)
//  empty ──────▶ gripped ─────────────────▶ dragging ⟲ (update)
//    ▲             │                           │
//    │  released,  │                           │ released, finished (end)
//    │  dropped    │                           │ dropped (cancel)
//    ├─────────────┘                           │
//    └─────────────────────────────────────────┘
#include "gestures/recognise/machines/drag.hpp"

namespace xtrack::recognise {

const char* DragMachine::name(State s) {
    switch (s) {
        case State::empty: return "empty";
        case State::gripped: return "gripped";
        case State::dragging: return "dragging";
    }
    return "?";
}

const char* DragMachine::name(Event e) {
    switch (e) {
        case Event::held: return "held";
        case Event::moved: return "moved";
        case Event::released: return "released";
        case Event::dropped: return "dropped";
        case Event::finished: return "finished";
    }
    return "?";
}

double DragMachine::moved_mm(const Context& c) const {
    return static_cast<double>((c.history.newest().pointer_mm - gripped_mm_).norm());
}

bool DragMachine::begins(const Context& c, const Grip& grip) const {
    const double needed_mm = grip.fist ? c.settings.drag_grab_mm : c.settings.drag_mm;
    return state() == State::gripped && grip.held && c.gate == Gate::open &&
           moved_mm(c) >= c.signal.still_mm(needed_mm);
}

void DragMachine::update(const Context& c, const Grip& grip) {
    if (c.gate != Gate::open) {
        drop(c, reason_of(c.gate), why(c.gate));
        return;
    }
    if (begins(c, grip)) {
        handle(c, Event::moved);
    } else if (grip.held) {
        handle(c, Event::held);
    } else if (grip.broke != CancelReason::none) {
        drop(c, grip.broke, "the grip was lost");
    } else if (state() != State::empty) {
        handle(c, Event::released);
    }
}

void DragMachine::drop(const Context& c, CancelReason reason, const char* why) {
    if (state() != State::empty) {
        reason_ = reason;
        handle(c, Event::dropped, {why, 0.0, 0.0});
    }
}

void DragMachine::finish(const Context& c) {
    if (state() == State::dragging) {
        handle(c, Event::finished);
    }
}

std::optional<DragState> DragMachine::next(const Context& c, Event event) {
    switch (state()) {
        case State::empty: return empty(c, event);
        case State::gripped: return gripped(c, event);
        case State::dragging: return dragging(c, event);
    }
    return std::nullopt;
}

std::optional<DragState> DragMachine::empty(const Context& c, Event event) {
    switch (event) {
        case Event::held:
            gripped_mm_ = c.history.newest().pointer_mm;
            gripped_at_ = c.sensor;
            return State::gripped;
        case Event::moved:
        case Event::released:
        case Event::dropped:
        case Event::finished: break;
    }
    return std::nullopt;
}

std::optional<DragState> DragMachine::gripped(const Context& c, Event event) {
    switch (event) {
        case Event::held: return State::gripped;
        case Event::moved:
            gesture_id_ = c.next_gesture_id++;
            send(c, EventPhase::begin);
            return State::dragging;
        case Event::released:
        case Event::dropped: return State::empty;
        case Event::finished: break;
    }
    return std::nullopt;
}

std::optional<DragState> DragMachine::dragging(const Context& c, Event event) {
    switch (event) {
        case Event::held: send(c, EventPhase::update); return State::dragging;
        case Event::released:
        case Event::finished: send(c, EventPhase::end); return State::empty;
        case Event::dropped: send(c, EventPhase::cancel, reason_); return State::empty;
        case Event::moved: break;
    }
    return std::nullopt;
}

void DragMachine::send(const Context& c, EventPhase phase, CancelReason reason) const {
    GestureEvent e = event_of(c, GestureType::drag, phase);
    e.gesture_id = gesture_id_;
    e.cancel_reason = reason;
    e.onset = gripped_at_;
    e.position_mm = c.history.newest().pointer_mm;
    e.progress = 1.0F;
    e.value = static_cast<float>(moved_mm(c));
    c.out.add(e);
}

}  // namespace xtrack::recognise
