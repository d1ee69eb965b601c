// SPDX-License-Identifier: Apache-2.0
#include "tools/hand_accuracy.hpp"

#include <algorithm>
#include <cmath>

namespace xtrack::tools {

namespace {

constexpr std::uint8_t kHandMask = 1;

double percent(std::size_t part, std::size_t whole) {
    return whole == 0 ? 0.0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

// The image's border cuts nothing off: what lies beyond it counts as more hand.
bool inside_hand(ImageView<const std::uint8_t> mask, int x, int y) {
    const int last_x = std::min(x + kErodeHand_px, mask.width - 1);
    const int last_y = std::min(y + kErodeHand_px, mask.height - 1);
    for (int j = std::max(y - kErodeHand_px, 0); j <= last_y; ++j) {
        for (int i = std::max(x - kErodeHand_px, 0); i <= last_x; ++i) {
            if (mask.at(i, j) != kHandMask) {
                return false;
            }
        }
    }
    return true;
}

}  // namespace

void HandAccuracy::add(const HandAccuracy& other) noexcept {
    pixels += other.pixels;
    close += other.close;
    off += other.off;
    missing += other.missing;
    square_sum_mm2 += other.square_sum_mm2;
}

double HandAccuracy::rms_mm() const noexcept {
    return close == 0 ? 0.0 : std::sqrt(square_sum_mm2 / static_cast<double>(close));
}
double HandAccuracy::off_percent() const noexcept { return percent(off, pixels); }
double HandAccuracy::missing_percent() const noexcept { return percent(missing, pixels); }

HandAccuracy measure_hand(const DepthFrame& depth, ImageView<const std::uint16_t> truth,
                          ImageView<const std::uint8_t> mask, double limit_mm) {
    HandAccuracy result;
    for (int y = 0; y < mask.height; ++y) {
        for (int x = 0; x < mask.width; ++x) {
            if (mask.at(x, y) != kHandMask || truth.at(x, y) == 0 || !inside_hand(mask, x, y)) {
                continue;
            }
            ++result.pixels;
            const std::uint16_t steps = depth.depth.at(x, y);
            if (steps == 0) {
                ++result.missing;
                continue;
            }
            const double error_mm = steps * depth.depth_unit_mm - truth.at(x, y) * kDepthUnitMm;
            if (std::abs(error_mm) > limit_mm) {
                ++result.off;
                continue;
            }
            ++result.close;
            result.square_sum_mm2 += error_mm * error_mm;
        }
    }
    return result;
}

}  // namespace xtrack::tools
