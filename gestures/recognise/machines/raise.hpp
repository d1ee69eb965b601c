// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "gestures/recognise/context.hpp"
#include "gestures/recognise/step.hpp"

namespace xtrack::recognise {

enum class RaiseState { moving, resting };
enum class RaiseEvent { moves, raised, rests, dropped };

/// One raise machine a hand. The diagram is in docs/gestures/raise.md and in raise.cpp.
class RaiseMachine : public Machine<RaiseMachine, RaiseState, RaiseEvent> {
 public:
    RaiseMachine() : Machine("raise", RaiseState::moving) {}

    static constexpr Rank kRank = Rank::stroke;
    static constexpr bool kSummons = true;  ///< it can take an idle session
    [[nodiscard]] static bool wanted(const GestureSettings& s) noexcept {
        return s.raise || (s.engage && s.engage_by_raise);
    }
    [[nodiscard]] static bool sends(const GestureSettings& s) noexcept { return s.raise; }
    [[nodiscard]] bool holds() const noexcept { return false; }

    /// A new sample is in the history.
    void update(const Context& c);
    /// The hand was lost, came to the border, or another gesture took it.
    void drop(const Context& c, CancelReason reason, const char* why);
    void finish(const Context& /*c*/) {}

 private:
    friend Machine;
    using State = RaiseState;
    using Event = RaiseEvent;

    struct Rise {
        Stamp start;
        double mm = 0.0;
        Refusal refusal;  ///< why it is none
    };

    static const char* name(State s);
    static const char* name(Event e);

    std::optional<State> next(const Context& c, Event event);
    std::optional<State> moving(const Context& c, Event event);
    std::optional<State> resting(const Context& c, Event event);

    [[nodiscard]] Rise measure(const Context& c) const;
    void commit(const Context& c);

    Rise rise_;
    Stamp not_before_;   ///< samples before it are not looked at: another had the hand
    Stamp still_since_;  ///< valid while `still_`
    bool still_ = false;
};

}  // namespace xtrack::recognise
