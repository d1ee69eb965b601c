// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "gestures/recognise/step.hpp"

namespace xtrack::recognise {

enum class DwellState { moving, filling, spent };
enum class DwellEvent { still, moving, filled, left, dropped };

/// A hand that stays. The diagram is in docs/gestures/dwell.md and in dwell.cpp.
class DwellMachine : public Machine<DwellMachine, DwellState, DwellEvent> {
 public:
    static constexpr Rank kRank = Rank::dwell;
    [[nodiscard]] static bool wanted(const GestureSettings& s) noexcept { return s.dwell; }
    [[nodiscard]] static bool sends(const GestureSettings& s) noexcept { return wanted(s); }

    DwellMachine() : Machine("dwell", State::moving) {}
    void update(const Context& c);
    void drop(const Context& c, CancelReason reason, const char* why);
    void finish(const Context& c);
    [[nodiscard]] bool holds() const noexcept { return state() == State::filling; }

 private:
    friend Machine;
    using State = DwellState;
    using Event = DwellEvent;
    static const char* name(State s);
    static const char* name(Event e);

    std::optional<State> next(const Context& c, Event event);
    std::optional<State> moving(const Context& c, Event event);
    std::optional<State> filling(const Context& c, Event event);
    static std::optional<State> spent(Event event);

    [[nodiscard]] bool is_still(const Context& c, Refusal& refusal) const;
    void send(const Context& c, EventPhase phase, CancelReason reason = CancelReason::none) const;

    Vec3f anchor_mm_ = Vec3f::Zero();  ///< where it stays, or stayed last
    Stamp begun_;
    Stamp onset_;
    Stamp not_before_;  ///< samples before it are not looked at: the hand was gated
    int gesture_id_ = -1;
    CancelReason reason_ = CancelReason::none;
};

}  // namespace xtrack::recognise
