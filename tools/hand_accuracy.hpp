// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include <xtrack/depth.hpp>
#include <xtrack/image.hpp>

namespace xtrack::tools {

/// Depth of a hand beside the truth, pixel by pixel. Sums, so that images can be added up.
struct HandAccuracy {
    std::size_t pixels = 0;   ///< of the hand, with true depth
    std::size_t close = 0;    ///< within the limit
    std::size_t off = 0;      ///< beyond it: not noisy but wrong, another fringe, another surface
    std::size_t missing = 0;  ///< without depth
    double square_sum_mm2 = 0.0;  ///< of the close ones

    void add(const HandAccuracy& other) noexcept;
    [[nodiscard]] double rms_mm() const noexcept;  ///< of the close ones; 0 where there is none
    [[nodiscard]] double off_percent() const noexcept;
    [[nodiscard]] double missing_percent() const noexcept;
};

/// A hand's outermost pixels, which see hand and background at once, are left out by this much.
inline constexpr int kErodeHand_px = 2;

/// @param depth beside which the truth is put
/// @param truth depth, kDepthUnitMm a step, 0 = unknown; of the same size
/// @param mask what each pixel shows, 1 = hand; of the same size
/// @param limit_mm a pixel that errs by more is off
[[nodiscard]] HandAccuracy measure_hand(const DepthFrame& depth,
                                        ImageView<const std::uint16_t> truth,
                                        ImageView<const std::uint8_t> mask, double limit_mm);

}  // namespace xtrack::tools
