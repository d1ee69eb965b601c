// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <xtrack/stamp.hpp>

namespace xtrack::segment {

/// What stands still, one depth a pixel, learnt while hands are already in view.
///
/// Each pixel has a background depth (0 = not known) and a rival: a surface in front of it that has
/// been seen for a while. A surface *behind* the background shows that the background was wrong, so
/// it takes over at once; a rival in front takes over after a hold. A hand's pixels have a hold of
/// their own, much longer, so that a hand which rests, or was there first, is not swallowed.
class Background {
 public:
    struct Settings {
        float margin_mm = 15.0F;
        std::int64_t hold_ms = 2000;
        std::int64_t hand_rest_ms = 30000;
    };

    void create(std::size_t pixels, const Settings& settings);
    void reset();

    /// Sets foreground[i] to z[i], or to 0 where z[i] is background.
    void mask(std::span<const float> z, std::span<float> foreground) const;

    /// Learns half of one image, and the other half of the next. `hand_labels` is not 0 where a
    /// hand or its arm was found.
    /// @param elapsed_ms since the image learnt before; 0 for the first
    void learn(std::span<const float> z, std::span<const std::uint8_t> hand_labels,
               std::int64_t elapsed_ms);

    [[nodiscard]] std::span<const float> depth_mm() const noexcept { return depth_; }

 private:
    Settings settings_;
    std::vector<float> depth_;        ///< 0 = not known
    std::vector<float> rival_;        ///< 0 = none
    std::vector<float> rival_seen_;   ///< 0..1 of the hold
    float elapsed_before_ms_ = 0.0F;  ///< between the two images before this
    bool upper_is_newer_ = false;     ///< the first half of the pixels was learnt last
};

}  // namespace xtrack::segment
