// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "gestures/recognise/context.hpp"
#include "gestures/recognise/machines/arc_path.hpp"
#include "gestures/recognise/step.hpp"

namespace xtrack::recognise {

enum class CircleState { waiting, winding, turning };
enum class CircleEvent { moving, winds, enough, unwinds, stale, dropped };

/// One circle machine a hand. The diagram is in docs/gestures/circle.md and in circle.cpp.
class CircleMachine : public Machine<CircleMachine, CircleState, CircleEvent> {
 public:
    CircleMachine() : Machine("circle", CircleState::waiting) {}

    static constexpr Rank kRank = Rank::rhythm;
    [[nodiscard]] static bool wanted(const GestureSettings& s) noexcept { return s.circle; }
    [[nodiscard]] static bool sends(const GestureSettings& s) noexcept { return wanted(s); }
    [[nodiscard]] bool holds() const noexcept { return false; }

    /// A new sample is in the history.
    void update(const Context& c);
    /// The hand was lost, came to the border, or another gesture took it.
    void drop(const Context& c, CancelReason reason, const char* why);
    void finish(const Context& /*c*/) {}
    /// It goes round: its strokes are no swipes.
    [[nodiscard]] bool swings() const noexcept { return state() != CircleState::waiting; }

 private:
    friend Machine;
    using State = CircleState;
    using Event = CircleEvent;
    enum Point : std::size_t { tip, palm, count };

    static const char* name(State s);
    static const char* name(Event e);

    std::optional<State> next(const Context& c, Event event);
    std::optional<State> waiting(const Context& c, Event event);
    std::optional<State> winding(const Context& c, Event event);
    std::optional<State> turning(const Context& c, Event event);

    void forget() noexcept;
    [[nodiscard]] Event look(const Context& c, Refusal& refusal);
    [[nodiscard]] Event follow(const Context& c, Refusal& refusal);
    [[nodiscard]] ArcPath::Limits limits(const GestureSettings& s) const noexcept;
    void commit(const Context& c);

    std::array<ArcPath, Point::count> paths_;
    Point point_ = palm;         ///< which of them goes round
    Arc arc_;                    ///< of it
    double turned_rad_ = 0.0;    ///< since its start, the way back taken off
    double farthest_rad_ = 0.0;  ///< that it came to
    int turns_ = 0;              ///< that have been sent
};

}  // namespace xtrack::recognise
