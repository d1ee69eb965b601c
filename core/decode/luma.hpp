// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace xtrack {

/// Luma of a row of BGR pixels (Rec. 601 weights, as image libraries use): grey patterns seen by
/// a colour camera.
/// @param bgr 3 * count bytes
/// @param grey count bytes, out
void luma_row(const std::uint8_t* bgr, int count, std::uint8_t* grey) noexcept;

}  // namespace xtrack
