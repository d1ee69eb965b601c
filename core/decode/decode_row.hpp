// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/decode/taps.hpp"

namespace xtrack {

/// Saturation limit that masks nothing: no 8-bit pixel reaches it.
inline constexpr int kNoSaturationLimit = 256;

/// One row of the tap sum. Sources are already moved by the tap's shift.
struct DecodeRow {
    int taps = 0;
    std::array<const std::uint8_t*, kMaxTaps> source{};  ///< `count` grey pixels each
    std::array<float, kMaxTaps> re{};
    std::array<float, kMaxTaps> im{};
    int count = 0;                              ///< pixels
    float min_modulation = 0.0F;                ///< grey levels; below: masked
    int saturation_limit = kNoSaturationLimit;  ///< a pixel >= this in any image is masked
    float* phase_rad = nullptr;                 ///< out: (-pi, pi], NaN where masked
    float* modulation = nullptr;                ///< out: grey levels, 0 where masked
};

/// Phase and modulation of one row by the fastest form this CPU has.
/// @thread any; rows are independent
/// @ownership borrows everything for the call
void decode_row(const DecodeRow& row) noexcept;

/// The reference form, plain C++.
void decode_row_scalar(const DecodeRow& row) noexcept;

/// Instruction set that decode_row() runs on here, for reports: "AVX2", "scalar", ...
[[nodiscard]] const char* decode_instruction_set() noexcept;

#if XTRACK_WITH_HIGHWAY
void decode_row_highway(const DecodeRow& row) noexcept;
#endif

}  // namespace xtrack
