// SPDX-License-Identifier: Apache-2.0
#include "gestures/recognise/machines/stroke_manner.hpp"

#include <cmath>

namespace xtrack::recognise {

namespace {

constexpr double kShownFacing = 0.7;  // palm toward the screen, 45 degrees
// What a camera sees of a hand faces up or down, 30 degrees: it lies over something, or reaches.
constexpr float kLiesFlat = 0.5F;

}  // namespace

Manner manner_of(const GestureSettings& s, const Carriage& held, bool from_joints,
                 bool level) noexcept {
    const double outer = held.extension.outer;
    if (from_joints && outer >= 0.0 && outer < s.swipe_pointing_extension) {
        return Manner::pointing;
    }
    // Sideways a palm leads or shows itself to the screen on purpose; up and down it does so
    // whenever a hand is raised or dropped, unless it is held up flat.
    const bool shows = !held.facing_known || held.shown >= kShownFacing;
    if (!level) {
        return shows && held.is_upright() ? Manner::guarded : Manner::carried;
    }
    if (held.leads >= s.swipe_facing) {
        return Manner::paddle;
    }
    if (held.leads <= -s.swipe_facing) {
        return Manner::guarded;
    }
    const bool lies = !held.facing_known && std::abs(held.side.y()) >= kLiesFlat;
    return shows && !lies ? Manner::plain : Manner::carried;
}

Least least_of(const GestureSettings& s, Manner manner) noexcept {
    switch (manner) {
        case Manner::paddle: return {s.swipe_length_mm, s.swipe_paddle_speed_mmps};
        case Manner::plain: return {s.swipe_length_mm, s.swipe_speed_mmps};
        case Manner::guarded: return {s.swipe_back_length_mm, s.swipe_back_speed_mmps};
        case Manner::carried:
            return {s.swipe_carried_length_mm, s.swipe_carried_speed_mmps,
                    "short for a carried hand", "slow for a carried hand"};
        case Manner::pointing:
            return {s.swipe_carried_length_mm, s.swipe_carried_speed_mmps,
                    "short for a pointing hand", "slow for a pointing hand"};
    }
    return {};
}

}  // namespace xtrack::recognise
