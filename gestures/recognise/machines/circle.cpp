// SPDX-License-Identifier: Apache-2.0
//
//             winds               enough (begin and end are sent)
//  waiting ──────────▶ winding ──────────────────────────────────▶ turning ⟲ enough: a turn more
//   ▲  ▲                  │ stale, unwinds, dropped                   │
//   │  └──────────────────┘                                           │ stale, unwinds, dropped
//   └─────────────────────────────────────────────────────────────────┘
//
// Winding has more than half a turn, which nothing but a circle has, and is none yet. Two points
// are looked at: the index tip while it points, because a small circle is drawn with it alone, and
// the palm, because a hand that draws a large one need not point.
#include "gestures/recognise/machines/circle.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace xtrack::recognise {

namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kWindsTurns = 0.6;  // a stroke and its wind-up have half a turn
constexpr double kBackRad = 0.8;     // an eighth of a turn back ends it
constexpr float kPointingIndex = 0.5F;
constexpr double kConfidenceFloor = 0.5;

bool points(const MotionSample& sample, const GestureSettings& s) {
    const float outer = sample.outer_extension();
    return sample.from_joints && sample.index_tip_known && outer >= 0.0F &&
           static_cast<double>(outer) <= s.tap_pointing_extension &&
           sample.extension[static_cast<std::size_t>(Finger::index)] >= kPointingIndex;
}

}  // namespace

const char* CircleMachine::name(State s) {
    switch (s) {
        case State::waiting: return "waiting";
        case State::winding: return "winding";
        case State::turning: return "turning";
    }
    return "?";
}

const char* CircleMachine::name(Event e) {
    switch (e) {
        case Event::moving: return "moving";
        case Event::winds: return "winds";
        case Event::enough: return "enough";
        case Event::unwinds: return "unwinds";
        case Event::stale: return "stale";
        case Event::dropped: return "dropped";
    }
    return "?";
}

void CircleMachine::forget() noexcept {
    for (ArcPath& path : paths_) {
        path.clear();
    }
    turned_rad_ = farthest_rad_ = 0.0;
    turns_ = 0;
}

void CircleMachine::update(const Context& c) {
    if (c.gate != Gate::open || c.taken) {
        drop(c, CancelReason::none, c.taken ? "another gesture has the hand" : why(c.gate));
        return;
    }
    Refusal refusal;
    handle(c, state() == State::turning ? follow(c, refusal) : look(c, refusal), refusal);
    if (state() == State::waiting && turns_ > 0) {
        forget();
    }
}

void CircleMachine::drop(const Context& c, CancelReason /*reason*/, const char* why) {
    forget();
    if (state() != State::waiting) {
        handle(c, Event::dropped, {why, 0.0, 0.0});
    }
}

std::optional<CircleMachine::State> CircleMachine::next(const Context& c, Event event) {
    switch (state()) {
        case State::waiting: return waiting(c, event);
        case State::winding: return winding(c, event);
        case State::turning: return turning(c, event);
    }
    return std::nullopt;
}

std::optional<CircleMachine::State> CircleMachine::waiting(const Context& c, Event event) {
    switch (event) {
        case Event::moving:
        case Event::unwinds:
        case Event::stale:
        case Event::dropped: return State::waiting;
        case Event::winds: return State::winding;
        case Event::enough: commit(c); return State::turning;
    }
    return std::nullopt;
}

std::optional<CircleMachine::State> CircleMachine::winding(const Context& c, Event event) {
    switch (event) {
        case Event::moving:
        case Event::winds: return State::winding;
        case Event::enough: commit(c); return State::turning;
        case Event::unwinds:
        case Event::stale:
        case Event::dropped: return State::waiting;
    }
    return std::nullopt;
}

std::optional<CircleMachine::State> CircleMachine::turning(const Context& c, Event event) {
    switch (event) {
        case Event::moving: return State::turning;
        case Event::enough: commit(c); return State::turning;
        case Event::unwinds:
        case Event::stale:
        case Event::dropped: return State::waiting;
        case Event::winds: break;
    }
    return std::nullopt;
}

ArcPath::Limits CircleMachine::limits(const GestureSettings& s) const noexcept {
    return {s.circle_least_mm,      s.circle_most_mm,
            s.circle_error,         std::min(kWindsTurns, s.circle_turns) * kTurn,
            s.circle_turns * kTurn, from_ms(s.circle_within_ms)};
}

CircleMachine::Event CircleMachine::look(const Context& c, Refusal& refusal) {
    const GestureSettings& s = c.settings;
    const MotionSample& now = c.history.newest();
    const double needed_rad = s.circle_turns * kTurn;
    const bool winding = state() == State::winding;
    bool ends = false;  // what was winding
    Arc best;
    for (const Point point : {tip, palm}) {
        ArcPath& path = paths_[point];
        const bool seen = point == palm || points(now, s);
        if (!path.empty() && (!seen || to_ms(now.stamp - path.newest()) > s.circle_stale_ms)) {
            ends = ends || (winding && point == point_);
            path.clear();
        }
        if (!seen || !path.add(point == tip ? now.index_tip_mm : now.palm_mm, now.stamp)) {
            continue;
        }
        const Arc arc = path.find(limits(s));
        if (std::abs(arc.turned_rad) > std::abs(best.turned_rad)) {
            best = arc;
            point_ = point;
        } else if (winding && point == point_) {
            ends = ends || !best.found;
            refusal = {"off the circle", 0.0, s.circle_error};
        }
    }
    if (best.found) {
        arc_ = best;
        turned_rad_ = farthest_rad_ = std::abs(best.turned_rad);
        if (turned_rad_ >= needed_rad) {
            refusal = {};
            return Event::enough;
        }
        refusal = {"not yet far enough round", turned_rad_ / kTurn, s.circle_turns};
        return Event::winds;
    }
    if (!ends) {
        return Event::moving;
    }
    return *refusal.why == '\0' ? Event::stale : Event::unwinds;
}

CircleMachine::Event CircleMachine::follow(const Context& c, Refusal& refusal) {
    const GestureSettings& s = c.settings;
    const MotionSample& now = c.history.newest();
    ArcPath& path = paths_[point_];
    if (to_ms(now.stamp - path.newest()) > s.circle_stale_ms) {
        refusal = {"no progress", to_ms(now.stamp - path.newest()), s.circle_stale_ms};
        return Event::stale;
    }
    if (point_ == tip && !now.index_tip_known) {
        refusal = {"the index tip is lost", 0.0, 0.0};
        return Event::unwinds;
    }
    if (!path.add(point_ == tip ? now.index_tip_mm : now.palm_mm, now.stamp)) {
        return Event::moving;
    }
    const Arc arc = path.newest_turn(arc_.radius_mm, limits(s));
    if (!arc.found) {
        refusal = {"off the circle", arc.error, s.circle_error};
        return Event::unwinds;
    }
    const double sign = arc_.turned_rad > 0.0 ? 1.0 : -1.0;
    arc_.centre_mm = arc.centre_mm;
    arc_.radius_mm = arc.radius_mm;
    turned_rad_ += sign * path.step_rad(arc.centre_mm);
    farthest_rad_ = std::max(farthest_rad_, turned_rad_);
    if (turned_rad_ < farthest_rad_ - kBackRad) {
        refusal = {"turns back", farthest_rad_ - turned_rad_, kBackRad};
        return Event::unwinds;
    }
    // The first is known before it is complete; the others when they are.
    return turned_rad_ >= (turns_ + 1) * kTurn ? Event::enough : Event::moving;
}

void CircleMachine::commit(const Context& c) {
    ++turns_;
    GestureEvent e = event_of(c, GestureType::circle, EventPhase::begin);
    e.direction = arc_.turned_rad > 0.0 ? Direction::counterclockwise : Direction::clockwise;
    e.gesture_id = c.next_gesture_id++;
    e.onset = arc_.start;
    e.progress = 1.0F;
    e.value = static_cast<float>(turned_rad_ / kTurn);
    e.confidence *= static_cast<float>(std::max(1.0 - arc_.error, kConfidenceFloor));
    c.out.add(e);
    e.phase = EventPhase::end;
    c.out.add(e);
}

}  // namespace xtrack::recognise
