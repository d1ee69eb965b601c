// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "gestures/recognise/context.hpp"

namespace xtrack::recognise {

/// What one event changed.
template <typename State, typename Event>
struct Step {
    State before;
    State after;
    Event event;
    bool possible = true;
};

/// The shape of every machine here: one function a state, which returns the next state, or nothing
/// for an event that it should never see. Such an event changes nothing and is reported.
template <typename State, typename Event>
Step<State, Event> step(State& state, Event event, std::optional<State> next) {
    const Step<State, Event> done{state, next.value_or(state), event, next.has_value()};
    state = done.after;
    return done;
}

/// What one gesture of one hand tells the log: transitions, impossible events, and each refusal
/// once, however many frames it lasts.
class Reporter {
 public:
    explicit Reporter(const char* machine) : machine_(machine) {}

    /// @param name overloads for the machine's states and events
    template <typename State, typename Event, typename Name>
    void report(const Context& c, const Step<State, Event>& s, const Refusal& refusal, Name name) {
        const bool news = refusal.why != last_why_ && *refusal.why != '\0';
        if (s.before != s.after || !s.possible || news) {
            c.log.write({c.sensor, c.hand.id, machine_, name(s.before), name(s.event),
                         name(s.after), refusal.why, refusal.measured, refusal.limit, !s.possible});
        }
        last_why_ = refusal.why;
    }

 private:
    const char* machine_;
    const char* last_why_ = "";
};

/// What all machines of one hand have: `Self` gives `next(c, event)`, which asks the function of
/// the state that the machine is in, and `name()` of states and events.
template <typename Self, typename State, typename Event>
class Machine {
 protected:
    Machine(const char* name, State first) : state_(first), reporter_(name) {}

    void handle(const Context& c, Event event, const Refusal& refusal = {}) {
        reporter_.report(c, step(state_, event, static_cast<Self*>(this)->next(c, event)), refusal,
                         [](auto of) { return Self::name(of); });
    }
    [[nodiscard]] State state() const noexcept { return state_; }

 private:
    State state_;
    Reporter reporter_;
};

}  // namespace xtrack::recognise
