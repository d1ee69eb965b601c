// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "gestures/recognise/step.hpp"

namespace xtrack::recognise {

/// Whether two forearms can belong to one body.
enum class SameBody { no, unknown, yes };
[[nodiscard]] SameBody same_body(const GestureSettings& s, const Hand& a, const Hand& b) noexcept;

/// What the session hears of one hand in a frame.
struct HandReport {
    const Hand* hand = nullptr;
    double speed_mmps = 0.0;
    bool present = false;  ///< it may act, and is not cut by the border
    bool summons = false;  ///< it has just waved, or was raised
    bool active = false;   ///< a gesture of it is, or has just been
};

enum class EngageState { idle, engaged };
enum class EngageEvent { waiting, summoned, owned, left, idle, lost, dropped, finished };

/// Whose session it is: the hand that engaged owns it until it disengages, a second one joins where
/// its forearm fits the same body, all others are bystanders. The diagram is in
/// docs/gestures/engage.md and in engagement.cpp.
class Engagement : public Machine<Engagement, EngageState, EngageEvent> {
 public:
    Engagement() : Machine("engage", State::idle) {}

    /// @param c of any hand; used for settings, time and events
    void update(const Context& c, std::span<const HandReport> hands);
    /// The owner is gone for good.
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

    /// A hand that waits to engage, or to join.
    struct Waiting {
        int hand_id = 0;  ///< 0: free
        Stamp since;
        bool still = false;
        bool tired = false;  ///< its session timed out: it must move first
        bool other = false;  ///< it was there when the owner was lost, so that it is not the owner
    };
    Waiting& waiting_of(int hand_id);
    const HandReport* summons(const Context& c, std::span<const HandReport> hands);
    /// The lost owner's hand under another id.
    [[nodiscard]] bool comes_back(const Context& c, const HandReport& r);
    void watch_owner(const Context& c, const HandReport* owner);
    void watch_second(const Context& c, std::span<const HandReport> hands, const HandReport* owner);
    void send(const Context& c, EventPhase phase, CancelReason reason = CancelReason::none) const;

    static constexpr std::size_t kWaiting = 2 * kMaxHands;
    std::array<Waiting, kWaiting> waiting_{};
    int owner_ = 0;
    int second_ = 0;
    Hand owner_hand_;
    Stamp onset_;
    Stamp inside_at_;  ///< the owner's last moment in the zone
    Stamp busy_at_;    ///< the owner's last deed
    Vec3f rest_mm_ = Vec3f::Zero();
    bool kept_ = false;  ///< for an owner that was lost
    Stamp kept_until_;
    int joining_ = 0;
    Stamp joining_since_;
    int gesture_id_ = -1;
    CancelReason reason_ = CancelReason::none;
};

}  // namespace xtrack::recognise
