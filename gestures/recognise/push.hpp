// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gestures/recognise/context.hpp"

namespace xtrack::recognise {

/// One push machine a hand. The diagram is in docs/gestures/push.md and in push.cpp.
class PushMachine {
 public:
    /// A new sample is in the history.
    void update(const Context& c);
    /// The hand was lost, came to the border, or another gesture took it.
    void drop(const Context& c, const char* why);

 private:
    enum class State { waiting, recovering };
    enum class Event { thrust, moving, stable, dropped };

    struct Thrust {
        Stamp start;
        double speed_mmps = 0.0;
        const char* why_not = "";
        double measured = 0.0;
        double limit = 0.0;
    };

    static const char* name(State s);
    static const char* name(Event e);

    void handle(const Context& c, Event event, const char* why = "", double measured = 0.0,
                double limit = 0.0);
    State waiting(const Context& c, Event event, bool& possible);
    State recovering(const Context& c, Event event, bool& possible);

    [[nodiscard]] Thrust measure(const Context& c) const;
    void commit(const Context& c);

    State state_ = State::waiting;
    Thrust thrust_;
    const char* last_why_ = "";
    Stamp not_before_;    ///< samples before it are not looked at: the hand was gated
    Stamp stable_since_;  ///< valid while `slow_`
    bool slow_ = false;
};

}  // namespace xtrack::recognise
