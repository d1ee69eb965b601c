// SPDX-License-Identifier: Apache-2.0
#include "core/unwrap/gray_code.hpp"

#include <cstdlib>
#include <limits>

namespace xtrack {

std::uint32_t cell_of_gray(std::uint32_t code) noexcept {
    for (std::uint32_t shift = 1; shift < 32U; shift *= 2U) {
        code ^= code >> shift;
    }
    return code;
}

void gray_code_row_scalar(const GrayRow& row) noexcept {
    constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
    const bool flats = row.white != nullptr && row.black != nullptr;
    const auto cell = static_cast<float>(row.cell_px);
    // Cell c spans c cell - 0.5 ... (c + 1) cell - 0.5 of the pixel index, less the offset.
    const auto origin = static_cast<float>(-0.5 - row.offset_px);
    for (int i = 0; i < row.count; ++i) {
        // Twice the grey levels throughout, so that the mean of white and black stays whole.
        const int span = flats ? 2 * (row.white[i] - row.black[i]) : 0;
        const int middle = flats ? row.white[i] + row.black[i] : 0;
        std::uint32_t code = 0;
        int brightest = 0;
        float least_certain = std::numeric_limits<float>::infinity();
        std::uint32_t least_certain_bit = 0;
        int amplitude2 = flats ? span / 2 : std::numeric_limits<int>::max();
        for (int b = 0; b < row.bits; ++b) {
            const auto n = static_cast<std::size_t>(b);
            const int value = row.image[n][i];
            const bool inverted = row.inverse[n] != nullptr;
            const int difference = inverted ? 2 * (value - row.inverse[n][i]) : 2 * value - middle;
            const std::uint32_t mask = 1U << static_cast<unsigned>(row.bits - 1 - b);
            code |= difference > 0 ? mask : 0U;
            brightest = value > brightest ? value : brightest;
            if (!flats) {
                const int half = std::abs(difference) / 2;
                amplitude2 = half < amplitude2 ? half : amplitude2;
            }
            // A difference of two images swings twice as far as one from its mean.
            const float certainty =
                static_cast<float>(std::abs(difference)) * (inverted ? 0.5F : 1.0F);
            if (certainty < least_certain) {
                least_certain = certainty;
                least_certain_bit = mask;
            }
        }
        const float modulation = 0.5F * static_cast<float>(amplitude2);
        const std::uint32_t c = cell_of_gray(code);
        float position = static_cast<float>(c) + 0.5F;
        bool good = modulation >= row.min_modulation && brightest < row.saturation_limit;
        if (flats && least_certain < row.edge_guard * static_cast<float>(span)) {
            const std::uint32_t other = cell_of_gray(code ^ least_certain_bit);
            if (other + 1U == c || c + 1U == other) {
                position = row.centre_only ? position : static_cast<float>(c > other ? c : other);
            } else {
                good = false;
            }
        }
        row.coordinate_px[i] = good ? position * cell + origin : kNone;
        row.modulation[i] = good ? modulation : 0.0F;
    }
}

#if XTRACK_WITH_HIGHWAY
void gray_code_row(const GrayRow& row) noexcept { gray_code_row_highway(row); }
#else
void gray_code_row(const GrayRow& row) noexcept { gray_code_row_scalar(row); }
#endif

}  // namespace xtrack
