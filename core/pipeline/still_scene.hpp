// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>

#include <xtrack/image.hpp>
#include <xtrack/stamp.hpp>

namespace xtrack {

/// What stands still before a camera: the phase of each pixel with all its turns, and its
/// modulation. A pixel that looks as it did is where it was, so that only what moves must find its
/// turns from the picture; and a hand is kept apart from what is behind it, even where its phase
/// happens to go on.
///
/// Like a background it changes: what has come to rest is taken in, soon where nothing was known or
/// where it lies behind what was, and late where it lies before it, as a hand may rest a while.
/// @thread one at a time; no allocation after the constructor
class StillScene {
 public:
    explicit StillScene(Size image);

    /// Divides a wrapped phase image.
    /// @param phase_rad wrapped; NaN = none
    void divide(ImageView<const float> phase_rad, ImageView<const float> modulation) noexcept;

    /// What divide() took for still: the phase with its turns, rad; NaN elsewhere.
    [[nodiscard]] const Image<float>& still_rad() const noexcept { return still_; }
    /// The rest, without its outline: the phase as it came; NaN elsewhere.
    [[nodiscard]] const Image<float>& moving_rad() const noexcept { return moving_; }
    [[nodiscard]] int still_pixels() const noexcept { return still_pixels_; }
    /// What is known of each pixel, whatever is before it now, rad; NaN: nothing.
    [[nodiscard]] const Image<float>& known_rad() const noexcept { return known_; }

    /// Takes in the image that was divided last, now that its turns are known.
    /// @param component 0 = nothing to learn; elsewhere there is a phase
    /// @param front 1: more phase is nearer; -1: less is; 0: nobody knows
    /// @param stamp of the image; must not decrease
    void learn(ImageView<const float> unwrapped_rad, ImageView<const std::uint16_t> component,
               ImageView<const float> modulation, double front, Stamp stamp) noexcept;
    void forget() noexcept;

    /// A pixel that still_rad() has moves after all.
    void set_moving(int x, int y) noexcept {
        still_.at(x, y) = std::numeric_limits<float>::quiet_NaN();
        --still_pixels_;
    }

    /// Makes moving_rad() all that is known, wrapped, so that its turns can be found anew.
    void show_known() noexcept;
    /// Takes these turns; NaN: the pixel is not known any more.
    void replace_known(ImageView<const float> unwrapped_rad) noexcept;
    [[nodiscard]] const Image<float>& known_modulation() const noexcept {
        return known_modulation_;
    }

 private:
    struct Rival {
        float phase_rad = 0.0F;
        float modulation = 0.0F;
        float seen_ms = 0.0F;
    };
    void uncover(ImageView<const float> phase_rad, ImageView<const float> modulation) noexcept;
    void grow(int x, int y, int dx, int dy, ImageView<const float> phase_rad,
              ImageView<const float> modulation) noexcept;
    void cut_edges(ImageView<const float> modulation) noexcept;
    void learn_pixel(Rival& rival, int x, int y, float phase_rad, float modulation, float front,
                     float elapsed_ms) noexcept;

    Size size_;
    Image<float> known_;
    Image<float> known_modulation_;
    Image<float> still_;
    Image<float> moving_;
    Image<Rival> rivals_;
    int still_pixels_ = 0;
    unsigned images_ = 0;
    Stamp last_stamp_;  ///< of the image it learnt from last
};

}  // namespace xtrack
