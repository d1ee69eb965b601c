// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "gestures/recognise/context.hpp"
#include "gestures/recognise/step.hpp"

namespace xtrack::recognise {

/// One swipe machine a hand. The diagram is in docs/gestures/swipe.md and in swipe.cpp.
class SwipeMachine {
 public:
    static constexpr Rank kRank = Rank::stroke;
    [[nodiscard]] static bool wanted(const GestureSettings& s) noexcept { return s.swipe; }
    [[nodiscard]] bool holds() const noexcept { return false; }
    [[nodiscard]] static bool sends(const GestureSettings& s) noexcept { return wanted(s); }

    /// A new sample is in the history.
    void update(const Context& c);
    /// The hand was lost, came to the border, or another gesture took it: the candidate dies.
    void drop(const Context& c, CancelReason reason, const char* why);
    void finish(const Context& /*c*/) {}

 private:
    enum class State { waiting, stroking, coasting };
    enum class Event { fast, slow, astray, far_enough, moving, dropped };

    struct Stroke {
        Direction direction = Direction::none;
        Stamp start;
        Vec3f palm_mm = Vec3f::Zero();
        Vec3f tip_mm = Vec3f::Zero();
        bool tip_known = false;
        float peak_mmps = 0.0F;
        double speed_mmps = 0.0;  ///< mean, as far as it has come
        double length_mm = 0.0;
    };
    static const char* name(State s);
    static const char* name(Event e);

    void handle(const Context& c, Event event, const Refusal& refusal = {});
    std::optional<State> next(const Context& c, Event event);
    std::optional<State> waiting(const Context& c, Event event);
    std::optional<State> stroking(const Context& c, Event event);
    std::optional<State> coasting(const Context& c, Event event);

    [[nodiscard]] Event judge(const Context& c, const Vec3f& velocity, Refusal& refusal);
    [[nodiscard]] Refusal objection(const Context& c, bool stops) const;
    void begin_stroke(const Context& c, Direction direction);
    void commit(const Context& c);
    void note_rest(const Context& c, const Vec3f& velocity);
    void note_ready(const Context& c, const Vec3f& velocity);
    [[nodiscard]] bool comes_in(const Context& c, const Vec3f& velocity);
    [[nodiscard]] bool withdraws(const Vec3f& distal) const;

    State state_ = State::waiting;
    Stroke stroke_;
    Direction wanted_ = Direction::none;  ///< of the event `fast`
    Reporter reporter_{"swipe"};

    bool rested_since_ = true;  ///< slower than swipe_rest_mmps since the last commit
    Stroke last_;               ///< the one that committed, its peak as it went on; none at first
    Stamp committed_at_;
    bool ready_known_ = false;
    Vec3f ready_mm_ = Vec3f::Zero();     ///< where it is held up; strokes far below begin elsewhere
    bool coming_ = false;                ///< the motion began while the hand was gated
    Vec3f coming_mmps_ = Vec3f::Zero();  ///< how it moved when the gate opened; zero before
    Stamp drop_until_;  ///< samples before it are not looked at: the hand was gated
};

}  // namespace xtrack::recognise
