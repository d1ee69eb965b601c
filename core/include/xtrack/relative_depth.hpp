// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

#include <xtrack/depth.hpp>
#include <xtrack/image.hpp>
#include <xtrack/phase_map.hpp>
#include <xtrack/result.hpp>

namespace xtrack {

/// Depth without a calibration: how far the phase of one period is off that of the background, as
/// the 2012 paper shows it. It has one unknown scale, and of surfaces that nothing connects
/// with the background also an unknown number of fringes; they are put nearest to it.
///
/// The phase is unwrapped in space, by quality. The background is what learn_background() was
/// shown; before that, the plane in which the largest surface lies along the image's border (its
/// phase is a ratio of linear functions of the pixel, fitted with weights that outliers lose).
/// @thread one at a time
/// @since 0.1
class RelativeDepth {
 public:
    /// @errors invalid_argument: a size for which is_image_size() does not hold; io: no memory
    [[nodiscard]] static Result<RelativeDepth> create(Size image);
    RelativeDepth(RelativeDepth&&) noexcept;
    RelativeDepth& operator=(RelativeDepth&&) noexcept;
    ~RelativeDepth();

    /// Takes `map` for the empty scene: from now on heights are above it. Copies it.
    /// @errors invalid_argument: not of the image's size
    Result<void> learn_background(const PhaseMap& map);

    /// Measures heights; the results below are then of this map.
    /// @errors invalid_argument: not of the image's size; unsupported: no background was learnt and
    ///         too little of the image is one surface for a plane
    Result<void> measure(const PhaseMap& map);

    /// Phase with its whole turns, rad, NaN where masked. With a learnt background: of the
    /// difference from it.
    [[nodiscard]] const Image<float>& unwrapped_rad() const noexcept;
    /// Above the background, rad, NaN where masked. What stands out most is taken to be in front,
    /// which is up.
    [[nodiscard]] const Image<float>& height_rad() const noexcept;
    /// Of each pixel, 1 the largest; 0 where masked. Orders are sure within one only.
    [[nodiscard]] const Image<std::uint16_t>& component() const noexcept;

    /// The heights as a depth image, `metric` false: the background lies at kBackground_mm, and a
    /// radian is kPerRadian_mm nearer, whatever that is.
    [[nodiscard]] DepthFrame depth() const;
    static constexpr double kBackground_mm = 1000.0;
    static constexpr double kPerRadian_mm = 10.0;

 private:
    struct Impl;
    explicit RelativeDepth(std::unique_ptr<Impl> impl) noexcept;
    std::unique_ptr<Impl> impl_;
};

}  // namespace xtrack
