// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include <xtrack/result.hpp>

namespace xtrack {

/// Images that one tap sum may combine.
inline constexpr int kMaxTaps = 32;

/// One term of z = sum c_n I_n[p + s_n].
struct Tap {
    float re = 0.0F;  ///< c_n
    float im = 0.0F;
    int dx = 0;  ///< s_n, px of the camera image
    int dy = 0;
};

/// The whole sum: z = B e^{i phi}, phi the projector phase, B the fringe's amplitude.
struct TapSet {
    int count = 0;
    std::array<Tap, kMaxTaps> taps{};

    /// Noise of the phase: sigma_phi = noise_gain() * sigma_I / B (rad).
    [[nodiscard]] double noise_gain() const noexcept;
};

/// The named designs; each is the polynomial in u = e^{iw} whose zeros are listed.
enum class TapDesign {
    three,           ///< 0, -w0: the plain three-step method
    three_plus_one,  ///< 0, -w0 twice: linear detuning removed
    three_plus_two,  ///< 0 twice, -w0 twice: linear drift of the background removed as well
    four,            ///< 0, -w0, pi
    four_plus_one,   ///< 0, -w0 twice, pi (Hariharan)
};

/// Images that a design combines.
[[nodiscard]] int tap_count(TapDesign design) noexcept;

/// Taps for images taken in equal steps of phase, oldest first.
///
/// The frequency response H(w) = sum c_n e^{inw} has the design's zeros and H(w0) = 2, so that the
/// response to B cos(phi + n w0) is B e^{i phi} (Servin, Estrada, Quiroga 2009, "The general theory
/// of phase shifting algorithms").
/// @param step_rad w0, the phase from one image to the next; any sign, not a multiple of pi
/// @param first_phase_rad the pattern's phase of the first image, which makes the result
///        independent of where in the cycle the window starts
/// @return invalid_argument when the zeros coincide with w0
/// @thread any
[[nodiscard]] Result<TapSet> design_taps(TapDesign design, double step_rad, double first_phase_rad);

/// Taps for images of any phases, in any order, by least squares on A + B cos(phi + phase).
/// Equal steps give 2/N e^{-i phase}; sigma_phi = sqrt(2/N) sigma_I / B.
/// @param phases_rad 3 ... kMaxTaps pattern phases
/// @return invalid_argument when there are too few, too many, or they do not determine A and B
/// @thread any
[[nodiscard]] Result<TapSet> least_squares_taps(std::span<const double> phases_rad);

/// The same without allocation or message, for phases that change from frame to frame.
/// @return false, and `set` untouched, where least_squares_taps() would fail
[[nodiscard]] bool fit_taps(std::span<const double> phases_rad, TapSet& set) noexcept;

}  // namespace xtrack
