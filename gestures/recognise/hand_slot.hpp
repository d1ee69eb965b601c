// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include <xtrack/hand.hpp>

#include "gestures/recognise/context.hpp"
#include "gestures/recognise/pinch.hpp"
#include "gestures/recognise/presence.hpp"
#include "gestures/recognise/push.hpp"
#include "gestures/recognise/swipe.hpp"
#include "gestures/recognise/wave.hpp"

namespace xtrack::recognise {

/// The gestures of one hand. Every machine has
///   - kRank, and wanted(settings): whether anybody needs it;
///   - update(c): a new sample is in the history;
///   - drop(c, reason, why): lost, taken, switched off: what is active is cancelled;
///   - finish(c): the stream is over: what is active ends;
///   - holds(): something is active;
///   - sends(settings): what it would send next is switched on.
struct Machines {
    PinchMachine pinch;
    WaveMachine wave;
    SwipeMachine swipe;
    PushMachine push;

    /// In the order of their turns: the strong before the weak, but rhythms before strokes, because
    /// a stroke that is part of a rhythm is none.
    template <typename Act>
    void each(const Act& act) {
        act(pinch);
        act(wave);
        act(swipe);
        act(push);
    }
};

/// A hand, what is known of it, and its gestures.
struct HandSlot {
    bool used = false;
    bool seen_now = false;
    Hand hand;  ///< as last seen
    Presence presence;
    MotionHistory history;
    Machines machines;

    void begin(const Hand& seen, Stamp now, bool in_view) {
        used = true;
        hand = seen;
        history.clear();
        machines = {};
        presence.appear(now, in_view);
    }

    void drop(const Context& c, CancelReason reason, const char* why) {
        machines.each([&](auto& machine) { machine.drop(c, reason, why); });
    }

    /// What is active and will not be wanted any more is cancelled.
    void switch_off(const Context& c, const GestureSettings& future) {
        machines.each([&](auto& machine) {
            if (machine.sends(c.settings) && !machine.sends(future)) {
                machine.drop(c, CancelReason::disengaged, "switched off");
            }
        });
    }

    void finish(const Context& c) {
        machines.each([&](auto& machine) { machine.finish(c); });
    }

    /// A gesture of this hand is active.
    [[nodiscard]] bool holds() {
        bool any = false;
        machines.each([&](const auto& machine) { any = any || machine.holds(); });
        return any;
    }

    /// The newest sample goes through all machines that are wanted.
    void update(Context& c) {
        Rank strongest = Rank::none;
        const void* holder = nullptr;
        const auto take = [&](const auto& machine) {
            if (machine.kRank < strongest) {
                strongest = machine.kRank;
                holder = &machine;
            }
        };
        machines.each([&](const auto& machine) {
            if (machine.holds()) {
                take(machine);
            }
        });
        machines.each([&](auto& machine) {
            if (!machine.wanted(c.settings)) {
                return;
            }
            const std::size_t before = c.out.all().size();
            c.taken =
                strongest < machine.kRank || (strongest == machine.kRank && holder != &machine);
            machine.update(c);
            if (machine.holds() || c.out.all().size() != before) {
                take(machine);
            }
            // A first stroke may become either; who has turned back twice does not swipe.
            if (machine.kRank == Rank::rhythm && machines.wave.swings()) {
                strongest = std::min(strongest, Rank::grip);
            }
        });
    }
};

}  // namespace xtrack::recognise
