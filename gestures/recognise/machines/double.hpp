// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "gestures/recognise/context.hpp"
#include "gestures/recognise/step.hpp"

namespace xtrack::recognise {

enum class DoubleState { none, once };
enum class DoubleEvent { one, late, dropped };

/// Two gestures of a kind shortly after each other. It is told of them by `hear`, and says so when
/// the second comes. The diagram is in docs/gestures/double.md and in double.cpp.
class DoubleMachine : public Machine<DoubleMachine, DoubleState, DoubleEvent> {
 public:
    DoubleMachine(const char* name, GestureType type)
        : Machine(name, DoubleState::none), type_(type) {}

    /// Of a pinch, which holds the hand while it is heard.
    static constexpr Rank kRank = Rank::grip;
    [[nodiscard]] bool wanted(const GestureSettings& s) const noexcept {
        return is_wanted(s, type_);
    }
    [[nodiscard]] bool sends(const GestureSettings& s) const noexcept { return wanted(s); }
    [[nodiscard]] bool holds() const noexcept { return false; }

    /// @param gesture_id of the newest single gesture; -1: none yet
    void hear(int gesture_id) noexcept { heard_ = gesture_id; }
    /// A new sample is in the history.
    void update(const Context& c);
    /// The hand was lost or came to the border.
    void drop(const Context& c, CancelReason reason, const char* why);
    void finish(const Context& /*c*/) {}

 private:
    friend Machine;
    using State = DoubleState;
    using Event = DoubleEvent;

    static const char* name(State s);
    static const char* name(Event e);

    std::optional<State> next(const Context& c, Event event);
    std::optional<State> none(const Context& c, Event event);
    std::optional<State> once(const Context& c, Event event);
    void commit(const Context& c);

    GestureType type_;
    int heard_ = -1;
    int known_ = -1;  ///< of what was heard
    Stamp first_at_;
};

}  // namespace xtrack::recognise
