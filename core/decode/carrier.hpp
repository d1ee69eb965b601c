// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <xtrack/image.hpp>
#include <xtrack/result.hpp>

#include "core/decode/taps.hpp"

namespace xtrack {

/// Fourier transform profilometry: one grey image of fine fringes is a phase, because its
/// neighbours see the pattern's other phases (Takeda, Mutoh 1983, "Fourier transform profilometry
/// for the automatic measurement of 3-D object shapes"). The band-pass filter about the carrier is
/// a sum of taps as in every other method, only that they are shifted in space.

/// Shortest and longest fringe in the camera's image that this works with, px.
inline constexpr double kShortestCarrier_px = 4.0;
inline constexpr double kLongestCarrier_px = 30.0;

/// The fringe's period in an image, camera px, by the autocorrelation of some of its rows.
/// @param grey 8-bit image
/// @param down true: intensities change from row to row
/// @return 0 where no fringe of a usable period shows
/// @thread any; no allocation
[[nodiscard]] double find_carrier_px(ImageView<const std::uint8_t> grey, bool down) noexcept;

/// Taps for an image of one sine: a Hann window of two periods, of which the mean and the mirrored
/// frequency are taken out.
/// @param carrier_px from kShortestCarrier_px to kLongestCarrier_px; negative where the phase falls
///        with the pixel index
/// @param down true: taps are shifted along the rows' index
/// @param phase_rad the pattern's phase
/// @thread any; no allocation
[[nodiscard]] TapSet carrier_taps(double carrier_px, bool down, double phase_rad) noexcept;

}  // namespace xtrack
