// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include <xtrack/pattern.hpp>

namespace xtrack {

/// One row of a Gray code, most significant bit first.
///
/// A bit is set where its image is brighter than its reference: the mean of the white and black
/// images, or, where the sequence has them, the image of the inverted bit. On the edge between two
/// cells one bit, and only one, is uncertain. Where the least certain bit is within `edge_guard` of
/// its threshold and flipping it leads to the neighbouring cell, the coordinate is put on the edge
/// the two share: the order of a phase period that begins there is then nearest without doubt.
/// Where flipping leads elsewhere, the pixel mixes two surfaces and is masked.
struct GrayRow {
    int count = 0;  ///< pixels
    int bits = 0;   ///< 1 ... kMaxGrayBits
    std::array<const std::uint8_t*, kMaxGrayBits> image{};
    std::array<const std::uint8_t*, kMaxGrayBits> inverse{};  ///< null: use white and black
    const std::uint8_t* white = nullptr;                      ///< may be null if all have inverses
    const std::uint8_t* black = nullptr;
    double cell_px = 0.0;
    double offset_px = 0.0;
    float min_modulation = 0.0F;  ///< grey levels, half of white - black; below: masked
    int saturation_limit = 256;   ///< applies to the bits, not to white, which may clip unharmed
    /// Share of white - black around the threshold where a bit counts as uncertain, 0 ... 0.5.
    float edge_guard = 0.0F;
    /// True: the cell's centre also on edges, for a code that has no phase to refine it.
    bool centre_only = false;
    float* coordinate_px = nullptr;  ///< out: projector px, NaN = none
    float* modulation = nullptr;     ///< out: grey levels, 0 where masked
};

/// @thread any; rows are independent
/// @ownership borrows everything for the call
void gray_code_row(const GrayRow& row) noexcept;

/// The reference form, plain C++.
void gray_code_row_scalar(const GrayRow& row) noexcept;

#if XTRACK_WITH_HIGHWAY
void gray_code_row_highway(const GrayRow& row) noexcept;
#endif

/// Number of the cell that a reflected binary code word names.
[[nodiscard]] std::uint32_t cell_of_gray(std::uint32_t code) noexcept;

}  // namespace xtrack
