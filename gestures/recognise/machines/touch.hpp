// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "gestures/recognise/step.hpp"

namespace xtrack::recognise {

enum class TouchState { unseen, outside, touching };
enum class TouchEvent { outside, inside, dropped, finished };

/// A plane before the screen that is touched. The diagram is in docs/gestures/touch.md and in
/// touch.cpp.
class TouchMachine : public Machine<TouchMachine, TouchState, TouchEvent> {
 public:
    static constexpr Rank kRank = Rank::press;
    [[nodiscard]] static bool wanted(const GestureSettings& s) noexcept { return s.touch; }
    [[nodiscard]] static bool sends(const GestureSettings& s) noexcept { return wanted(s); }

    TouchMachine() : Machine("touch", State::unseen) {}
    void update(const Context& c);
    void drop(const Context& c, CancelReason reason, const char* why);
    void finish(const Context& c);
    [[nodiscard]] bool holds() const noexcept { return state() == State::touching; }
    /// 0 far from the plane .. 1 touching it.
    [[nodiscard]] double progress(const GestureSettings& s) const noexcept;

 private:
    friend Machine;
    using State = TouchState;
    using Event = TouchEvent;
    static const char* name(State s);
    static const char* name(Event e);

    std::optional<State> next(const Context& c, Event event);
    static std::optional<State> unseen(Event event);
    std::optional<State> outside(const Context& c, Event event);
    std::optional<State> touching(const Context& c, Event event);
    void send(const Context& c, EventPhase phase, CancelReason reason = CancelReason::none) const;

    Vec3f finger_mm_ = Vec3f::Zero();
    double distance_mm_ = 1e9;
    Stamp approached_;  ///< when it came nearer than touch_progress_mm
    int gesture_id_ = -1;
    CancelReason reason_ = CancelReason::none;
};

}  // namespace xtrack::recognise
