// SPDX-License-Identifier: Apache-2.0
#include "core/light/light_samples.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace xtrack {
namespace {

constexpr double kMostSamples = 40000.0;
constexpr std::uint8_t kClipped = 255;

}  // namespace

LightSamples::LightSamples(std::size_t patterns, Size image) : patterns_(patterns) {
    const double pixels = static_cast<double>(image.width) * image.height;
    step_px_ = std::max(1, static_cast<int>(std::ceil(std::sqrt(pixels / kMostSamples))));
    columns_ = static_cast<std::size_t>((image.width + step_px_ - 1) / step_px_);
    clipped_.resize(columns_ * static_cast<std::size_t>((image.height + step_px_ - 1) / step_px_));
}

void LightSamples::add(const Frame& frame) {
    Shown& shown = patterns_[static_cast<std::size_t>(frame.pattern)];
    if (shown.images.empty()) {
        shown.sums.resize(kChannels * count());
        shown.images.resize(count() / columns_);
    }
    const bool colour = frame.format == PixelFormat::bgr8;
    shown.grey = shown.grey || !colour;
    const std::array<std::ptrdiff_t, kChannels> place =
        colour ? std::array<std::ptrdiff_t, kChannels>{2, 1, 0}  // bytes: blue, green, red
               : std::array<std::ptrdiff_t, kChannels>{0, 0, 0};
    const auto step_px = static_cast<std::size_t>(step_px_);
    for (std::size_t row = 0; row < shown.images.size(); ++row) {
        const int y = static_cast<int>(row) * step_px_;
        if (y < frame.clean_row_begin || y >= frame.clean_row_end) {
            continue;
        }
        ++shown.images[row];
        const std::uint8_t* pixels = frame.pixels.row(y);
        for (std::size_t column = 0; column < columns_; ++column) {
            const std::size_t sample = row * columns_ + column;
            const std::uint8_t* pixel =
                pixels + column * step_px * static_cast<std::size_t>(frame.channels());
            for (std::size_t c = 0; c < kChannels; ++c) {
                const std::uint8_t value = pixel[place[c]];
                shown.sums[kChannels * sample + c] += static_cast<float>(value);
                clipped_[sample] |= static_cast<std::uint8_t>(value == kClipped ? 1U : 0U);
            }
        }
    }
}

}  // namespace xtrack
