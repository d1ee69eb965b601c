// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "gestures/recognise/context.hpp"
#include "gestures/recognise/step.hpp"

namespace xtrack::recognise {

/// One wave machine a hand. The diagram is in docs/gestures/wave.md and in wave.cpp.
class WaveMachine {
 public:
    static constexpr Rank kRank = Rank::rhythm;
    static constexpr bool kSummons = true;  ///< it can take an idle session
    [[nodiscard]] static bool wanted(const GestureSettings& s) noexcept {
        return s.wave || (s.engage && s.engage_by_wave);
    }
    [[nodiscard]] static bool sends(const GestureSettings& s) noexcept { return s.wave; }
    [[nodiscard]] bool holds() const noexcept { return false; }

    /// A new sample is in the history.
    void update(const Context& c);
    /// The hand was lost, came to the border, or another gesture took it.
    void drop(const Context& c, CancelReason reason, const char* why);
    void finish(const Context& /*c*/) {}
    /// It went to and fro: its strokes are no swipes. One turn is a wind-up's as well.
    [[nodiscard]] bool swings() const noexcept {
        return state_ == State::recovering || count_ >= kSwings;
    }

 private:
    enum class State { waiting, swinging, recovering };
    enum class Event { turned, enough, moving, stale, still, dropped };

    /// Where the hand turned back.
    struct Turn {
        Stamp stamp;
        Vec3f palm_mm = Vec3f::Zero();
    };

    static const char* name(State s);
    static const char* name(Event e);

    void handle(const Context& c, Event event, const Refusal& refusal = {});
    std::optional<State> next(const Context& c, Event event);
    std::optional<State> waiting(const Context& c, Event event);
    std::optional<State> swinging(const Context& c, Event event);
    std::optional<State> recovering(const Context& c, Event event);

    void forget() noexcept;
    /// Follows the palm. True where it has turned back after a stroke that is long enough.
    bool follow(const Context& c, Refusal& refusal);
    void watch_rest(const Context& c);
    [[nodiscard]] bool rests(const Context& c) const;
    [[nodiscard]] Refusal off_axis(const Context& c) const;
    void commit(const Context& c);

    static constexpr std::size_t kMostTurns = 16;
    static constexpr std::size_t kSwings = 2;  ///< turns; the wind-up of a swipe has one
    State state_ = State::waiting;
    std::array<Turn, kMostTurns> turns_{};  ///< oldest first
    std::size_t count_ = 0;
    bool known_ = false;  ///< there is a stroke under way
    float sign_ = 0.0F;   ///< of it, along x; 0: not known yet
    Turn begin_;          ///< of the stroke
    Turn extreme_;        ///< the farthest of it
    Stamp still_since_;   ///< valid while `still_`
    bool still_ = false;
    Reporter reporter_{"wave"};
};

}  // namespace xtrack::recognise
