// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include <xtrack/image.hpp>

namespace xtrack {

/// The phase that a plane has in a camera image under a projector: (a + b u + c v) / (1 + d u + e
/// v), u and v the pixel in half images from the centre.
class ReferencePlane {
 public:
    /// The plane that a component lies in where it reaches the image's border, or that most of it
    /// lies in where it hardly does: least squares whose weights fall with the distance, over and
    /// over.
    /// @param phase_rad unwrapped, NaN = none
    /// @return empty where too few pixels are of this component, or none fit a plane
    [[nodiscard]] static std::optional<ReferencePlane> fit(ImageView<const float> phase_rad,
                                                           ImageView<const std::uint16_t> component,
                                                           std::uint16_t id);

    /// Phase of the plane at a pixel, rad.
    [[nodiscard]] double at(int x, int y) const noexcept;

 private:
    std::array<double, 5> terms_{};
    double half_width_px_ = 1.0;
    double half_height_px_ = 1.0;
};

}  // namespace xtrack
