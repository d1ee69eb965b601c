// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "gestures/recognise/context.hpp"
#include "gestures/recognise/step.hpp"

namespace xtrack::recognise {

enum class TapState { ready, bent };
enum class TapEvent { moving, bends, opens, late, astray, dropped };

/// One tap machine a hand. The diagram is in docs/gestures/tap.md and in tap.cpp.
class TapMachine : public Machine<TapMachine, TapState, TapEvent> {
 public:
    TapMachine() : Machine("tap", TapState::ready) {}

    static constexpr Rank kRank = Rank::stroke;
    [[nodiscard]] static bool sends(const GestureSettings& s) noexcept { return s.tap; }
    [[nodiscard]] static bool wanted(const GestureSettings& s) noexcept {
        return s.tap || s.double_tap;
    }
    [[nodiscard]] bool holds() const noexcept { return false; }
    /// Of the newest tap; -1: none yet.
    [[nodiscard]] int gesture_id() const noexcept { return gesture_id_; }

    /// A new sample is in the history.
    void update(const Context& c);
    /// The hand was lost, came to the border, or another gesture took it.
    void drop(const Context& c, CancelReason reason, const char* why);
    void finish(const Context& /*c*/) {}

 private:
    friend Machine;
    using State = TapState;
    using Event = TapEvent;

    /// The index at one moment.
    struct Bend {
        Stamp stamp;
        double deg = 0.0;
        std::size_t back = 0;  ///< of its sample, while no newer one has come
    };
    struct Press {
        bool of_open_hand = false;  ///< joints only
        Bend base;                  ///< before it bent
        Vec3f palm_mm = Vec3f::Zero();
        std::array<Flexion, kFingerCount> others{};
        double peak_deg = 0.0;
        std::array<Flexion, kFingerCount> others_at_peak{};
        double speed_degps = 0.0;
    };

    static const char* name(State s);
    static const char* name(Event e);

    std::optional<State> next(const Context& c, Event event);
    std::optional<State> ready(const Context& c, Event event);
    std::optional<State> bent(const Context& c, Event event);

    [[nodiscard]] Event look_for_press(const Context& c, double deg, double degps,
                                       Refusal& refusal);
    [[nodiscard]] Event follow_press(const Context& c, double deg, double degps, Refusal& refusal);
    [[nodiscard]] Refusal other_fingers(const Context& c) const;
    void commit(const Context& c);

    Press press_;
    Stamp not_before_;  ///< samples before it are not looked at: another had the hand
    int gesture_id_ = -1;
};

}  // namespace xtrack::recognise
