// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <xtrack/stamp.hpp>

#include "gestures/recognise/step.hpp"

namespace xtrack::recognise {

/// Is the hand there, and may it act? The diagram is in docs/gestures/hand.md and in presence.cpp.
/// Told what is seen; says what follows.
class Presence {
 public:
    enum class State { appearing, entering, present, frozen, lost, returning, gone };
    enum class Event { seen, unseen, settled, admitted, expired, forgotten };

    struct Times {
        Duration valid;
        Duration lockout;
        Duration freeze;
        Duration gone;
    };

    using Step = recognise::Step<State, Event>;

    /// A hand is seen for the first time. @param in_view it was there when the stream began
    void appear(Stamp now, bool in_view);
    /// What was followed until now was not the hand: one that enters begins to.
    void enter_anew(Stamp now) noexcept {
        if (state_ == State::appearing || state_ == State::entering) {
            first_seen_ = now;
        }
    }
    /// What time alone brings; call until it changes nothing.
    Step pass(const Times& times, Stamp now);
    Step see(Stamp now);
    Step miss(Stamp now);

    [[nodiscard]] State state() const noexcept { return state_; }
    /// Reported as a hand: begin was sent, end was not.
    [[nodiscard]] bool announced() const noexcept { return announced_; }
    /// Gestures may be followed (appearing hands are, so that they are known when they settle).
    [[nodiscard]] bool followed() const noexcept {
        return state_ == State::appearing || state_ == State::entering ||
               state_ == State::present || state_ == State::returning;
    }
    [[nodiscard]] bool may_act() const noexcept { return state_ == State::present; }
    [[nodiscard]] Stamp last_seen() const noexcept { return last_seen_; }

    static const char* name(State s);
    static const char* name(Event e);

 private:
    Step handle(Event event);
    std::optional<State> next(Event event);
    std::optional<State> appearing(Event event);
    std::optional<State> entering(Event event);
    std::optional<State> present(Event event);
    std::optional<State> frozen(Event event);
    std::optional<State> lost(Event event);
    std::optional<State> returning(Event event);
    std::optional<State> gone(Event event);

    State state_ = State::gone;
    State thawed_ = State::present;  ///< what frozen goes back to
    bool in_view_ = false;
    bool announced_ = false;
    Stamp first_seen_;
    Stamp seen_again_;
    Stamp last_seen_;
};

}  // namespace xtrack::recognise
