// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <xtrack/hand.hpp>
#include <xtrack/one_euro_filter.hpp>

#include "gestures/recognise/body.hpp"
#include "gestures/recognise/context.hpp"
#include "gestures/recognise/machines/circle.hpp"
#include "gestures/recognise/machines/double.hpp"
#include "gestures/recognise/machines/drag.hpp"
#include "gestures/recognise/machines/dwell.hpp"
#include "gestures/recognise/machines/grab.hpp"
#include "gestures/recognise/machines/pinch.hpp"
#include "gestures/recognise/machines/pose.hpp"
#include "gestures/recognise/machines/press.hpp"
#include "gestures/recognise/machines/push.hpp"
#include "gestures/recognise/machines/raise.hpp"
#include "gestures/recognise/machines/swipe.hpp"
#include "gestures/recognise/machines/tap.hpp"
#include "gestures/recognise/machines/touch.hpp"
#include "gestures/recognise/machines/wave.hpp"
#include "gestures/recognise/presence.hpp"
#include "gestures/recognise/silence.hpp"

namespace xtrack::recognise {

/// The gestures of one hand. Every machine has
///   - kRank, and wanted(settings): whether anybody needs it;
///   - update(c): a new sample is in the history;
///   - drop(c, reason, why): lost, taken, switched off: what is active is cancelled;
///   - finish(c): the stream is over: what is active ends;
///   - holds(): something is active;
///   - swings(), of rhythms: what goes on is one, though not yet sent, and no stroke;
///   - sends(settings): what it would send next is switched on.
/// The drag is one more, which needs to hear of the others' grip.
struct Machines {
    PressMachine press;
    TouchMachine touch;
    PinchMachine pinch;
    GrabMachine grab;
    CircleMachine circle;
    WaveMachine wave;
    SwipeMachine swipe;
    PushMachine push;
    TapMachine tap;
    RaiseMachine raise;
    DwellMachine dwell;
    PoseMachine open_palm{GestureType::open_palm};
    PoseMachine fist{GestureType::fist};
    PoseMachine point{GestureType::point};
    PoseMachine victory{GestureType::victory};
    PoseMachine thumb_up{GestureType::thumb_up};
    PoseMachine thumb_down{GestureType::thumb_down};
    DoubleMachine double_pinch{"double_pinch", GestureType::double_pinch};
    DoubleMachine double_tap{"double_tap", GestureType::double_tap};
    DragMachine drag;

    /// In the order of their turns: the strong before the weak, but rhythms before strokes, because
    /// a stroke that is part of a rhythm is none, circles before waves, because a circle goes to
    /// and fro as well, and what is made of others after them.
    template <typename Act>
    void each(const Act& act) {
        act(press);
        act(touch);
        act(pinch);
        act(grab);
        act(circle);
        act(wave);
        act(swipe);
        act(push);
        act(tap);
        act(raise);
        act(dwell);
        act(open_palm);
        act(fist);
        act(point);
        act(victory);
        act(thumb_up);
        act(thumb_down);
        act(double_pinch);
        act(double_tap);
    }

    template <typename Act>
    void each_and_drag(const Act& act) {
        act(drag);
        each(act);
    }

    /// Tells what is made of other gestures of what these have sent.
    void listen() noexcept {
        double_pinch.hear(pinch.gesture_id());
        double_tap.hear(tap.gesture_id());
    }

    /// Those that something else can go on with are taken over: cancelled, but followed.
    void carry(const Context& c) {
        press.carry(c);
        pinch.carry(c);
        grab.carry(c);
    }
};

/// A hand, what is known of it, and its gestures.
struct HandSlot {
    bool used = false;
    bool seen_now = false;
    Hand hand;  ///< as last seen
    Presence presence;
    MotionHistory history;
    OneEuroFilter3 pointer;
    SignalMeter meter;
    Silence silence;
    Machines machines;
    bool was_active = false;  ///< a gesture was, in the last frame
    bool summons = false;     ///< it has just waved: for a session that is idle
    bool is_bystander = false;
    HandSize size;
    /// Where no hand can be after the last two samples: another place of the arm, or another hand,
    /// was taken for it until now, or is from now on. @{
    bool jumped = false;
    Vec3f expected_mm = Vec3f::Zero();
    float reach_mm = 0.0F;  ///< about expected_mm
    /// @}

    void begin(const Hand& seen, Stamp now, bool in_view);
    /// @return false when the sample was left out (MotionHistory::add())
    bool add(Stamp now, Duration span);
    void forget_motion();
    /// Judges by its last samples where it is now.
    void follow(Stamp now) noexcept;

    void drop(const Context& c, CancelReason reason, const char* why);
    /// What is active and will not be wanted any more is cancelled.
    void switch_off(const Context& c, const GestureSettings& future);
    void finish(const Context& c);

    /// A gesture of this hand is active.
    [[nodiscard]] bool holds();
    /// What it holds on with, of the gestures that a drag can come from.
    [[nodiscard]] Grip grip(const GestureSettings& settings) const;
    /// The fingers hold, whoever has the hand: for gestures of two hands.
    [[nodiscard]] Grip fingers() const;

    /// The newest sample goes through all machines that are wanted.
    /// @param two_handed a gesture of two hands has it
    void update(Context& c, bool two_handed);
};

}  // namespace xtrack::recognise
