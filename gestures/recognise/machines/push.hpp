// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "gestures/recognise/context.hpp"
#include "gestures/recognise/step.hpp"

namespace xtrack::recognise {

/// Pushes and pulls of one hand, in one machine, because the way back from one is the way of the
/// other. The diagram is in docs/gestures/push.md and in push.cpp.
class PushMachine {
 public:
    static constexpr Rank kRank = Rank::stroke;
    [[nodiscard]] static bool wanted(const GestureSettings& s) noexcept { return s.push || s.pull; }
    [[nodiscard]] bool holds() const noexcept { return false; }
    [[nodiscard]] static bool sends(const GestureSettings& s) noexcept { return wanted(s); }

    /// A new sample is in the history.
    void update(const Context& c);
    /// The hand was lost, came to the border, or another gesture took it.
    void drop(const Context& c, CancelReason reason, const char* why);
    void finish(const Context& /*c*/) {}

 private:
    enum class State { waiting, recovering };
    enum class Event { thrust, moving, stable, dropped };

    struct Thrust {
        GestureType type = GestureType::push;
        Stamp start;
        double speed_mmps = 0.0;
        Refusal refusal;  ///< why it is none
    };

    static const char* name(State s);
    static const char* name(Event e);

    void handle(const Context& c, Event event, const Refusal& refusal = {});
    std::optional<State> next(const Context& c, Event event);
    std::optional<State> waiting(const Context& c, Event event);
    std::optional<State> recovering(const Context& c, Event event);

    [[nodiscard]] Thrust measure(const Context& c) const;
    [[nodiscard]] bool brings_back(const Context& c, const Thrust& thrust) const;
    void commit(const Context& c);

    State state_ = State::waiting;
    Thrust thrust_;
    Thrust last_;    ///< the one that committed, its speed the fastest that it came to
    Stamp last_at_;  ///< when that was fast for the last time
    Reporter reporter_{"push"};
    Stamp not_before_;    ///< samples before it are not looked at: the hand was gated
    Stamp stable_since_;  ///< valid while `slow_`
    bool slow_ = false;
};

}  // namespace xtrack::recognise
