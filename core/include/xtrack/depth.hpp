// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <xtrack/image.hpp>
#include <xtrack/stamp.hpp>

namespace xtrack {

/// The unit of our own depth images, mm a step.
inline constexpr double kDepthUnitMm = 0.1;

/// Depth along the camera's z axis, one value a camera pixel. Any depth camera can make one.
/// @since 0.1
struct DepthFrame {
    Stamp stamp;                 ///< of the frame it is registered to
    std::uint64_t sequence = 0;  ///< of that frame
    /// From the first to the last image that it is made of: what moved meanwhile is blurred. 0 =
    /// not known.
    Duration span = Duration::zero();
    double depth_unit_mm = kDepthUnitMm;  ///< millimetres a step
    bool metric = true;                   ///< false: relative depth, one unknown scale
    Image<std::uint16_t> depth;           ///< 0 = no depth
    /// 0 = no depth, else grows with trust: for fringes the modulation in grey levels, at most 255.
    /// Empty when the source has none.
    Image<std::uint8_t> quality;
};

}  // namespace xtrack
