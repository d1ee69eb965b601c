// SPDX-License-Identifier: Apache-2.0
#include "core/decode/rgb_row.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/decode/arctangent.hpp"

namespace xtrack {

void rgb_row_scalar(const RgbRow& row) noexcept {
    const float least_power = row.min_modulation * row.min_modulation;
    for (int i = 0; i < row.count; ++i) {
        float re = 0.0F;
        float im = 0.0F;
        int brightest = 0;
        for (std::size_t n = 0; n < row.frames; ++n) {
            const std::uint8_t* pixel = row.bgr[n] + static_cast<std::ptrdiff_t>(3) * i;
            float frame_re = 0.0F;
            float frame_im = 0.0F;
            for (std::size_t c = 0; c < 3; ++c) {
                brightest = std::max<int>(brightest, pixel[c]);
                frame_re += row.re[c][i] * static_cast<float>(pixel[c]);
                frame_im += row.im[c][i] * static_cast<float>(pixel[c]);
            }
            const float turn_re = row.turn[n].real();
            const float turn_im = row.turn[n].imag();
            re += turn_re * frame_re - turn_im * frame_im;
            im += turn_re * frame_im + turn_im * frame_re;
        }
        const float power = re * re + im * im;
        const bool good = power >= least_power && brightest < row.saturation_limit;
        row.phase_rad[i] = good ? arctangent2(im, re) : std::numeric_limits<float>::quiet_NaN();
        row.modulation[i] = good ? std::sqrt(power) : 0.0F;
    }
}

#if XTRACK_WITH_HIGHWAY
void rgb_row(const RgbRow& row) noexcept { rgb_row_highway(row); }
#else
void rgb_row(const RgbRow& row) noexcept { rgb_row_scalar(row); }
#endif

}  // namespace xtrack
