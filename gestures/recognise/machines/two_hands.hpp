// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "gestures/recognise/step.hpp"

namespace xtrack::recognise {

/// Two hands of one person, as far as they grip.
struct TwoGrips {
    bool held = false;  ///< both do
    bool lost = false;  ///< one of those that did is not seen any more, or may not act
    CancelReason reason = CancelReason::lost;
    int hand_id = 0;
    int other_hand_id = 0;
    Vec3f palm_mm = Vec3f::Zero();
    Vec3f other_palm_mm = Vec3f::Zero();
};

enum class TwoHandState { apart, gripped, active };
enum class TwoHandEvent { held, moved, released, dropped, finished };

/// Zoom or rotation by two hands that pinch or grab. One of each a recogniser. The diagram is in
/// docs/gestures/two-hands.md and in two_hands.cpp.
class TwoHandMachine : public Machine<TwoHandMachine, TwoHandState, TwoHandEvent> {
 public:
    /// @param type two_hand_zoom or two_hand_rotate
    explicit TwoHandMachine(GestureType type)
        : Machine(to_string(type), State::apart), type_(type) {}

    /// Whether update() will begin: the hands are then taken from their own gestures first.
    [[nodiscard]] bool begins(const Context& c, const TwoGrips& grips) const;
    /// @param c of either hand
    void update(const Context& c, const TwoGrips& grips);
    void drop(const Context& c, CancelReason reason, const char* why);
    void finish(const Context& c);
    [[nodiscard]] bool holds() const noexcept { return state() == State::active; }

 private:
    friend Machine;
    using State = TwoHandState;
    using Event = TwoHandEvent;
    static const char* name(State s);
    static const char* name(Event e);

    std::optional<State> next(const Context& c, Event event);
    std::optional<State> apart(const Context& c, Event event);
    std::optional<State> gripped(const Context& c, Event event);
    std::optional<State> active(const Context& c, Event event);
    [[nodiscard]] double value_of(const TwoGrips& grips) const;
    [[nodiscard]] double way_of(const TwoGrips& grips) const;
    void send(const Context& c, EventPhase phase, CancelReason reason = CancelReason::none) const;

    GestureType type_;
    TwoGrips now_;
    TwoGrips first_;  ///< when both had closed
    double turn_deg_ = 0.0;
    Stamp gripped_at_;
    int gesture_id_ = -1;
    CancelReason reason_ = CancelReason::none;
};

}  // namespace xtrack::recognise
