// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include <xtrack/hand_region.hpp>

#include "gestures/segment/grid.hpp"

namespace xtrack::track {

/// Unit normal of the plane through the palm's skin (least squares in the inscribed circle), on the
/// side that faces the camera. Zero when there is too little skin.
[[nodiscard]] Vec3f fit_palm_normal(const segment::Grid& grid, std::span<const std::uint8_t> labels,
                                    const HandRegion& region);

}  // namespace xtrack::track
