// SPDX-License-Identifier: Apache-2.0
//
//          fits            enough (begin)
//   away ────────▶ shown ─────────────────▶ held ⟲ fits, wavers (update)
//    ▲               │ wavers, gone,          │ gone, finished (end)
//    │               │ dropped                │ dropped (cancel)
//    └───────────────┴────────────────────────┘
//
// Shown is a pose that fits but has not been held for long. A held one may waver: its end asks for
// less than its begin, and for a moment.
#include "gestures/recognise/machines/pose.hpp"

#include <algorithm>
#include <array>

#include "gestures/segment/ramp.hpp"

namespace xtrack::recognise {

namespace {

// Flexion (track/hand_from_joints.hpp) of fingers that people hold straight, and folded: measured
// 0..60 and 150..240 degrees. A score of 0.8 lies at 66 and 148.
constexpr float kStraightDeg = 50.0F;
constexpr float kHalfDeg = 130.0F;
constexpr float kUnfoldedDeg = 80.0F;
constexpr float kFoldedDeg = 165.0F;
// Thumb tip to the nearest joint of index, middle and ring finger, shares of the hand's length:
// measured 0.04..0.2 of thumbs on folded fingers, 0.3..0.5 of thumbs that are shown.
constexpr float kThumbIn = 0.15F;
constexpr float kThumbInNoMore = 0.30F;
constexpr float kThumbOutFrom = 0.15F;
constexpr float kThumbOut = 0.30F;
// A camera's extensions of folded fingers and of a thumb upon them: those of folded ones are
// 0..0.4, as knuckles stand out of a fist; a finger counts as extended from 0.35 on, which is 0.8
// here.
constexpr float kFoldedExtension = 0.2F;
constexpr float kUnfoldedExtension = 1.0F;
// Cosine from the vertical of a thumb: 60 degrees is none, 40 is 0.8 of it.
constexpr float kThumbSlants = 0.5F;
constexpr float kThumbUpright = 0.85F;
constexpr std::array kFingers{Finger::index, Finger::middle, Finger::ring, Finger::little};

/// -1 = unknown, as of a finger's extension.
float straight(const MotionSample& hand, Finger finger) {
    const auto f = static_cast<std::size_t>(finger);
    const float deg = hand.flexion[f].whole_deg;
    return hand.from_joints ? deg > kFlexionUnknown ? ramp(deg, kHalfDeg, kStraightDeg) : -1.0F
                            : hand.extension[f];
}

/// Of a camera's finger.
float folded_of(float extension) {
    return extension < 0.0F ? -1.0F : ramp(extension, kUnfoldedExtension, kFoldedExtension);
}

float folded(const MotionSample& hand, Finger finger) {
    const auto f = static_cast<std::size_t>(finger);
    if (!hand.from_joints) {
        return folded_of(hand.extension[f]);
    }
    const float deg = hand.flexion[f].whole_deg;
    return deg > kFlexionUnknown ? ramp(deg, kUnfoldedDeg, kFoldedDeg) : -1.0F;
}

float thumb_out(const MotionSample& hand) {
    if (!hand.from_joints) {
        return hand.extension[static_cast<std::size_t>(Finger::thumb)];
    }
    return hand.thumb_to_fingers_mm < 0.0F || hand.hand_length_mm <= 0.0F
               ? -1.0F
               : ramp(hand.thumb_to_fingers_mm / hand.hand_length_mm, kThumbOutFrom, kThumbOut);
}

float thumb_in(const MotionSample& hand) {
    if (!hand.from_joints) {
        return folded_of(thumb_out(hand));
    }
    return hand.thumb_to_fingers_mm < 0.0F || hand.hand_length_mm <= 0.0F
               ? -1.0F
               : ramp(hand.thumb_to_fingers_mm / hand.hand_length_mm, kThumbInNoMore, kThumbIn);
}

/// The first `straight_ones` of index, middle, ring and little finger are straight, the others
/// folded.
float fingers(const MotionSample& hand, std::size_t straight_ones) {
    float worst = 1.0F;
    for (std::size_t i = 0; i < kFingers.size(); ++i) {
        worst = std::min(
            worst, i < straight_ones ? straight(hand, kFingers[i]) : folded(hand, kFingers[i]));
    }
    return worst;
}

float score_of(GestureType pose, const MotionSample& hand) {
    switch (pose) {
        case GestureType::open_palm: return std::min(fingers(hand, 4), thumb_out(hand));
        case GestureType::fist: return std::min(fingers(hand, 0), thumb_in(hand));
        case GestureType::point: return fingers(hand, 1);
        case GestureType::victory: return std::min(fingers(hand, 2), thumb_in(hand));
        case GestureType::thumb_up:
        case GestureType::thumb_down: {
            const float up =
                pose == GestureType::thumb_up ? hand.thumb_along.y() : -hand.thumb_along.y();
            return std::min(
                {fingers(hand, 0), thumb_out(hand), ramp(up, kThumbSlants, kThumbUpright)});
        }
        case GestureType::hand:
        case GestureType::engage:
        case GestureType::swipe:
        case GestureType::push:
        case GestureType::pull:
        case GestureType::pinch:
        case GestureType::double_pinch:
        case GestureType::grab:
        case GestureType::tap:
        case GestureType::double_tap:
        case GestureType::circle:
        case GestureType::wave:
        case GestureType::raise:
        case GestureType::dwell:
        case GestureType::press:
        case GestureType::touch:
        case GestureType::drag:
        case GestureType::two_hand_zoom:
        case GestureType::two_hand_rotate: break;
    }
    return 0.0F;
}

}  // namespace

double pose_score(GestureType pose, const MotionSample& hand) noexcept {
    return static_cast<double>(std::clamp(score_of(pose, hand), 0.0F, 1.0F));
}

const char* PoseMachine::name(State s) {
    switch (s) {
        case State::away: return "away";
        case State::shown: return "shown";
        case State::held: return "held";
    }
    return "?";
}

const char* PoseMachine::name(Event e) {
    switch (e) {
        case Event::fits: return "fits";
        case Event::enough: return "enough";
        case Event::wavers: return "wavers";
        case Event::gone: return "gone";
        case Event::dropped: return "dropped";
        case Event::finished: return "finished";
    }
    return "?";
}

void PoseMachine::update(const Context& c) {
    if (c.gate != Gate::open && c.gate != Gate::entering) {
        drop(c, reason_of(c.gate), why(c.gate));
        return;
    }
    if (c.taken) {
        drop(c, CancelReason::superseded, "another gesture has the hand");
        return;
    }
    score_ = pose_score(pose_, c.history.newest());
    Refusal refusal;
    const Event event = judge(c, refusal);
    handle(c, event, refusal);
}

PoseMachine::Event PoseMachine::judge(const Context& c, Refusal& refusal) {
    const GestureSettings& s = c.settings;
    const Stamp now = c.history.newest().stamp;
    if (state() == State::held) {
        if (score_ >= s.pose_end) {
            fits_at_ = now;
        }
        return to_ms(now - fits_at_) >= s.pose_end_ms ? Event::gone
               : score_ >= s.pose_begin               ? Event::fits
                                                      : Event::wavers;
    }
    if (score_ < s.pose_begin) {
        // Fingers are taken for one another for a moment.
        if (state() == State::shown && to_ms(now - fits_at_) < s.pose_end_ms) {
            return Event::fits;
        }
        refusal = {state() == State::shown ? "wavers" : "", score_, s.pose_begin};
        return Event::wavers;
    }
    const auto palm_mmps =
        static_cast<double>(c.history.velocity(from_ms(s.velocity_window_ms)).norm());
    if (palm_mmps > s.pose_palm_mmps) {
        refusal = {"the palm moves", palm_mmps, s.pose_palm_mmps};
        return Event::wavers;
    }
    fits_at_ = now;
    if (state() != State::shown || to_ms(now - shown_at_) < s.pose_hold_ms) {
        return Event::fits;
    }
    if (c.gate == Gate::entering) {
        refusal = {why(c.gate), 0.0, 0.0};
        return Event::fits;
    }
    return Event::enough;
}

void PoseMachine::drop(const Context& c, CancelReason reason, const char* why) {
    if (state() != State::away) {
        reason_ = reason;
        handle(c, Event::dropped, {why, 0.0, 0.0});
    }
}

void PoseMachine::finish(const Context& c) {
    if (state() == State::held) {
        handle(c, Event::finished);
    }
}

std::optional<PoseMachine::State> PoseMachine::next(const Context& c, Event event) {
    switch (state()) {
        case State::away: return away(c, event);
        case State::shown: return shown(c, event);
        case State::held: return held(c, event);
    }
    return std::nullopt;
}

std::optional<PoseMachine::State> PoseMachine::away(const Context& c, Event event) {
    switch (event) {
        case Event::fits: shown_at_ = c.sensor; return State::shown;
        case Event::wavers:
        case Event::dropped: return State::away;
        case Event::enough:
        case Event::gone:
        case Event::finished: break;
    }
    return std::nullopt;
}

std::optional<PoseMachine::State> PoseMachine::shown(const Context& c, Event event) {
    switch (event) {
        case Event::fits: return State::shown;
        case Event::enough:
            onset_ = shown_at_;
            gesture_id_ = c.next_gesture_id++;
            send(c, EventPhase::begin);
            return State::held;
        case Event::wavers:
        case Event::dropped: return State::away;
        case Event::gone:
        case Event::finished: break;
    }
    return std::nullopt;
}

std::optional<PoseMachine::State> PoseMachine::held(const Context& c, Event event) {
    switch (event) {
        case Event::fits:
        case Event::wavers: send(c, EventPhase::update); return State::held;
        case Event::gone:
        case Event::finished: send(c, EventPhase::end); return State::away;
        case Event::dropped: send(c, EventPhase::cancel); return State::away;
        case Event::enough: break;
    }
    return std::nullopt;
}

void PoseMachine::send(const Context& c, EventPhase phase) {
    GestureEvent e = event_of(c, pose_, phase);
    e.gesture_id = gesture_id_;
    e.cancel_reason = phase == EventPhase::cancel ? reason_ : CancelReason::none;
    e.onset = onset_;
    e.progress = 1.0F;
    e.value = static_cast<float>(score_);
    c.out.add(e);
}

}  // namespace xtrack::recognise
