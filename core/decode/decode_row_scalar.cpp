// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>

#include "core/decode/arctangent.hpp"
#include "core/decode/decode_row.hpp"

namespace xtrack {
void decode_row_scalar(const DecodeRow& row) noexcept {
    const float least_power = row.min_modulation * row.min_modulation;
    for (int i = 0; i < row.count; ++i) {
        float re = 0.0F;
        float im = 0.0F;
        int brightest = 0;
        for (std::size_t n = 0; n < static_cast<std::size_t>(row.taps); ++n) {
            const int value = row.source[n][i];
            brightest = value > brightest ? value : brightest;
            re += row.re[n] * static_cast<float>(value);
            im += row.im[n] * static_cast<float>(value);
        }
        const float power = re * re + im * im;
        const bool good = power >= least_power && brightest < row.saturation_limit;
        row.phase_rad[i] = good ? arctangent2(im, re) : std::numeric_limits<float>::quiet_NaN();
        row.modulation[i] = good ? std::sqrt(power) : 0.0F;
    }
}

}  // namespace xtrack
