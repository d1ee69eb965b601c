// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "gestures/recognise/step.hpp"

namespace xtrack::recognise {

/// What a hand holds on with: closed pinch, grab or press.
struct Grip {
    bool held = false;
    bool fist = false;                        ///< a grab, which is sure enough to move at once
    CancelReason broke = CancelReason::none;  ///< why it was let go, if that was not meant
};

enum class DragState { empty, gripped, dragging };
enum class DragEvent { held, moved, released, dropped, finished };

/// A grip that moves. It takes the hand over from the pinch, grab or press that it came from, so
/// it has two steps: whether it begins is asked first. The diagram is in docs/gestures/drag.md and
/// in drag.cpp.
class DragMachine : public Machine<DragMachine, DragState, DragEvent> {
 public:
    static constexpr Rank kRank = Rank::press;
    [[nodiscard]] static bool wanted(const GestureSettings& s) noexcept { return s.drag; }
    [[nodiscard]] static bool sends(const GestureSettings& s) noexcept { return wanted(s); }

    DragMachine() : Machine("drag", State::empty) {}
    /// Whether the grip has moved far enough, so that update() will begin.
    [[nodiscard]] bool begins(const Context& c, const Grip& grip) const;
    void update(const Context& c, const Grip& grip);
    void drop(const Context& c, CancelReason reason, const char* why);
    void finish(const Context& c);
    [[nodiscard]] bool holds() const noexcept { return state() == State::dragging; }

 private:
    friend Machine;
    using State = DragState;
    using Event = DragEvent;
    static const char* name(State s);
    static const char* name(Event e);

    std::optional<State> next(const Context& c, Event event);
    std::optional<State> empty(const Context& c, Event event);
    std::optional<State> gripped(const Context& c, Event event);
    std::optional<State> dragging(const Context& c, Event event);
    [[nodiscard]] double moved_mm(const Context& c) const;
    void send(const Context& c, EventPhase phase, CancelReason reason = CancelReason::none) const;

    Vec3f gripped_mm_ = Vec3f::Zero();  ///< where it closed
    Stamp gripped_at_;
    int gesture_id_ = -1;
    CancelReason reason_ = CancelReason::none;
};

}  // namespace xtrack::recognise
