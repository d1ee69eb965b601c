// SPDX-License-Identifier: Apache-2.0
#include "gestures/recognise/hand_slot.hpp"

#include <algorithm>
#include <utility>

namespace xtrack::recognise {

namespace {

// 300 mm at a mean of 1.5 m/s with the least jerk begin with 43 m/s2; nobody is faster.
constexpr double kMostMmps2 = 55'000.0;
// Of three palms of a hand that is seen well, the largest error.
constexpr double kJumpNoiseMm = 20.0;

}  // namespace

void HandSlot::begin(const Hand& seen, Stamp now, bool in_view) {
    used = true;
    hand = seen;
    forget_motion();
    silence = {};
    machines = {};
    was_active = summons = jumped = is_bystander = false;
    size.forget();
    presence.appear(now, in_view);
}

void HandSlot::forget_motion() {
    history.clear();
    pointer.reset();
    meter = {};
}

void HandSlot::follow(Stamp now) noexcept {
    jumped = false;
    if (history.size() >= 2) {
        const MotionSample& last = history.at(0);
        const MotionSample& before = history.at(1);
        const double step_s = to_seconds(now - last.stamp);
        const double before_s = to_seconds(last.stamp - before.stamp);
        expected_mm =
            last.palm_mm + static_cast<float>(step_s / before_s) * (last.palm_mm - before.palm_mm);
        reach_mm =
            static_cast<float>(kJumpNoiseMm + 0.5 * kMostMmps2 * step_s * (step_s + before_s));
        jumped = (hand.palm_mm - expected_mm).norm() > reach_mm;
    }
    if (jumped) {
        size.forget();
    }
    size.add(hand, now);
}

bool HandSlot::add(Stamp now, Duration span) {
    MotionSample sample = sample_of(hand, now, span);
    sample.pointer_mm = pointer.filter(hand.palm_mm, now);
    if (!history.add(sample)) {
        return false;
    }
    meter.update(history);
    return true;
}

void HandSlot::drop(const Context& c, CancelReason reason, const char* why) {
    machines.each_and_drag([&](auto& machine) { machine.drop(c, reason, why); });
}

void HandSlot::switch_off(const Context& c, const GestureSettings& future) {
    machines.each_and_drag([&](auto& machine) {
        if (machine.sends(c.settings) && !machine.sends(future)) {
            machine.drop(c, CancelReason::disengaged, "switched off");
        }
    });
}

void HandSlot::finish(const Context& c) {
    machines.each_and_drag([&](auto& machine) { machine.finish(c); });
}

bool HandSlot::holds() {
    bool any = false;
    machines.each_and_drag([&](const auto& machine) { any = any || machine.holds(); });
    return any;
}

Grip HandSlot::fingers() const {
    if (machines.pinch.closed() || machines.grab.closed()) {
        return {true, machines.grab.closed(), CancelReason::none};
    }
    const CancelReason broke = machines.pinch.broke();
    return {false, false, broke != CancelReason::none ? broke : machines.grab.broke()};
}

Grip HandSlot::grip(const GestureSettings& s) const {
    Grip grip;
    const auto join = [&](bool wanted, const auto& machine, bool fist) {
        if (wanted && !grip.held) {
            grip.held = machine.closed();
            grip.fist = grip.held && fist;
            grip.broke = grip.held                          ? CancelReason::none
                         : grip.broke != CancelReason::none ? grip.broke
                                                            : machine.broke();
        }
    };
    join(s.press, machines.press, false);
    join(s.pinch, machines.pinch, false);
    join(s.grab, machines.grab, true);
    return grip;
}

void HandSlot::update(Context& c, bool two_handed) {
    Rank strongest = two_handed ? Rank::two_hands : Rank::none;
    const void* holder = nullptr;
    const auto take = [&](const auto& machine) {
        if (machine.kRank < strongest) {
            strongest = machine.kRank;
            holder = &machine;
        }
    };
    machines.each_and_drag([&](const auto& machine) {
        if (machine.holds()) {
            take(machine);
        }
    });
    const Gate gate = c.gate;
    const bool asked = std::exchange(is_bystander, gate == Gate::bystander);
    summons = false;
    const std::size_t first = c.out.all().size();
    machines.each([&]<typename M>(M& machine) {
        if (!machine.wanted(c.settings)) {
            return;
        }
        // A bystander may ask for the session, and is not heard otherwise.
        constexpr bool kSummons = requires { M::kSummons; };
        const bool asks = kSummons && gate == Gate::bystander;
        if (kSummons && asked && !asks) {
            machine.drop(c, CancelReason::none, "a session begins");  // it asked, that is all
        }
        const std::size_t before = c.out.all().size();
        const std::size_t muted = c.out.muted_count();
        c.gate = asks ? Gate::open : gate;
        c.taken = strongest < M::kRank || (strongest == M::kRank && holder != &machine);
        c.out.mute(asks);
        machine.update(c);
        machines.listen();
        c.out.mute(false);
        summons = summons || c.out.muted_count() != muted;
        if (machine.holds() || c.out.all().size() != before) {
            take(machine);
        }
        // A first stroke may become either; who has turned back twice, or gone round, does not
        // swipe.
        if constexpr (requires { machine.swings(); }) {
            if (machine.sends(c.settings) && machine.swings()) {
                strongest = std::min(strongest, Rank::grip);
            }
        }
    });
    c.gate = gate;
    if (c.settings.drag) {
        const Grip held = grip(c.settings);
        if (two_handed) {
            machines.drag.drop(c, CancelReason::superseded, "two hands do something else");
        } else {
            if (machines.drag.begins(c, held)) {
                machines.carry(c);
            }
            machines.drag.update(c, held);
        }
    }
    was_active = holds() || c.out.all().size() != first;
}

}  // namespace xtrack::recognise
