// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "gestures/recognise/motion_history.hpp"

namespace xtrack::recognise {

/// Mean extensions in `count` samples from `back` on, 0..1; -1 = not known.
struct Extensions {
    double index = -1.0;
    double outer = -1.0;  ///< of middle, ring and little finger
    double all = -1.0;    ///< of the four
};
[[nodiscard]] Extensions extensions_in(const MotionHistory& history, std::size_t back,
                                       std::size_t count) noexcept;

/// How a hand was held, and which way it went, on average over the newest samples.
struct Carriage {
    /// Unit, toward the fingertips; zero = not known.
    Vec3f distal = Vec3f::Zero();
    /// Unit, out of the side that is seen; zero = not known.
    Vec3f side = Vec3f::Zero();
    bool facing_known = false;
    /// Of the palm's direction: along the stroke, and toward the screen. -1..1; where the side of
    /// the palm is not known, 0..1. @{
    double leads = 0.0;
    double shown = 0.0;
    /// @}
    Extensions extension;
    double grab = -1.0;  ///< 0..1 a fist; -1 = known in less than half of the samples
    /// By how much the way turned from its begin to its end, were it an arc; x-y plane, not
    /// negative. It is measured on the area between way and chord, so that noise cancels.
    double bend_deg = 0.0;

    /// A flat hand with its fingers up.
    [[nodiscard]] bool is_upright() const noexcept;
};

/// @param samples the newest of the history, at least 1
/// @param along unit, of the stroke
[[nodiscard]] Carriage carriage(const MotionHistory& history, std::size_t samples,
                                const Vec3f& along) noexcept;

}  // namespace xtrack::recognise
