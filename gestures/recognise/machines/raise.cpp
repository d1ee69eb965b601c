// SPDX-License-Identifier: Apache-2.0
//
//             raised (begin and end are sent), rests
//   moving ───────────────────────────────────────────▶ resting
//     ▲                                                    │ moves, dropped
//     └────────────────────────────────────────────────────┘
//
// A raise is known by its end: when the hand has become still, what it did before is looked at
// once.
#include "gestures/recognise/machines/raise.hpp"

#include <algorithm>
#include <cmath>

#include "gestures/recognise/machines/carriage.hpp"

namespace xtrack::recognise {

namespace {

constexpr float kConfidence = 0.9F;
// Of the rise: what it may go aside, or toward the screen.
constexpr double kAsideShare = 0.5;
// A rise begins where the hand turns or rests; faster upward there, it goes on with another motion.
constexpr double kBeginsMmps = 130.0;

}  // namespace

const char* RaiseMachine::name(State s) {
    switch (s) {
        case State::moving: return "moving";
        case State::resting: return "resting";
    }
    return "?";
}

const char* RaiseMachine::name(Event e) {
    switch (e) {
        case Event::moves: return "moves";
        case Event::raised: return "raised";
        case Event::rests: return "rests";
        case Event::dropped: return "dropped";
    }
    return "?";
}

void RaiseMachine::update(const Context& c) {
    const Stamp now = c.history.newest().stamp;
    const Vec3f velocity = c.history.velocity(from_ms(c.settings.velocity_window_ms));
    const bool still = static_cast<double>(velocity.norm()) < c.settings.raise_still_mmps;
    if (still && !still_) {
        still_since_ = now;
    }
    still_ = still;
    if (c.gate != Gate::open || c.taken) {
        drop(c, CancelReason::none, c.taken ? "another gesture has the hand" : why(c.gate));
        return;
    }
    if (!still_) {
        handle(c, Event::moves);
        return;
    }
    if (state() == State::resting || to_ms(now - still_since_) < c.settings.raise_still_ms) {
        return;
    }
    rise_ = measure(c);
    handle(c, *rise_.refusal.why == '\0' ? Event::raised : Event::rests, rise_.refusal);
}

void RaiseMachine::drop(const Context& c, CancelReason /*reason*/, const char* why) {
    not_before_ = c.sensor;
    if (state() != State::moving) {
        handle(c, Event::dropped, {why, 0.0, 0.0});
    }
}

std::optional<RaiseMachine::State> RaiseMachine::next(const Context& c, Event event) {
    switch (state()) {
        case State::moving: return moving(c, event);
        case State::resting: return resting(c, event);
    }
    return std::nullopt;
}

std::optional<RaiseMachine::State> RaiseMachine::moving(const Context& c, Event event) {
    switch (event) {
        case Event::moves:
        case Event::dropped: return State::moving;
        case Event::raised: commit(c); return State::resting;
        case Event::rests: return State::resting;
    }
    return std::nullopt;
}

std::optional<RaiseMachine::State> RaiseMachine::resting(const Context& /*c*/, Event event) {
    switch (event) {
        case Event::moves:
        case Event::dropped: return State::moving;
        case Event::raised:
        case Event::rests: break;
    }
    return std::nullopt;
}

RaiseMachine::Rise RaiseMachine::measure(const Context& c) const {
    const GestureSettings& s = c.settings;
    const MotionHistory& history = c.history;
    const MotionSample& now = history.newest();
    std::size_t low = 0;
    for (std::size_t i = 1; i < history.size(); ++i) {
        const MotionSample& past = history.at(i);
        if (past.stamp < not_before_ || to_ms(still_since_ - past.stamp) > s.raise_within_ms) {
            break;
        }
        if (past.palm_mm.y() < history.at(low).palm_mm.y()) {
            low = i;
        }
    }
    const MotionSample& from = history.at(low);
    const Vec3f moved = now.palm_mm - from.palm_mm;
    Rise rise;
    rise.start = from.stamp;
    rise.mm = static_cast<double>(moved.y());
    if (rise.mm < s.raise_mm) {
        rise.refusal = {"rises little", rise.mm, s.raise_mm};
        return rise;
    }
    const double aside_mm =
        std::hypot(static_cast<double>(moved.x()), static_cast<double>(moved.z()));
    if (aside_mm > kAsideShare * rise.mm) {
        rise.refusal = {"goes aside", aside_mm, kAsideShare * rise.mm};
        return rise;
    }
    const auto begins_mmps =
        static_cast<double>(history.velocity(from_ms(s.velocity_window_ms), low).y());
    if (begins_mmps > kBeginsMmps) {
        rise.refusal = {"goes on with the motion before", begins_mmps, kBeginsMmps};
        return rise;
    }
    // Whatever hands do next to a face or on the way to it, they do not show themselves.
    const Carriage held =
        carriage(history, std::max<std::size_t>(history.count_within(from_ms(s.raise_still_ms)), 1),
                 Vec3f::UnitY());
    if (held.extension.all >= 0.0 && !held.is_upright()) {
        rise.refusal = {"it is not held up flat", 0.0, 0.0};
    }
    return rise;
}

void RaiseMachine::commit(const Context& c) {
    not_before_ = c.sensor;  // a hand that stirs up there does not raise again
    GestureEvent e = event_of(c, GestureType::raise, EventPhase::begin);
    e.gesture_id = c.next_gesture_id++;
    e.onset = rise_.start;
    e.progress = 1.0F;
    e.value = static_cast<float>(rise_.mm);
    e.confidence *= kConfidence;
    c.out.add(e);
    e.phase = EventPhase::end;
    c.out.add(e);
}

}  // namespace xtrack::recognise
