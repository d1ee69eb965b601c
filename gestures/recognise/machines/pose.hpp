// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "gestures/recognise/context.hpp"
#include "gestures/recognise/step.hpp"

namespace xtrack::recognise {

/// How well a hand shows a pose, 0..1: as well as the finger that fits it worst. 0 where too little
/// is known of it, and of types that are no poses.
[[nodiscard]] double pose_score(GestureType pose, const MotionSample& hand) noexcept;

enum class PoseState { away, shown, held };
enum class PoseEvent { fits, enough, wavers, gone, dropped, finished };

/// One pose of one hand. The diagram is in docs/gestures/poses.md and in pose.cpp.
class PoseMachine : public Machine<PoseMachine, PoseState, PoseEvent> {
 public:
    explicit PoseMachine(GestureType pose)
        : Machine(to_string(pose), PoseState::away), pose_(pose) {}

    static constexpr Rank kRank = Rank::pose;
    [[nodiscard]] bool wanted(const GestureSettings& s) const noexcept {
        return is_wanted(s, pose_);
    }
    [[nodiscard]] bool sends(const GestureSettings& s) const noexcept { return wanted(s); }
    [[nodiscard]] bool holds() const noexcept { return state() == PoseState::held; }

    /// A new sample is in the history.
    void update(const Context& c);
    /// The hand was lost, came to the border, or was taken: a pose that is held is cancelled.
    void drop(const Context& c, CancelReason reason, const char* why);
    /// The stream is over: a pose that is held ends.
    void finish(const Context& c);

 private:
    friend Machine;
    using State = PoseState;
    using Event = PoseEvent;

    static const char* name(State s);
    static const char* name(Event e);

    std::optional<State> next(const Context& c, Event event);
    std::optional<State> away(const Context& c, Event event);
    std::optional<State> shown(const Context& c, Event event);
    std::optional<State> held(const Context& c, Event event);

    [[nodiscard]] Event judge(const Context& c, Refusal& refusal);
    void send(const Context& c, EventPhase phase);

    GestureType pose_;
    CancelReason reason_ = CancelReason::none;  ///< of the cancel that is on its way
    double score_ = 0.0;
    Stamp shown_at_;  ///< while shown
    Stamp fits_at_;   ///< while held: the newest sample that was good enough
    Stamp onset_;
    int gesture_id_ = -1;
};

}  // namespace xtrack::recognise
