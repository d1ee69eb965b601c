// SPDX-License-Identifier: Apache-2.0
//
//              turned                     enough (begin and end are sent)
//  waiting ─────────────▶ swinging ──────────────────────────────────▶ recovering
//     ▲                     │   ▲ turned                                    │
//     │  stale, dropped     │   └──┘                                        │ still, dropped
//     ├─────────────────────┘                                               │
//     └─────────────────────────────────────────────────────────────────────┘
//
// A turn is where the palm goes back after a stroke of 50 mm to the left or right. Turns that are
// too old fall away from the front; without any the machine waits again.
#include "gestures/recognise/machines/wave.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace xtrack::recognise {

namespace {

// So much of the stroke's way back shows that the hand has turned, and is more than noise.
constexpr double kBackShare = 0.25;
constexpr float kConfidence = 0.9F;
constexpr double kOutliers = 0.1;  // share of the palms

/// From the lowest to the highest palm along an axis, but for the outermost kOutliers at either
/// end: now and then a wrist is taken for the palm.
float range_mm(const MotionHistory& history, std::size_t samples, Eigen::Index axis) {
    std::array<float, MotionHistory::kCapacity> along{};
    for (std::size_t i = 0; i < samples; ++i) {
        along[i] = history.at(i).palm_mm[axis];
    }
    const auto end = along.begin() + static_cast<std::ptrdiff_t>(samples);
    const auto out = static_cast<std::ptrdiff_t>(kOutliers * static_cast<double>(samples));
    std::nth_element(along.begin(), along.begin() + out, end);
    const float low = along[static_cast<std::size_t>(out)];
    std::nth_element(along.begin(), end - 1 - out, end);
    return *(end - 1 - out) - low;
}

}  // namespace

const char* WaveMachine::name(State s) {
    switch (s) {
        case State::waiting: return "waiting";
        case State::swinging: return "swinging";
        case State::recovering: return "recovering";
    }
    return "?";
}

const char* WaveMachine::name(Event e) {
    switch (e) {
        case Event::turned: return "turned";
        case Event::enough: return "enough";
        case Event::moving: return "moving";
        case Event::stale: return "stale";
        case Event::still: return "still";
        case Event::dropped: return "dropped";
    }
    return "?";
}

void WaveMachine::forget() noexcept {
    count_ = 0;
    known_ = false;
    sign_ = 0.0F;
}

bool WaveMachine::follow(const Context& c, Refusal& refusal) {
    const MotionSample& now = c.history.newest();
    const Turn here{now.stamp, now.palm_mm};
    if (!known_) {
        known_ = true;
        begin_ = extreme_ = here;
        return false;
    }
    const double back_mm = kBackShare * c.settings.wave_stroke_mm;
    if (sign_ == 0.0F) {
        const float way = here.palm_mm.x() - begin_.palm_mm.x();
        if (static_cast<double>(std::abs(way)) >= back_mm) {
            sign_ = way > 0.0F ? 1.0F : -1.0F;
            extreme_ = here;
        }
        return false;
    }
    if (sign_ * (here.palm_mm.x() - extreme_.palm_mm.x()) >= 0.0F) {
        extreme_ = here;
        return false;
    }
    if (static_cast<double>(sign_ * (extreme_.palm_mm.x() - here.palm_mm.x())) < back_mm) {
        return false;
    }
    const auto stroke_mm = static_cast<double>(std::abs(extreme_.palm_mm.x() - begin_.palm_mm.x()));
    const bool long_enough = stroke_mm >= c.settings.wave_stroke_mm;
    if (long_enough) {
        if (count_ == kMostTurns) {
            std::rotate(turns_.begin(), turns_.begin() + 1, turns_.end());
            --count_;
        }
        turns_[count_++] = extreme_;
    } else {
        refusal = {"short stroke", stroke_mm, c.settings.wave_stroke_mm};
        count_ = 0;
    }
    begin_ = extreme_;
    extreme_ = here;
    sign_ = -sign_;
    return long_enough;
}

// How far the palm strays from the line on which it goes to and fro, since the first turn.
Refusal WaveMachine::off_axis(const Context& c) const {
    const Duration age = c.history.newest().stamp - turns_[0].stamp;
    const std::size_t samples = c.history.count_within(age);
    const auto strays_mm = static_cast<double>(
        std::max(range_mm(c.history, samples, 1), range_mm(c.history, samples, 2)));
    if (strays_mm > c.settings.wave_off_axis_mm) {
        return {"off the axis", strays_mm, c.settings.wave_off_axis_mm};
    }
    return {};
}

void WaveMachine::watch_rest(const Context& c) {
    const Vec3f velocity = c.history.velocity(from_ms(c.settings.velocity_window_ms));
    const bool still =
        static_cast<double>(velocity.norm()) <
        c.signal.still_mmps(c.settings.wave_rest_mmps, from_ms(c.settings.velocity_window_ms));
    if (still && !still_) {
        still_since_ = c.history.newest().stamp;
    }
    still_ = still;
}

bool WaveMachine::rests(const Context& c) const {
    return still_ && to_ms(c.history.newest().stamp - still_since_) >= c.settings.wave_rest_ms;
}

void WaveMachine::update(const Context& c) {
    const Stamp now = c.history.newest().stamp;
    watch_rest(c);
    if (state_ == State::recovering) {
        handle(c, rests(c) ? Event::still : Event::moving);
        return;
    }
    if (c.gate != Gate::open || c.taken) {
        drop(c, CancelReason::none, c.taken ? "another gesture has the hand" : why(c.gate));
        return;
    }
    Refusal refusal;
    if (rests(c)) {
        forget();  // the stroke that follows is another gesture's
    }
    const bool turned = follow(c, refusal);
    while (count_ > 0 && to_ms(now - turns_[0].stamp) > c.settings.wave_within_ms) {
        std::rotate(turns_.begin(), turns_.begin() + 1,
                    turns_.begin() + static_cast<std::ptrdiff_t>(count_));
        --count_;
    }
    if (turned && count_ >= static_cast<std::size_t>(c.settings.wave_turns)) {
        refusal = off_axis(c);
        if (*refusal.why == '\0') {
            handle(c, Event::enough);
            return;
        }
    }
    if (count_ == 0) {
        if (state_ == State::swinging) {
            handle(c, Event::stale, refusal);
        } else {
            handle(c, Event::moving, refusal);
        }
        return;
    }
    handle(c, turned ? Event::turned : Event::moving, refusal);
}

void WaveMachine::drop(const Context& c, CancelReason /*reason*/, const char* why) {
    forget();
    if (state_ != State::waiting) {
        handle(c, Event::dropped, {why, 0.0, 0.0});
    }
}

void WaveMachine::handle(const Context& c, Event event, const Refusal& refusal) {
    reporter_.report(c, step(state_, event, next(c, event)), refusal,
                     [](auto of) { return name(of); });
}

std::optional<WaveMachine::State> WaveMachine::next(const Context& c, Event event) {
    switch (state_) {
        case State::waiting: return waiting(c, event);
        case State::swinging: return swinging(c, event);
        case State::recovering: return recovering(c, event);
    }
    return std::nullopt;
}

std::optional<WaveMachine::State> WaveMachine::waiting(const Context& c, Event event) {
    switch (event) {
        case Event::moving:
        case Event::dropped: return State::waiting;
        case Event::turned: return State::swinging;
        case Event::enough: commit(c); return State::recovering;
        case Event::stale:
        case Event::still: break;
    }
    return std::nullopt;
}

std::optional<WaveMachine::State> WaveMachine::swinging(const Context& c, Event event) {
    switch (event) {
        case Event::turned:
        case Event::moving: return State::swinging;
        case Event::enough: commit(c); return State::recovering;
        case Event::stale:
        case Event::dropped: return State::waiting;
        case Event::still: break;
    }
    return std::nullopt;
}

std::optional<WaveMachine::State> WaveMachine::recovering(const Context& /*c*/, Event event) {
    switch (event) {
        case Event::moving: return State::recovering;
        case Event::still:
        case Event::dropped: return State::waiting;
        case Event::turned:
        case Event::enough:
        case Event::stale: break;
    }
    return std::nullopt;
}

void WaveMachine::commit(const Context& c) {
    GestureEvent e = event_of(c, GestureType::wave, EventPhase::begin);
    e.gesture_id = c.next_gesture_id++;
    e.onset = turns_[0].stamp;
    e.progress = 1.0F;
    e.value = static_cast<float>(count_);
    e.confidence *= kConfidence;
    c.out.add(e);
    e.phase = EventPhase::end;
    c.out.add(e);
    forget();
    still_ = false;
}

}  // namespace xtrack::recognise
