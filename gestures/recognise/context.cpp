// SPDX-License-Identifier: Apache-2.0
#include "gestures/recognise/context.hpp"

namespace xtrack::recognise {

const char* why(Gate gate) noexcept {
    switch (gate) {
        case Gate::open: return "";
        case Gate::entering: return "the hand enters";
        case Gate::border: return "the hand touches the border";
        case Gate::fist: return "a fist says nothing";
        case Gate::bystander: return "not the hand of the session";
        case Gate::paused: return "paused";
    }
    return "";
}

CancelReason reason_of(Gate gate) noexcept {
    return gate == Gate::border ? CancelReason::edge : CancelReason::disengaged;
}

GestureEvent event_of(const Context& c, GestureType type, EventPhase phase) noexcept {
    GestureEvent e;
    e.type = type;
    e.phase = phase;
    e.hand_id = c.hand.id;
    e.hand = c.hand.chirality;
    e.hand_confidence = c.hand.chirality_confidence;
    e.onset = c.sensor;
    e.sensor = c.sensor;
    e.emit = c.emit;
    e.position_mm = c.hand.palm_mm;
    e.velocity_mmps = c.history.velocity(from_ms(c.settings.velocity_window_ms));
    e.confidence = c.hand.confidence;
    return e;
}

}  // namespace xtrack::recognise
