// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <xtrack/image.hpp>
#include <xtrack/stamp.hpp>

namespace xtrack {

/// Wrapped phase and modulation of one fringe period, camera image shape.
/// @since 0.1
struct PhaseMap {
    Stamp stamp;
    double period_px = 0.0;   ///< projector pixels along the coded axis
    Image<float> phase_rad;   ///< in (-pi, pi]; 0 at the projector's first pixel of each period;
                              ///< NaN where masked
    Image<float> modulation;  ///< amplitude B of the fringe, grey levels; 0 where masked
};

}  // namespace xtrack
