// SPDX-License-Identifier: Apache-2.0
//
//           one
//   none ─────────▶ once
//    ▲                │ one (begin and end are sent)
//    │                │ late, dropped (silent)
//    └────────────────┘
#include "gestures/recognise/machines/double.hpp"

#include <utility>

namespace xtrack::recognise {

const char* DoubleMachine::name(State s) {
    switch (s) {
        case State::none: return "none";
        case State::once: return "once";
    }
    return "?";
}

const char* DoubleMachine::name(Event e) {
    switch (e) {
        case Event::one: return "one";
        case Event::late: return "late";
        case Event::dropped: return "dropped";
    }
    return "?";
}

void DoubleMachine::update(const Context& c) {
    const double since_ms = to_ms(c.sensor - first_at_);
    if (state() == State::once && since_ms > c.settings.double_within_ms) {
        handle(c, Event::late, {"the second does not come", since_ms, c.settings.double_within_ms});
    }
    if (std::exchange(known_, heard_) != heard_) {
        handle(c, Event::one);
    }
}

void DoubleMachine::drop(const Context& c, CancelReason /*reason*/, const char* why) {
    if (state() != State::none) {
        handle(c, Event::dropped, {why, 0.0, 0.0});
    }
}

std::optional<DoubleMachine::State> DoubleMachine::next(const Context& c, Event event) {
    switch (state()) {
        case State::none: return none(c, event);
        case State::once: return once(c, event);
    }
    return std::nullopt;
}

std::optional<DoubleMachine::State> DoubleMachine::none(const Context& c, Event event) {
    switch (event) {
        case Event::one: first_at_ = c.sensor; return State::once;
        case Event::dropped: return State::none;
        case Event::late: break;
    }
    return std::nullopt;
}

std::optional<DoubleMachine::State> DoubleMachine::once(const Context& c, Event event) {
    switch (event) {
        case Event::one: commit(c); return State::none;
        case Event::late:
        case Event::dropped: return State::none;
    }
    return std::nullopt;
}

void DoubleMachine::commit(const Context& c) {
    GestureEvent e = event_of(c, type_, EventPhase::begin);
    e.gesture_id = c.next_gesture_id++;
    e.onset = first_at_;
    e.progress = 1.0F;
    c.out.add(e);
    e.phase = EventPhase::end;
    c.out.add(e);
}

}  // namespace xtrack::recognise
