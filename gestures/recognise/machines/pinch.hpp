// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "gestures/recognise/context.hpp"
#include "gestures/recognise/step.hpp"

namespace xtrack::recognise {

/// One pinch machine a hand. The diagram is in docs/gestures/pinch.md and in pinch.cpp.
class PinchMachine {
 public:
    static constexpr Rank kRank = Rank::grip;
    [[nodiscard]] static bool sends(const GestureSettings& s) noexcept { return s.pinch; }
    [[nodiscard]] static bool wanted(const GestureSettings& s) noexcept {
        return s.pinch || s.double_pinch || s.two_hand_zoom || s.two_hand_rotate || s.grab ||
               s.tap || s.double_tap;  // what is a pinch is none of these
    }

    /// A new sample is in the history.
    void update(const Context& c);
    /// The hand was lost, came to the border, or was taken: an active pinch is cancelled.
    void drop(const Context& c, CancelReason reason, const char* why);
    /// The stream is over: an active pinch ends.
    void finish(const Context& c);

    /// A stronger gesture goes on with the fingers that are together: the pinch is cancelled, and
    /// followed in silence until they part.
    void carry(const Context& c);

    [[nodiscard]] bool holds() const noexcept { return state_ == State::pinched; }
    /// Of the pinch that began last; -1: none yet.
    [[nodiscard]] int gesture_id() const noexcept { return gesture_id_; }
    /// The fingers are together, whoever has the hand.
    [[nodiscard]] bool closed() const noexcept {
        return state_ == State::pinched || state_ == State::carried;
    }
    /// Why they last came apart, if they were not opened.
    [[nodiscard]] CancelReason broke() const noexcept { return broke_; }

 private:
    enum class State { away, armed, touching, pinched, carried, spoilt };
    enum class Event {
        opened,
        between,
        stale,
        closed,
        held,
        spoilt,
        released,
        superseded,
        dropped,
        finished
    };

    static const char* name(State s);
    static const char* name(Event e);

    void handle(const Context& c, Event event, const Refusal& refusal = {},
                CancelReason reason = CancelReason::none);
    std::optional<State> next(const Context& c, Event event, CancelReason reason);
    std::optional<State> away(const Context& c, Event event);
    std::optional<State> armed(const Context& c, Event event);
    std::optional<State> touching(const Context& c, Event event);
    std::optional<State> pinched(const Context& c, Event event, CancelReason reason);
    static std::optional<State> carried(Event event);
    std::optional<State> spoilt(const Context& c, Event event);

    [[nodiscard]] Event judge(const Context& c, double aperture_mm, Refusal& refusal) const;
    [[nodiscard]] Refusal spoiler(const Context& c) const;
    void send(const Context& c, EventPhase phase, CancelReason reason = CancelReason::none);

    State state_ = State::away;
    Reporter reporter_{"pinch"};
    Stamp open_at_;      ///< newest sample with the fingers apart, while armed or touching
    Stamp closed_at_;    ///< first sample with the fingers together
    Stamp onset_;        ///< of the pinch that is active
    Stamp aperture_at_;  ///< newest sample with a known aperture
    int gesture_id_ = -1;
    CancelReason broke_ = CancelReason::none;
};

}  // namespace xtrack::recognise
