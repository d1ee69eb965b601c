// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "gestures/recognise/step.hpp"

namespace xtrack::recognise {

enum class SilenceState { open, closing, silent };
enum class SilenceEvent { open, closed, held, busy };

/// A fist says nothing, where a fist means nothing else. The diagram is in docs/gestures/hand.md
/// and in silence.cpp.
class Silence : public Machine<Silence, SilenceState, SilenceEvent> {
 public:
    Silence() : Machine("silence", State::open) {}
    /// @param active a gesture of the hand is
    void update(const Context& c, bool active);
    [[nodiscard]] bool is_silent() const noexcept { return state() == State::silent; }

 private:
    friend Machine;
    using State = SilenceState;
    using Event = SilenceEvent;
    static const char* name(State s);
    static const char* name(Event e);
    std::optional<State> next(const Context& c, Event event);
    std::optional<State> open(const Context& c, Event event);
    static std::optional<State> closing(Event event);
    static std::optional<State> silent(Event event);

    Stamp closed_at_;
};

}  // namespace xtrack::recognise
