// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <xtrack/gesture_settings.hpp>

#include "gestures/recognise/machines/carriage.hpp"

namespace xtrack::recognise {

/// How a hand is held in a stroke, the table of docs/gestures/swipe.md.
enum class Manner {
    paddle,   ///< the palm leads
    plain,    ///< the palm is shown, or nothing is known
    guarded,  ///< the back leads, or up or down held up flat: as hands come back and are raised,
              ///< too
    carried,
    pointing,
};

/// @param level a stroke to the left or right
[[nodiscard]] Manner manner_of(const GestureSettings& settings, const Carriage& held,
                               bool from_joints, bool level) noexcept;

/// What a stroke has to have at least, and the words for one that has less.
struct Least {
    double mm = 0.0;
    double mmps = 0.0;
    const char* shorter = "short";
    const char* slower = "slow";
};

[[nodiscard]] Least least_of(const GestureSettings& settings, Manner manner) noexcept;

}  // namespace xtrack::recognise
