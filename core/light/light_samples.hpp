// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <xtrack/frame.hpp>

namespace xtrack {

/// Means of the images of each pattern, at pixels on a grid: enough of them for any curve, few
/// enough for a ramp of large images to be kept.
/// @thread one at a time
class LightSamples {
 public:
    static constexpr std::size_t kChannels = 3;  ///< red, green, blue; of grey images all alike
    static constexpr std::size_t kLuma = 3;      ///< instead of a channel

    LightSamples() = default;
    LightSamples(std::size_t patterns, Size image);

    /// @pre a frame of the image's size, whose pattern is one of the sequence
    void add(const Frame& frame);

    [[nodiscard]] std::size_t count() const noexcept { return clipped_.size(); }
    /// Camera pixel of a sample.
    [[nodiscard]] int u(std::size_t sample) const noexcept {
        return static_cast<int>(sample % columns_) * step_px_;
    }
    [[nodiscard]] int v(std::size_t sample) const noexcept {
        return static_cast<int>(sample / columns_) * step_px_;
    }
    /// False where no clean row of the pattern covered the sample.
    [[nodiscard]] bool seen(int pattern, std::size_t sample) const noexcept {
        const Shown& shown = patterns_[static_cast<std::size_t>(pattern)];
        return !shown.images.empty() && shown.images[sample / columns_] > 0;
    }
    /// True where an image had a channel at its limit.
    [[nodiscard]] bool clipped(std::size_t sample) const noexcept { return clipped_[sample] != 0; }
    /// True where all images of the pattern were in colour.
    [[nodiscard]] bool in_colour(int pattern) const noexcept {
        const Shown& shown = patterns_[static_cast<std::size_t>(pattern)];
        return !shown.images.empty() && !shown.grey;
    }
    /// Mean, grey levels. @pre seen()
    [[nodiscard]] double level(int pattern, std::size_t channel,
                               std::size_t sample) const noexcept {
        const Shown& shown = patterns_[static_cast<std::size_t>(pattern)];
        const float* sums = shown.sums.data() + kChannels * sample;
        const double sum = channel == kLuma ? 0.299 * static_cast<double>(sums[0]) +
                                                  0.587 * static_cast<double>(sums[1]) +
                                                  0.114 * static_cast<double>(sums[2])
                                            : static_cast<double>(sums[channel]);
        return sum / shown.images[sample / columns_];
    }

 private:
    struct Shown {
        std::vector<float> sums;            // kChannels of each sample
        std::vector<std::uint32_t> images;  // of each row of the grid
        bool grey = false;                  // some image was
    };
    int step_px_ = 1;
    std::size_t columns_ = 0;
    std::vector<Shown> patterns_;  // empty until one is seen
    std::vector<std::uint8_t> clipped_;
};

}  // namespace xtrack
