// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <complex>
#include <cstddef>
#include <cstdint>

#include "core/decode/decode_row.hpp"

namespace xtrack {

/// Images of one colour pattern that one row may combine.
inline constexpr std::size_t kMaxColourFrames = 4;

/// One row of the tap sum over the colour channels of images of one pattern:
/// z = sum_n turn_n sum_c tap_c(x) I_c(x). The taps differ from pixel to pixel, since they hold
/// what the surface does to the colours.
struct RgbRow {
    std::size_t frames = 0;
    std::array<const std::uint8_t*, kMaxColourFrames> bgr{};  ///< 3 * `count` bytes each
    std::array<std::complex<float>, kMaxColourFrames> turn{};
    std::array<const float*, 3> re{};  ///< by channel (blue, green, red): `count` floats
    std::array<const float*, 3> im{};
    int count = 0;                              ///< pixels
    float min_modulation = 0.0F;                ///< grey levels; below: masked
    int saturation_limit = kNoSaturationLimit;  ///< a channel >= this in any image is masked
    float* phase_rad = nullptr;                 ///< out: (-pi, pi], NaN where masked
    float* modulation = nullptr;                ///< out: grey levels, 0 where masked
};

/// Phase and modulation of one row by the fastest form this CPU has.
/// @thread any; rows are independent
/// @ownership borrows everything for the call
void rgb_row(const RgbRow& row) noexcept;

/// The reference form, plain C++.
void rgb_row_scalar(const RgbRow& row) noexcept;

#if XTRACK_WITH_HIGHWAY
void rgb_row_highway(const RgbRow& row) noexcept;
#endif

}  // namespace xtrack
