// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <xtrack/geometry.hpp>
#include <xtrack/image.hpp>

namespace xtrack {

/// The pixels of one depth image that are a hand, cut off at the wrist. Pixel coordinates are those
/// of the working grid: depth image coordinates divided by `HandSegmentation::scale`. Positions are
/// in the camera frame, mm.
/// @since 0.1
struct HandRegion {
    std::uint8_t label = 0;  ///< value in HandSegmentation::labels; 0 = no region
    int x_begin = 0, y_begin = 0, x_end = 0, y_end = 0;  ///< box, half open
    int pixel_count = 0;
    float area_mm2 = 0.0F;  ///< of the seen surface, projected on the image plane

    Vec2f palm_px = Vec2f::Zero();  ///< centre of the largest inscribed circle
    float palm_radius_px = 0.0F;
    float palm_radius_mm = 0.0F;
    Vec3f palm_mm = Vec3f::Zero();        ///< that centre, at the skin
    Vec3f wrist_mm = Vec3f::Zero();       ///< where the forearm was cut off
    Vec3f arm_direction = Vec3f::Zero();  ///< unit, from the palm along the forearm
    bool arm_seen = false;                ///< false: no forearm in view, arm_direction is a guess
    bool touches_border = false;  ///< the hand beyond its wrist is cut by the image's border
    float score = 0.0F;           ///< 0..1, how much it looks like a hand
};

/// What the segmentation of one depth image gives.
/// @ownership borrowed from the tracker until its next frame
/// @since 0.1
struct HandSegmentation {
    ImageView<const std::uint8_t> labels;  ///< 0, or the label of a region
    int scale = 1;                         ///< depth pixels a grid pixel, in both directions
    const HandRegion* regions = nullptr;
    int count = 0;
};

}  // namespace xtrack
