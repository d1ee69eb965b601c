// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "gestures/recognise/context.hpp"
#include "gestures/recognise/step.hpp"

namespace xtrack::recognise {

enum class GrabState { away, armed, closing, grabbed, carried, spoilt };
enum class GrabEvent {
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

/// One grab machine a hand. The diagram is in docs/gestures/grab.md and in grab.cpp.
class GrabMachine : public Machine<GrabMachine, GrabState, GrabEvent> {
 public:
    GrabMachine() : Machine("grab", GrabState::away) {}

    static constexpr Rank kRank = Rank::grip;
    [[nodiscard]] static bool sends(const GestureSettings& s) noexcept { return s.grab; }
    [[nodiscard]] static bool wanted(const GestureSettings& s) noexcept {
        return s.grab || s.two_hand_zoom || s.two_hand_rotate;
    }

    /// A new sample is in the history.
    void update(const Context& c);
    /// The hand was lost, came to the border, or was taken: an active grab is cancelled.
    void drop(const Context& c, CancelReason reason, const char* why);
    /// The stream is over: an active grab ends.
    void finish(const Context& c);

    /// A stronger gesture goes on with the closed hand: the grab is cancelled, and followed in
    /// silence until the hand opens.
    void carry(const Context& c);

    [[nodiscard]] bool holds() const noexcept { return state() == GrabState::grabbed; }
    /// Why it last came open, if it was not opened.
    [[nodiscard]] CancelReason broke() const noexcept { return broke_; }
    /// The hand is closed, whoever has it.
    [[nodiscard]] bool closed() const noexcept {
        return state() == GrabState::grabbed || state() == GrabState::carried;
    }

 private:
    friend Machine;
    using State = GrabState;
    using Event = GrabEvent;

    static const char* name(State s);
    static const char* name(Event e);

    std::optional<State> next(const Context& c, Event event);
    std::optional<State> away(const Context& c, Event event);
    std::optional<State> armed(const Context& c, Event event);
    std::optional<State> closing(const Context& c, Event event);
    std::optional<State> grabbed(const Context& c, Event event);
    static std::optional<State> carried(Event event);
    std::optional<State> spoilt(const Context& c, Event event);

    [[nodiscard]] Event judge(const Context& c, double strength, Refusal& refusal) const;
    [[nodiscard]] Refusal spoiler(const Context& c) const;
    void send(const Context& c, EventPhase phase);

    CancelReason reason_ = CancelReason::none;  ///< of the cancel that is on its way
    CancelReason broke_ = CancelReason::none;
    Stamp open_at_;    ///< newest sample with the hand open
    Stamp closed_at_;  ///< first sample with the hand closed
    Stamp onset_;      ///< of the grab that is active
    Stamp known_at_;   ///< newest sample whose strength is known
    double strength_ = 0.0;
    int gesture_id_ = -1;
};

}  // namespace xtrack::recognise
