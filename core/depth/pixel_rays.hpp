// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <xtrack/image.hpp>
#include <xtrack/rig.hpp>

#include "core/depth/points_row.hpp"

namespace xtrack {

/// The rays of a camera's pixels, prepared for rows of points. A table is kept only where the lens
/// is distorted; else rays are affine.
/// @thread const calls from any
class PixelRays {
 public:
    /// @pre a camera that validate() accepts. Allocates the table.
    explicit PixelRays(const Pinhole& camera);

    /// Fills in the rays of image row y; the caller sets all else.
    void prepare_row(int y, PointsRow& row) const noexcept;

 private:
    // Of pixel (0, 0), and what one to the right and one down add.
    Vec2f first_ = Vec2f::Zero();
    Vec2f right_ = Vec2f::Zero();
    Vec2f down_ = Vec2f::Zero();
    Image<float> x_;  ///< empty without distortion
    Image<float> y_;
};

}  // namespace xtrack
