// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include <xtrack/phase_map.hpp>
#include <xtrack/result.hpp>

namespace xtrack {

/// What makes a phase wavy, by the harmonic that it adds.
/// @since 0.1
enum class RippleCause {
    none,        ///< no harmonic is worth mention
    brightness,  ///< 1st: images differ in brightness (flicker, auto exposure), or things moved
    steps,       ///< 2nd: phases are not those of the patterns (timing), or things moved evenly
    gamma,       ///< N-th of N steps: the projector's response is not the stated one
};

/// How wavy a phase is: amplitudes of its errors that repeat with the phase.
/// @since 0.1
struct PhaseRipple {
    double brightness_rad = 0.0;  ///< at the phase
    double steps_rad = 0.0;       ///< at twice the phase
    double gamma_rad = 0.0;       ///< at `steps` times the phase
    std::size_t pixels = 0;       ///< that were measured
};

/// Ripples below this are noise of the measurement or harmless, rad: 0.2 mm at a period of 32 px in
/// the rigs of the documentation.
inline constexpr double kWorthMention_rad = 0.015;

/// The largest ripple's cause; `none` below kWorthMention_rad.
/// @thread any
/// @since 0.1
[[nodiscard]] RippleCause cause_of(const PhaseRipple& ripple) noexcept;

/// Measures ripples where the phase runs on for more than a fringe, along the axis that it runs:
/// the phase minus its mean over the fringe around each pixel, against harmonics of the phase
/// (least squares). Needs no flat wall; curved surfaces cancel to first order.
/// @param steps images of a fringe, 3 ... 32
/// @return unsupported where too little of the image shows whole fringes side by side
/// @thread any
/// @since 0.1
[[nodiscard]] Result<PhaseRipple> measure_ripple(const PhaseMap& map, int steps);

/// The projector's gamma (light = value^gamma), from the fringes alone: that which leaves least
/// ripple at three times the phase when it is corrected (Guo, He, Zhu 2004 do it by the phase's
/// distribution, which asks for a flat wall and whole fringes).
/// @param map decoded without correction, that is with an unknown gamma or 1
/// @param phases_rad of the three patterns
/// @return unsupported as above, or for more steps, which hardly show gamma and hardly suffer from
///         it; invalid_argument for phases that give no taps
/// @thread any
/// @since 0.1
[[nodiscard]] Result<double> estimate_gamma(const PhaseMap& map,
                                            std::span<const double> phases_rad);

}  // namespace xtrack
