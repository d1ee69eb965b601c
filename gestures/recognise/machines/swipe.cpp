// SPDX-License-Identifier: Apache-2.0
//
//            fast                 far_enough (begin and end are sent)
//  waiting ────────▶ stroking ─────────────────────────────▶ coasting
//   ▲  ▲                │ slow, astray, dropped                 │ slow, dropped
//   │  └────────────────┘ (silent: the why-not trace says)      │
//   └───────────────────────────────────────────────────────────┘
//
// A stroke begins when the hand moves along one of the four directions, and is judged by what it
// has done since. Coasting is the rest of a stroke that has committed.
#include "gestures/recognise/machines/swipe.hpp"

#include <algorithm>
#include <cmath>

#include "gestures/recognise/machines/angles.hpp"
#include "gestures/recognise/machines/carriage.hpp"
#include "gestures/recognise/machines/stroke_manner.hpp"

namespace xtrack::recognise {

namespace {

// The line fit lags by half its window, so the stroke began before it was noticed; looking further
// back than this would take in the approach.
constexpr Duration kLookBack = std::chrono::milliseconds{150};
constexpr float kLookBackShare = 0.5F;  // of swipe_dies_mmps: still part of the stroke
// A stroke that is this much faster than the one it undoes was the swipe, the first its wind-up.
constexpr float kWindUpShare = 1.2F;
constexpr Duration kSeenBefore = std::chrono::milliseconds{300};
// A palm that jumps, or two hands whose tracker exchanges their ids. Swipes at a mean of 1.5 m/s
// have 1.9 m/s in their first 100 mm.
constexpr double kFastestMmps = 4000.0;
constexpr float kConfidenceFloor = 0.5F;
// Fingers this much up: a hand that is held up, 37 degrees. On tables and keyboards they lie.
constexpr float kHeldUp = 0.8F;
constexpr double kReadySettlesMs = 3000.0;
// A hand that turns by more has ended its way in and begun something else.
constexpr double kTurnedDeg = 60.0;
// Along the forearm to the wrist: within 45 degrees.
constexpr float kTowardWrist = -0.7F;
// A stroke that is over its peak by so much comes to rest in view. Peaks of a line fit over 100 ms
// scatter by 5 % with 3 mm of noise.
constexpr float kSlowsShare = 0.5F;

Vec3f axis_of(Direction d) {
    switch (d) {
        case Direction::left: return {-1.0F, 0.0F, 0.0F};
        case Direction::right: return {1.0F, 0.0F, 0.0F};
        case Direction::up: return {0.0F, 1.0F, 0.0F};
        case Direction::down: return {0.0F, -1.0F, 0.0F};
        case Direction::none:
        case Direction::clockwise:
        case Direction::counterclockwise: break;
    }
    return Vec3f::Zero();
}

bool horizontal(Direction d) { return d == Direction::left || d == Direction::right; }

bool opposite(Direction a, Direction b) {
    return a != Direction::none && b != Direction::none && a != b && horizontal(a) == horizontal(b);
}

/// Angle to the axis in the x-y plane, degrees.
double off_axis_deg(const Vec3f& v, Direction d) {
    const Vec3f axis = axis_of(d);
    const float along = v.dot(axis);
    const float across = horizontal(d) ? v.y() : v.x();
    return degrees(std::atan2(std::abs(static_cast<double>(across)), static_cast<double>(along)));
}

double out_of_plane_deg(const Vec3f& v) {
    return degrees(std::atan2(std::abs(static_cast<double>(v.z())),
                              std::hypot(static_cast<double>(v.x()), static_cast<double>(v.y()))));
}

double cone_deg(const GestureSettings& s, Direction d) {
    return horizontal(d) ? s.swipe_horizontal_deg : s.swipe_vertical_deg;
}

Direction direction_of(const GestureSettings& s, const Vec3f& v) {
    for (const Direction d : {Direction::left, Direction::right, Direction::up, Direction::down}) {
        const bool asked = s.swipe_vertical || horizontal(d);
        if (asked && v.dot(axis_of(d)) > 0.0F && off_axis_deg(v, d) <= cone_deg(s, d)) {
            return d;
        }
    }
    return Direction::none;
}

}  // namespace

const char* SwipeMachine::name(State s) {
    switch (s) {
        case State::waiting: return "waiting";
        case State::stroking: return "stroking";
        case State::coasting: return "coasting";
    }
    return "?";
}

const char* SwipeMachine::name(Event e) {
    switch (e) {
        case Event::fast: return "fast";
        case Event::slow: return "slow";
        case Event::astray: return "astray";
        case Event::far_enough: return "far_enough";
        case Event::moving: return "moving";
        case Event::dropped: return "dropped";
    }
    return "?";
}

void SwipeMachine::update(const Context& c) {
    const Vec3f velocity = c.history.velocity(from_ms(c.settings.velocity_window_ms));
    note_rest(c, velocity);
    note_ready(c, velocity);
    if (c.gate != Gate::open) {
        coming_ = true;
        coming_mmps_ = Vec3f::Zero();
    }
    if (c.gate != Gate::open || c.taken) {
        drop(c, CancelReason::none, c.taken ? "another gesture has the hand" : why(c.gate));
        return;
    }
    Refusal refusal;
    const State before = state_;
    handle(c, judge(c, velocity, refusal), refusal);
    if (before == State::waiting && state_ == State::stroking) {
        // A slow camera may see the whole stroke at once.
        refusal = {};
        handle(c, judge(c, velocity, refusal), refusal);
    }
}

void SwipeMachine::drop(const Context& c, CancelReason /*reason*/, const char* why) {
    drop_until_ = c.sensor;
    if (state_ != State::waiting) {
        handle(c, Event::dropped, {why, 0.0, 0.0});
    }
}

void SwipeMachine::handle(const Context& c, Event event, const Refusal& refusal) {
    reporter_.report(c, step(state_, event, next(c, event)), refusal,
                     [](auto of) { return name(of); });
}

std::optional<SwipeMachine::State> SwipeMachine::next(const Context& c, Event event) {
    switch (state_) {
        case State::waiting: return waiting(c, event);
        case State::stroking: return stroking(c, event);
        case State::coasting: return coasting(c, event);
    }
    return std::nullopt;
}

std::optional<SwipeMachine::State> SwipeMachine::waiting(const Context& c, Event event) {
    switch (event) {
        case Event::fast: begin_stroke(c, wanted_); return State::stroking;
        case Event::slow:
        case Event::dropped: return State::waiting;
        case Event::astray:
        case Event::far_enough:
        case Event::moving: break;
    }
    return std::nullopt;
}

std::optional<SwipeMachine::State> SwipeMachine::stroking(const Context& c, Event event) {
    switch (event) {
        case Event::far_enough: commit(c); return State::coasting;
        case Event::slow:
        case Event::astray:
        case Event::dropped: return State::waiting;
        case Event::moving: return State::stroking;
        case Event::fast: break;
    }
    return std::nullopt;
}

std::optional<SwipeMachine::State> SwipeMachine::coasting(const Context& /*c*/, Event event) {
    switch (event) {
        case Event::moving: return State::coasting;
        case Event::slow:
        case Event::dropped: return State::waiting;
        case Event::fast:
        case Event::astray:
        case Event::far_enough: break;
    }
    return std::nullopt;
}

SwipeMachine::Event SwipeMachine::judge(const Context& c, const Vec3f& velocity, Refusal& refusal) {
    const GestureSettings& s = c.settings;
    if (state_ == State::waiting) {
        if (comes_in(c, velocity)) {
            refusal = {"on its way in", static_cast<double>(velocity.norm()), s.swipe_dies_mmps};
            return Event::slow;
        }
        wanted_ = direction_of(s, velocity);
        const double along_mmps = static_cast<double>(velocity.dot(axis_of(wanted_)));
        return along_mmps >= s.swipe_dies_mmps ? Event::fast : Event::slow;
    }
    const Vec3f axis = axis_of(stroke_.direction);
    const float along_mmps = velocity.dot(axis);
    stroke_.peak_mmps = std::max(stroke_.peak_mmps, along_mmps);
    if (state_ == State::coasting) {
        last_.peak_mmps = std::max(last_.peak_mmps, along_mmps);
    }
    const bool slow = static_cast<double>(along_mmps) < s.swipe_dies_mmps;
    if (slow) {
        refusal = {"too slow", static_cast<double>(along_mmps), s.swipe_dies_mmps};
    }
    if (state_ == State::coasting) {
        return slow ? Event::slow : Event::moving;
    }
    // A stroke that turns a corner is slow along its axis only.
    const bool stops = static_cast<double>(velocity.norm()) < s.swipe_dies_mmps;
    if (slow && !stops) {
        return Event::slow;
    }
    const MotionSample& now = c.history.newest();
    const Vec3f moved = now.palm_mm - stroke_.palm_mm;
    const double length_mm = static_cast<double>(moved.dot(axis));
    const double across_mm =
        std::abs(static_cast<double>(horizontal(stroke_.direction) ? moved.y() : moved.x()));
    const double allowed_mm =
        s.swipe_sideways_mm + s.swipe_sideways_share * std::max(length_mm, 0.0);
    if (across_mm > allowed_mm) {
        refusal = {"sideways", across_mm, allowed_mm};
        return Event::astray;
    }
    const double lasted_s = to_seconds(now.stamp - stroke_.start);
    stroke_.length_mm = length_mm;
    stroke_.speed_mmps = lasted_s > 0.0 ? length_mm / lasted_s : 0.0;
    if (stroke_.speed_mmps > kFastestMmps) {
        drop_until_ = now.stamp;
        refusal = {"faster than a hand", stroke_.speed_mmps, kFastestMmps};
        return Event::astray;
    }
    if (length_mm < s.swipe_length_mm) {
        return slow ? Event::slow : Event::moving;
    }
    const Refusal reason = objection(c, stops);
    if (*reason.why == '\0') {
        refusal = {};
        return Event::far_enough;
    }
    refusal = reason;
    return slow ? Event::slow : Event::moving;
}

Refusal SwipeMachine::objection(const Context& c, bool stops) const {
    const GestureSettings& s = c.settings;
    const MotionSample& now = c.history.newest();
    const Vec3f axis = axis_of(stroke_.direction);
    const Vec3f moved = now.palm_mm - stroke_.palm_mm;
    // How far from the place where the hand is held up, against the stroke: its preparation.
    const auto below_mm = static_cast<double>(ready_mm_.y() - stroke_.palm_mm.y());
    const double prepared_mm = below_mm * static_cast<double>(axis.y());
    if (ready_known_ && below_mm > s.swipe_below_mm) {
        return {"begins below where the hand is held up", below_mm, s.swipe_below_mm};
    }
    if (s.swipe_prepared && !horizontal(stroke_.direction) && ready_known_ &&
        prepared_mm < s.swipe_prepared_mm && stroke_.speed_mmps < s.swipe_flick_mmps) {
        return {"begins where the hand is held up", prepared_mm, s.swipe_prepared_mm};
    }
    const double off_deg = off_axis_deg(moved, stroke_.direction);
    if (off_deg > cone_deg(s, stroke_.direction)) {
        return {"slanting", off_deg, cone_deg(s, stroke_.direction)};
    }
    if (out_of_plane_deg(moved) > s.swipe_depth_deg) {
        return {"toward or away from the screen", out_of_plane_deg(moved), s.swipe_depth_deg};
    }
    if (!horizontal(stroke_.direction)) {
        // Faces are above and behind the place where hands gesture.
        const double to_body_deg =
            degrees(std::atan2(static_cast<double>(moved.z() * axis.y()), stroke_.length_mm));
        if (to_body_deg > s.swipe_body_deg) {
            return {"to or from the body", to_body_deg, s.swipe_body_deg};
        }
    }
    if (now.index_tip_known && stroke_.tip_known) {
        const double tip_mm = static_cast<double>((now.index_tip_mm - stroke_.tip_mm).dot(axis));
        if (tip_mm < s.swipe_tip_share * stroke_.length_mm) {
            return {"the index tip stays behind", tip_mm, s.swipe_tip_share * stroke_.length_mm};
        }
    }

    const std::size_t samples = c.history.count_within(now.stamp - stroke_.start);
    const Carriage held = carriage(c.history, samples, axis);
    if (held.bend_deg > s.swipe_bend_deg) {
        return {"bends", held.bend_deg, s.swipe_bend_deg};
    }
    if (held.grab > s.swipe_grab) {
        return {"the hand is closed", held.grab, s.swipe_grab};
    }
    if (!now.from_joints) {
        // Fingers blur in a stroke: those of an open hand were seen before it.
        const std::size_t until = c.history.count_within(now.stamp - stroke_.start + kSeenBefore);
        const double before = extensions_in(c.history, samples, until - samples).all;
        const double open = std::max(held.extension.all, before);
        if (open >= 0.0 && open < s.swipe_open) {
            return {"the hand is closed", open, s.swipe_open};
        }
    }
    const Manner manner = manner_of(s, held, now.from_joints, horizontal(stroke_.direction));
    const Least least = least_of(s, manner);
    if (stroke_.length_mm < least.mm) {
        return {least.shorter, stroke_.length_mm, least.mm};
    }
    if (stroke_.speed_mmps < least.mmps) {
        return {least.slower, stroke_.speed_mmps, least.mmps};
    }
    const bool carried = manner == Manner::carried || manner == Manner::pointing;
    if (carried && !stops) {
        return {"may turn a corner yet", 0.0, 0.0};
    }
    if (withdraws(held.distal)) {
        // The border eats up a hand that leaves, and stops its palm while its fingers go on.
        const Duration window = from_ms(s.velocity_window_ms);
        const float along_mmps = std::max(c.history.velocity(window).dot(axis),
                                          c.history.tip_velocity(window).dot(axis));
        const float slows_mmps = kSlowsShare * stroke_.peak_mmps;
        if (along_mmps > slows_mmps) {
            return {"may leave the view yet", static_cast<double>(along_mmps),
                    static_cast<double>(slows_mmps)};
        }
    }

    if (opposite(stroke_.direction, last_.direction)) {
        const double ratio = static_cast<double>(stroke_.peak_mmps / last_.peak_mmps);
        const double since_ms = to_ms(stroke_.start - committed_at_);
        const bool barred = since_ms < s.swipe_return_bar_ms || !rested_since_;
        if (barred && ratio < static_cast<double>(kWindUpShare)) {
            return {"return stroke", since_ms, s.swipe_return_bar_ms};
        }
        if (since_ms < s.swipe_return_memory_ms && ratio < s.swipe_return_share) {
            return {"slow return stroke", ratio, s.swipe_return_share};
        }
    }
    return {};
}

void SwipeMachine::begin_stroke(const Context& c, Direction direction) {
    const GestureSettings& s = c.settings;
    const Vec3f axis = axis_of(direction);
    const float least_mmps = kLookBackShare * static_cast<float>(s.swipe_dies_mmps);
    const Stamp now = c.history.newest().stamp;
    std::size_t start = 0;
    while (start + 1 < c.history.size()) {
        const MotionSample& later = c.history.at(start);
        const MotionSample& earlier = c.history.at(start + 1);
        const Vec3f step = later.palm_mm - earlier.palm_mm;
        const float along = step.dot(axis);
        const float dt_s = static_cast<float>(to_seconds(later.stamp - earlier.stamp));
        // Single steps are noisier than the fit; the cone is widened for them.
        if (now - earlier.stamp > kLookBack || earlier.stamp < drop_until_ ||
            along < least_mmps * dt_s || off_axis_deg(step, direction) > 45.0) {
            break;
        }
        ++start;
    }
    const MotionSample& first = c.history.at(start);
    stroke_ = {};
    stroke_.direction = direction;
    stroke_.start = first.stamp;
    stroke_.palm_mm = first.palm_mm;
    stroke_.tip_mm = first.index_tip_mm;
    stroke_.tip_known = first.index_tip_known;
}

void SwipeMachine::commit(const Context& c) {
    committed_at_ = c.sensor;
    last_ = stroke_;
    rested_since_ = false;

    GestureEvent e = event_of(c, GestureType::swipe, EventPhase::begin);
    e.direction = stroke_.direction;
    e.gesture_id = c.next_gesture_id++;
    e.onset = stroke_.start;
    e.progress = 1.0F;
    e.value = static_cast<float>(stroke_.speed_mmps);
    // Twice the speed that is asked for leaves no doubt.
    const double sure = stroke_.speed_mmps / (2.0 * c.settings.swipe_speed_mmps);
    e.confidence *= std::clamp(static_cast<float>(sure), kConfidenceFloor, 1.0F);
    c.out.add(e);
    e.phase = EventPhase::end;
    c.out.add(e);
}

void SwipeMachine::note_rest(const Context& c, const Vec3f& velocity) {
    if (static_cast<double>(velocity.norm()) <
        c.signal.still_mmps(c.settings.swipe_rest_mmps, from_ms(c.settings.velocity_window_ms))) {
        rested_since_ = true;
    }
}

/// Where the hand was last held up and did not stroke.
void SwipeMachine::note_ready(const Context& c, const Vec3f& velocity) {
    const MotionSample& now = c.history.newest();
    if (now.distal.y() < kHeldUp ||
        static_cast<double>(velocity.norm()) >= c.settings.swipe_dies_mmps) {
        return;
    }
    if (!ready_known_) {
        ready_known_ = true;
        ready_mm_ = now.palm_mm;
    }
    const double ms = c.history.size() > 1 ? to_ms(now.stamp - c.history.at(1).stamp) : 0.0;
    ready_mm_ +=
        static_cast<float>(1.0 - std::exp(-ms / kReadySettlesMs)) * (now.palm_mm - ready_mm_);
}

/// A motion that was under way when the gate opened is the hand's way in, until it rests or turns.
bool SwipeMachine::comes_in(const Context& c, const Vec3f& velocity) {
    if (!coming_) {
        return false;
    }
    if (coming_mmps_.isZero()) {
        coming_mmps_ = velocity;
    }
    const double speed_mmps = static_cast<double>(velocity.norm());
    coming_ =
        speed_mmps >= c.settings.swipe_dies_mmps && angle_deg(velocity, coming_mmps_) <= kTurnedDeg;
    return coming_;
}

/// A stroke along the forearm to the wrist is how a hand is taken out of view. Where the fingers do
/// not say where the forearm is, it hangs down.
bool SwipeMachine::withdraws(const Vec3f& distal) const {
    if (distal.isZero()) {
        return stroke_.direction == Direction::down;
    }
    return distal.normalized().dot(axis_of(stroke_.direction)) <= kTowardWrist;
}

}  // namespace xtrack::recognise
