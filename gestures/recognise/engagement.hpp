// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "gestures/recognise/company.hpp"
#include "gestures/recognise/step.hpp"

namespace xtrack::recognise {

enum class EngageState { idle, engaged };
enum class EngageEvent { waiting, summoned, owned, left, idle, lost, dropped, finished };

/// Whose session it is: the hand that engaged owns it until it disengages, a second one joins where
/// it has fitted the same body for a while, all others are bystanders. The diagram is in
/// docs/gestures/engage.md and in engagement.cpp.
class Engagement : public Machine<Engagement, EngageState, EngageEvent> {
 public:
    Engagement() : Machine("engage", State::idle) {}

    /// @param c of any hand; used for settings, time and events
    void update(const Context& c, std::span<const HandReport> hands);
    /// A hand is gone.
    void lose(const Context& c, int hand_id);
    void drop(const Context& c, CancelReason reason, const char* why);
    void finish(const Context& c);

    [[nodiscard]] bool is_engaged() const noexcept { return state() == State::engaged; }
    [[nodiscard]] int owner() const noexcept { return is_engaged() ? owner_ : 0; }
    [[nodiscard]] bool is_in(int hand_id) const noexcept {
        return is_engaged() && (hand_id == owner_ || hand_id == second_);
    }

 private:
    friend Machine;
    using State = EngageState;
    using Event = EngageEvent;
    static const char* name(State s);
    static const char* name(Event e);
    std::optional<State> next(const Context& c, Event event);
    std::optional<State> idle(const Context& c, Event event);
    std::optional<State> engaged(const Context& c, Event event);

    const HandReport* summons(const Context& c, std::span<const HandReport> hands);
    /// The lost owner's hand, back.
    const HandReport* returned(const Context& c, std::span<const HandReport> hands);
    /// The owner's hand, where its tracker has given its id to another.
    const HandReport* mixed_up(const Context& c, std::span<const HandReport> hands,
                               const HandReport& owner, double ms);
    void hand_over(const Context& c, const HandReport& to);
    void watch_owner(const Context& c, const HandReport* owner);
    void watch_others(const Context& c, std::span<const HandReport> hands, double ms);
    [[nodiscard]] bool is_slow(const Context& c, const HandReport& r) const;
    void send(const Context& c, EventPhase phase, CancelReason reason = CancelReason::none) const;

    Company company_;
    int owner_ = 0;
    int second_ = 0;
    Hand owner_hand_;
    Arm owner_arm_;          ///< as it was when no other hand was near
    double other_ms_ = 0.0;  ///< so long the owner's id has looked like another hand
    Stamp onset_;
    Stamp inside_at_;  ///< the owner's last moment in the zone
    Stamp busy_at_;    ///< the owner's last deed
    Vec3f rest_mm_ = Vec3f::Zero();
    bool kept_ = false;  ///< for an owner that was lost
    Stamp kept_until_;
    int gesture_id_ = -1;
    CancelReason reason_ = CancelReason::none;
};

}  // namespace xtrack::recognise
