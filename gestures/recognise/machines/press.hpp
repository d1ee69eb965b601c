// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "gestures/recognise/step.hpp"

namespace xtrack::recognise {

enum class PressState { ready, pressed, carried, lifting };
enum class PressEvent { weak, down, strong, up, risen, late, superseded, dropped, finished };

/// A click in the air. The diagram is in docs/gestures/press.md and in press.cpp.
class PressMachine : public Machine<PressMachine, PressState, PressEvent> {
 public:
    static constexpr Rank kRank = Rank::press;
    [[nodiscard]] static bool wanted(const GestureSettings& s) noexcept { return s.press; }
    [[nodiscard]] static bool sends(const GestureSettings& s) noexcept { return wanted(s); }

    PressMachine() : Machine("press", State::ready) {}
    void update(const Context& c);
    void drop(const Context& c, CancelReason reason, const char* why);
    void finish(const Context& c);
    /// A drag goes on with the press: it is cancelled, and followed in silence until it is up.
    void carry(const Context& c);
    [[nodiscard]] bool holds() const noexcept { return state() == State::pressed; }
    /// It is down, whoever has the hand.
    [[nodiscard]] bool closed() const noexcept {
        return state() == State::pressed || state() == State::carried;
    }
    /// Why it last came up, if it was not lifted.
    [[nodiscard]] CancelReason broke() const noexcept { return broke_; }
    /// The virtual force, 0..1.
    [[nodiscard]] double force() const noexcept { return force_; }

 private:
    friend Machine;
    using State = PressState;
    using Event = PressEvent;
    static const char* name(State s);
    static const char* name(Event e);

    std::optional<State> next(const Context& c, Event event);
    std::optional<State> ready(const Context& c, Event event);
    std::optional<State> pressed(const Context& c, Event event);
    static std::optional<State> carried(Event event);
    static std::optional<State> lifting(Event event);

    void push_on(const Context& c);
    void let_up(const Context& c);
    [[nodiscard]] static Vec3f place_of(const Context& c);
    void send(const Context& c, EventPhase phase, CancelReason reason = CancelReason::none) const;

    double force_ = 0.0;
    Refusal refusal_;                   ///< why the force does not grow
    Vec3f deepest_mm_ = Vec3f::Zero();  ///< while it is down or lifted: the palm nearest the screen
    Stamp rising_since_;
    Stamp pressed_at_;
    int gesture_id_ = -1;
    CancelReason reason_ = CancelReason::none;
    CancelReason broke_ = CancelReason::none;
};

}  // namespace xtrack::recognise
