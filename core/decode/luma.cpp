// SPDX-License-Identifier: Apache-2.0
#include "core/decode/luma.hpp"

#include <cstddef>

namespace xtrack {

void luma_row(const std::uint8_t* bgr, int count, std::uint8_t* grey) noexcept {
    // 0.114, 0.587, 0.299 in 1/65536; they sum to exactly 65536, so white stays 255.
    constexpr std::uint32_t kBlue = 7471;
    constexpr std::uint32_t kGreen = 38470;
    constexpr std::uint32_t kRed = 19595;
    constexpr std::uint32_t kHalf = 1U << 15U;
    for (int i = 0; i < count; ++i) {
        const std::uint8_t* p = bgr + static_cast<std::ptrdiff_t>(3) * i;
        grey[i] =
            static_cast<std::uint8_t>((kBlue * p[0] + kGreen * p[1] + kRed * p[2] + kHalf) >> 16U);
    }
}

}  // namespace xtrack
