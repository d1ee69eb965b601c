// SPDX-License-Identifier: Apache-2.0
//
//         closed              held
//   open ────────▶ closing ──────────▶ silent
//    ▲               │                   │
//    │ open, busy    │                   │ open
//    ├───────────────┘                   │
//    └───────────────────────────────────┘
#include "gestures/recognise/silence.hpp"

namespace xtrack::recognise {

const char* Silence::name(State s) {
    switch (s) {
        case State::open: return "open";
        case State::closing: return "closing";
        case State::silent: return "silent";
    }
    return "?";
}

const char* Silence::name(Event e) {
    switch (e) {
        case Event::open: return "open";
        case Event::closed: return "closed";
        case Event::held: return "held";
        case Event::busy: return "busy";
    }
    return "?";
}

void Silence::update(const Context& c, bool active) {
    const GestureSettings& s = c.settings;
    // A thumb is shown on a fist.
    const bool means_something =
        s.grab || s.fist || s.two_hand_zoom || s.two_hand_rotate || s.thumb_up || s.thumb_down;
    const auto grab = static_cast<double>(c.hand.grab_value);
    // Open again at less than what closes, so that a half-closed hand does not flicker.
    const double limit = state() == State::open ? s.silence_fist : s.silence_open;
    if (means_something || !(grab >= limit)) {  // true for NaN
        handle(c, Event::open);
    } else if (active && state() != State::silent) {
        handle(c, Event::busy);
    } else {
        const bool held = state() == State::closing && to_ms(c.sensor - closed_at_) >= s.silence_ms;
        handle(c, held ? Event::held : Event::closed);
    }
}

std::optional<SilenceState> Silence::next(const Context& c, Event event) {
    switch (state()) {
        case State::open: return open(c, event);
        case State::closing: return closing(event);
        case State::silent: return silent(event);
    }
    return std::nullopt;
}

std::optional<SilenceState> Silence::open(const Context& c, Event event) {
    switch (event) {
        case Event::closed: closed_at_ = c.sensor; return State::closing;
        case Event::open:
        case Event::busy: return State::open;
        case Event::held: break;
    }
    return std::nullopt;
}

std::optional<SilenceState> Silence::closing(Event event) {
    switch (event) {
        case Event::closed: return State::closing;
        case Event::held: return State::silent;
        case Event::open:
        case Event::busy: return State::open;
    }
    return std::nullopt;
}

std::optional<SilenceState> Silence::silent(Event event) {
    switch (event) {
        case Event::closed: return State::silent;
        case Event::open: return State::open;
        case Event::held:
        case Event::busy: break;
    }
    return std::nullopt;
}

}  // namespace xtrack::recognise
