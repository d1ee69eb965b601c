// SPDX-License-Identifier: Apache-2.0
//
//         opened          closed             held (begin)
//   away ───────▶ armed ─────────▶ closing ──────────────▶ grabbed ⟲ (update)
//    ▲   ◀───────  ▲  ◀──────────    │                        │
//    │    stale    │    released     │ spoilt                 │ released, finished (end)
//    │             │ opened          ▼                        │ dropped (cancel)
//    │             └───────────── spoilt                      │ superseded (cancel): carried,
//    └────────────────────────────────────────────────────────┘   until it opens
//
// Armed means that the hand was seen open a moment ago: a hand that comes as a fist, or rests half
// closed, does not grab. Spoilt is a closing that was something else.
#include "gestures/recognise/machines/grab.hpp"

#include <algorithm>

#include "gestures/recognise/machines/carriage.hpp"

namespace xtrack::recognise {

namespace {

// Strength that is not known for so long is a hand whose fingers are lost; as for pinches.
constexpr Duration kStrengthLost = std::chrono::milliseconds{300};
// Flexion (track/hand_from_joints.hpp) of a pointing hand: the index at most, the others at least
// on average. Fingers that grab close together, within 60 degrees.
constexpr float kPointingDeg = 60.0F;
constexpr float kFoldedDeg = 150.0F;
// Extensions of a camera's hand that points, on average over so long.
constexpr double kOut = 0.7;
constexpr double kFolded = 0.2;
constexpr Duration kPointsFor = std::chrono::milliseconds{200};
// Of a hand whose thumb and index tip meet: a pinch bends the index less than the fingers beside it
// (measured: 15..60 degrees), fingers that grab something small bend alike (5).
constexpr float kPinchLessDeg = 10.0F;

float flexion(const MotionSample& hand, Finger finger) {
    return hand.flexion[static_cast<std::size_t>(finger)].whole_deg;
}

/// A camera's hand, over a while: a fist that closes folds its index, too.
bool seems_to_point(const MotionHistory& history) {
    const Extensions mean = extensions_in(history, 0, history.count_within(kPointsFor));
    return mean.index >= kOut && mean.outer >= 0.0 && mean.outer <= kFolded;
}

/// False where not all four fingers are known.
bool points(const MotionSample& hand) {
    const float index = flexion(hand, Finger::index);
    const float others[] = {flexion(hand, Finger::middle), flexion(hand, Finger::ring),
                            flexion(hand, Finger::little)};
    return index > kFlexionUnknown && index <= kPointingDeg &&
           *std::ranges::min_element(others) > kFlexionUnknown &&
           others[0] + others[1] + others[2] >= 3.0F * kFoldedDeg;
}

}  // namespace

const char* GrabMachine::name(State s) {
    switch (s) {
        case State::away: return "away";
        case State::armed: return "armed";
        case State::closing: return "closing";
        case State::grabbed: return "grabbed";
        case State::carried: return "carried";
        case State::spoilt: return "spoilt";
    }
    return "?";
}

const char* GrabMachine::name(Event e) {
    switch (e) {
        case Event::opened: return "opened";
        case Event::between: return "between";
        case Event::stale: return "stale";
        case Event::closed: return "closed";
        case Event::held: return "held";
        case Event::spoilt: return "spoilt";
        case Event::released: return "released";
        case Event::superseded: return "superseded";
        case Event::dropped: return "dropped";
        case Event::finished: return "finished";
    }
    return "?";
}

void GrabMachine::update(const Context& c) {
    if (c.gate != Gate::open && c.gate != Gate::entering) {
        drop(c, reason_of(c.gate), why(c.gate));
        return;
    }
    if (c.taken && state() != State::carried) {
        drop(c, CancelReason::superseded, "another gesture has the hand");
        return;
    }
    const Stamp now = c.history.newest().stamp;
    const double strength = c.history.recent(&MotionSample::grab);
    if (strength < 0.0) {
        if (now - known_at_ >= kStrengthLost) {
            drop(c, CancelReason::lost, "the fingers are lost");
        }
        return;  // frozen, like a hand that is not seen
    }
    known_at_ = now;
    strength_ = strength;
    Refusal refusal;
    const Event event = judge(c, strength, refusal);
    handle(c, event, refusal);
    if (event == Event::closed && state() == State::closing) {
        refusal = {};
        handle(c, judge(c, strength, refusal), refusal);  // grab_hold_ms may be 0
    }
}

void GrabMachine::drop(const Context& c, CancelReason reason, const char* why) {
    if (state() != State::away) {
        reason_ = reason;
        broke_ = closed() ? reason : CancelReason::none;
        handle(c, Event::dropped, {why, 0.0, 0.0});
    }
}

void GrabMachine::carry(const Context& c) {
    if (state() == State::grabbed) {
        reason_ = CancelReason::superseded;
        handle(c, Event::superseded);
    }
}

void GrabMachine::finish(const Context& c) {
    if (closed()) {
        handle(c, Event::finished);
    }
}

std::optional<GrabMachine::State> GrabMachine::next(const Context& c, Event event) {
    switch (state()) {
        case State::away: return away(c, event);
        case State::armed: return armed(c, event);
        case State::closing: return closing(c, event);
        case State::grabbed: return grabbed(c, event);
        case State::carried: return carried(event);
        case State::spoilt: return spoilt(c, event);
    }
    return std::nullopt;
}

std::optional<GrabMachine::State> GrabMachine::away(const Context& c, Event event) {
    switch (event) {
        case Event::opened: open_at_ = c.sensor; return State::armed;
        case Event::between:
        case Event::closed:
        case Event::dropped: return State::away;
        case Event::stale:
        case Event::held:
        case Event::spoilt:
        case Event::released:
        case Event::superseded:
        case Event::finished: break;
    }
    return std::nullopt;
}

std::optional<GrabMachine::State> GrabMachine::armed(const Context& c, Event event) {
    switch (event) {
        case Event::opened: open_at_ = c.sensor; return State::armed;
        case Event::between: return State::armed;
        case Event::stale:
        case Event::dropped: return State::away;
        case Event::closed: closed_at_ = c.sensor; return State::closing;
        case Event::held:
        case Event::spoilt:
        case Event::released:
        case Event::superseded:
        case Event::finished: break;
    }
    return std::nullopt;
}

std::optional<GrabMachine::State> GrabMachine::closing(const Context& c, Event event) {
    switch (event) {
        case Event::closed: return State::closing;
        case Event::held:
            broke_ = CancelReason::none;
            onset_ = open_at_;
            gesture_id_ = c.next_gesture_id++;
            send(c, EventPhase::begin);
            return State::grabbed;
        case Event::spoilt: return State::spoilt;
        case Event::released: return State::armed;
        case Event::dropped: return State::away;
        case Event::opened:
        case Event::between:
        case Event::stale:
        case Event::superseded:
        case Event::finished: break;
    }
    return std::nullopt;
}

std::optional<GrabMachine::State> GrabMachine::grabbed(const Context& c, Event event) {
    switch (event) {
        case Event::closed: send(c, EventPhase::update); return State::grabbed;
        case Event::released:
        case Event::finished: send(c, EventPhase::end); return State::away;
        case Event::superseded: send(c, EventPhase::cancel); return State::carried;
        case Event::dropped: send(c, EventPhase::cancel); return State::away;
        case Event::opened:
        case Event::between:
        case Event::stale:
        case Event::held:
        case Event::spoilt: break;
    }
    return std::nullopt;
}

std::optional<GrabMachine::State> GrabMachine::carried(Event event) {
    switch (event) {
        case Event::closed: return State::carried;
        case Event::released:
        case Event::finished:
        case Event::dropped: return State::away;
        case Event::opened:
        case Event::between:
        case Event::stale:
        case Event::held:
        case Event::superseded:
        case Event::spoilt: break;
    }
    return std::nullopt;
}

std::optional<GrabMachine::State> GrabMachine::spoilt(const Context& c, Event event) {
    switch (event) {
        case Event::opened: open_at_ = c.sensor; return State::armed;
        case Event::between:
        case Event::closed: return State::spoilt;
        case Event::dropped: return State::away;
        case Event::stale:
        case Event::held:
        case Event::spoilt:
        case Event::released:
        case Event::superseded:
        case Event::finished: break;
    }
    return std::nullopt;
}

GrabMachine::Event GrabMachine::judge(const Context& c, double strength, Refusal& refusal) const {
    const GestureSettings& s = c.settings;
    if (state() == State::closing || closed()) {
        if (strength <= s.grab_release) {
            return Event::released;
        }
        const double held_ms = to_ms(c.sensor - closed_at_ + c.history.unseen());
        if (closed() || held_ms < s.grab_hold_ms || strength < s.grab_strength) {
            return Event::closed;
        }
        if (c.gate == Gate::entering) {
            refusal = {why(c.gate), 0.0, 0.0};
            return Event::closed;
        }
        const Duration window = from_ms(s.velocity_window_ms);
        const auto palm_mmps = static_cast<double>(c.history.velocity(window).norm());
        const double smear_mm = c.history.smear_mm(window);
        if (palm_mmps > s.grab_palm_mmps) {
            refusal = {"the palm moves", palm_mmps, s.grab_palm_mmps};
        } else if (smear_mm > s.pinch_blur_mm) {
            refusal = {"the palm moves too fast to see fingers", smear_mm, s.pinch_blur_mm};
        }
        if (*refusal.why != '\0') {
            return held_ms > s.grab_settle_ms ? Event::spoilt : Event::closed;
        }
        refusal = spoiler(c);
        return *refusal.why == '\0' ? Event::held : Event::spoilt;
    }
    if (strength <= s.grab_open) {
        return Event::opened;
    }
    if (state() == State::armed && to_ms(c.sensor - open_at_) > s.grab_approach_ms) {
        refusal = {"no approach", to_ms(c.sensor - open_at_), s.grab_approach_ms};
        return Event::stale;
    }
    const MotionSample& now = c.history.newest();
    if (state() == State::armed && (now.from_joints ? points(now) : seems_to_point(c.history))) {
        refusal = {"the hand points", strength, s.grab_open};
        return Event::stale;
    }
    return strength >= s.grab_strength ? Event::closed : Event::between;
}

/// A closed hand may be a thumb that is shown, or a pinch of which the other fingers fold along.
Refusal GrabMachine::spoiler(const Context& c) const {
    const GestureSettings& s = c.settings;
    const MotionSample& now = c.history.newest();
    const std::size_t closed = c.history.count_within(c.sensor - closed_at_) - 1;
    const double smear_mm = c.history.smear_mm(from_ms(s.velocity_window_ms), closed);
    if (smear_mm > s.pinch_blur_mm) {
        return {"the palm moved too fast to see fingers", smear_mm, s.pinch_blur_mm};
    }
    const double thumb_mm = static_cast<double>(now.thumb_to_fingers_mm);
    const double reach_mm = s.grab_thumb_share * static_cast<double>(now.hand_length_mm);
    if (thumb_mm >= 0.0 && reach_mm > 0.0 && thumb_mm > reach_mm) {
        return {"the thumb stands off", thumb_mm, reach_mm};
    }
    const double aperture_mm = c.history.recent(&MotionSample::aperture_mm);
    const double meets_mm =
        std::max(s.pinch_close_mm, s.pinch_close_share * static_cast<double>(now.hand_length_mm));
    const float index = flexion(now, Finger::index);
    const float beside = 0.5F * (flexion(now, Finger::middle) + flexion(now, Finger::ring));
    if (index > kFlexionUnknown && aperture_mm >= 0.0 && aperture_mm < meets_mm &&
        beside - index > kPinchLessDeg) {
        return {"thumb and index tip meet", aperture_mm, meets_mm};
    }
    return {};
}

void GrabMachine::send(const Context& c, EventPhase phase) {
    GestureEvent e = event_of(c, GestureType::grab, phase);
    e.gesture_id = gesture_id_;
    e.cancel_reason = phase == EventPhase::cancel ? reason_ : CancelReason::none;
    e.onset = onset_;
    e.value = std::clamp(static_cast<float>(strength_), 0.0F, 1.0F);
    e.progress = 1.0F;
    c.out.add(e);
}

}  // namespace xtrack::recognise
