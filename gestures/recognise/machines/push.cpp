// SPDX-License-Identifier: Apache-2.0
//
//            thrust (begin and end are sent)
//  waiting ─────────────────────────────────▶ recovering ⟲ thrust: the one before was its wind-up
//     ▲                                           │ stable, dropped
//     └───────────────────────────────────────────┘
//
// A thrust, toward the screen or away from it, is judged over a whole window, so there is no
// candidate state: before the window is full of it, nothing is known. Recovering is the way back,
// until the hand has been still.
#include "gestures/recognise/machines/push.hpp"

#include <algorithm>
#include <cmath>

#include "gestures/recognise/machines/angles.hpp"

namespace xtrack::recognise {

namespace {

constexpr float kConfidenceFloor = 0.5F;
// The window holds whole frames only; this much of it must be covered.
constexpr double kCoverShare = 0.75;
constexpr Duration kThrustBefore = std::chrono::milliseconds{300};
// A thrust that is this much faster than the one it undoes is the gesture, that one its wind-up.
constexpr double kWindUpShare = 1.2;

Vec3f axis_of(GestureType type) {
    return {0.0F, 0.0F, type == GestureType::push ? -1.0F : 1.0F};  // z is from the screen
}

}  // namespace

const char* PushMachine::name(State s) {
    switch (s) {
        case State::waiting: return "waiting";
        case State::recovering: return "recovering";
    }
    return "?";
}

const char* PushMachine::name(Event e) {
    switch (e) {
        case Event::thrust: return "thrust";
        case Event::moving: return "moving";
        case Event::stable: return "stable";
        case Event::dropped: return "dropped";
    }
    return "?";
}

void PushMachine::update(const Context& c) {
    const Stamp now = c.history.newest().stamp;
    const Vec3f velocity = c.history.velocity(from_ms(c.settings.velocity_window_ms));
    const bool slow =
        static_cast<double>(velocity.norm()) <
        c.signal.still_mmps(c.settings.push_stable_mmps, from_ms(c.settings.velocity_window_ms));
    if (slow && !slow_) {
        stable_since_ = now;
    }
    slow_ = slow;
    if (c.gate != Gate::open || c.taken) {
        not_before_ = now;
        if (state_ == State::waiting) {
            return;
        }
    }
    if (state_ == State::recovering && slow_ &&
        to_ms(now - stable_since_) >= c.settings.push_stable_ms) {
        handle(c, Event::stable);
        return;
    }
    thrust_ = measure(c);
    if (*thrust_.refusal.why == '\0' && brings_back(c, thrust_)) {
        thrust_.refusal = {"the way back", thrust_.speed_mmps, kWindUpShare * last_.speed_mmps};
    }
    handle(c, *thrust_.refusal.why == '\0' ? Event::thrust : Event::moving, thrust_.refusal);
    if (state_ == State::recovering && thrust_.type == last_.type) {
        last_.speed_mmps = std::max(last_.speed_mmps, thrust_.speed_mmps);
        if (thrust_.speed_mmps >= c.settings.push_stable_mmps) {
            last_at_ = now;
        }
    }
}

void PushMachine::drop(const Context& c, CancelReason /*reason*/, const char* why) {
    not_before_ = c.sensor;
    if (state_ != State::waiting) {
        handle(c, Event::dropped, {why, 0.0, 0.0});
    }
}

void PushMachine::handle(const Context& c, Event event, const Refusal& refusal) {
    reporter_.report(c, step(state_, event, next(c, event)), refusal,
                     [](auto of) { return name(of); });
}

std::optional<PushMachine::State> PushMachine::next(const Context& c, Event event) {
    switch (state_) {
        case State::waiting: return waiting(c, event);
        case State::recovering: return recovering(c, event);
    }
    return std::nullopt;
}

std::optional<PushMachine::State> PushMachine::waiting(const Context& c, Event event) {
    switch (event) {
        case Event::thrust: commit(c); return State::recovering;
        case Event::moving:
        case Event::dropped: return State::waiting;
        case Event::stable: break;
    }
    return std::nullopt;
}

std::optional<PushMachine::State> PushMachine::recovering(const Context& c, Event event) {
    switch (event) {
        case Event::thrust: commit(c); return State::recovering;
        case Event::moving: return State::recovering;
        case Event::stable:
        case Event::dropped: return State::waiting;
    }
    return std::nullopt;
}

/// A thrust against the one before is its way back, unless that one was a wind-up. While the hand
/// has not been still since, one the same way is the same thrust.
bool PushMachine::brings_back(const Context& c, const Thrust& thrust) const {
    const bool recovers = state_ == State::recovering;
    const bool fresh =
        recovers || to_ms(thrust.start - last_at_) < c.settings.push_return_memory_ms;
    if (thrust.type == last_.type) {
        return recovers;
    }
    return fresh && thrust.speed_mmps < kWindUpShare * last_.speed_mmps;
}

PushMachine::Thrust PushMachine::measure(const Context& c) const {
    const GestureSettings& s = c.settings;
    const MotionSample& now = c.history.newest();
    std::size_t first = c.history.count_within(from_ms(s.push_window_ms));
    first -= first > 0 ? 1 : 0;
    const MotionSample& then = c.history.at(first);
    const double lasted_ms = to_ms(now.stamp - then.stamp);
    Thrust t;
    t.start = then.stamp;
    if (then.stamp < not_before_ || lasted_ms < kCoverShare * s.push_window_ms) {
        t.refusal = {"seen too short", lasted_ms, s.push_window_ms};
        return t;
    }
    const Vec3f moved = now.palm_mm - then.palm_mm;
    t.type = moved.z() < 0.0F ? GestureType::push : GestureType::pull;
    const Vec3f axis = axis_of(t.type);
    t.speed_mmps = static_cast<double>(moved.dot(axis)) / (lasted_ms * 1e-3);
    if (!is_wanted(s, t.type)) {
        t.refusal = {"switched off", 0.0, 0.0};
        return t;
    }
    if (t.speed_mmps < s.push_speed_mmps) {
        t.refusal = {"slow", t.speed_mmps, s.push_speed_mmps};
        return t;
    }
    const double off_deg = angle_deg(moved, axis);
    if (off_deg > s.push_cone_deg) {
        t.refusal = {"off the normal", off_deg, s.push_cone_deg};
        return t;
    }
    // The thrust may have begun before the window; what came before *it* tells a push from a hand
    // that is raised and reaches out.
    std::size_t start = first;
    while (start + 1 < c.history.size() &&
           then.stamp - c.history.at(start + 1).stamp <= kThrustBefore &&
           static_cast<double>(c.history.velocity(from_ms(s.velocity_window_ms), start).dot(axis)) >
               s.push_stable_mmps) {
        ++start;
    }
    t.start = c.history.at(start).stamp;
    const auto length_mm =
        static_cast<double>((now.palm_mm - c.history.at(start).palm_mm).dot(axis));
    if (t.type == GestureType::pull && length_mm < s.pull_length_mm) {
        t.refusal = {"short", length_mm, s.pull_length_mm};
        return t;
    }
    const Vec3f before = c.history.velocity(from_ms(s.velocity_window_ms), start);
    const double turned_deg = angle_deg(before, moved);
    if (static_cast<double>(before.norm()) > s.push_stable_mmps && turned_deg < s.push_turn_deg) {
        t.refusal = {"goes on with the motion before", turned_deg, s.push_turn_deg};
        return t;
    }
    if (t.type == GestureType::push && now.facing.norm() > 0.0F) {
        const float toward = -now.facing.z();
        const double faces = static_cast<double>(now.facing_signed ? toward : std::abs(toward));
        if (faces < s.push_facing) {
            t.refusal = {"the palm does not face the screen", faces, s.push_facing};
        }
    }
    return t;
}

void PushMachine::commit(const Context& c) {
    slow_ = false;
    last_ = thrust_;
    last_at_ = c.sensor;
    GestureEvent e = event_of(c, thrust_.type, EventPhase::begin);
    e.gesture_id = c.next_gesture_id++;
    e.onset = thrust_.start;
    e.progress = 1.0F;
    e.value = static_cast<float>(thrust_.speed_mmps);
    const double sure = thrust_.speed_mmps / (2.0 * c.settings.push_speed_mmps);
    e.confidence *= std::clamp(static_cast<float>(sure), kConfidenceFloor, 1.0F);
    c.out.add(e);
    e.phase = EventPhase::end;
    c.out.add(e);
}

}  // namespace xtrack::recognise
