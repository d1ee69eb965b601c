// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

namespace xtrack {

/// One row of the step from wrapped phase to projector coordinate: of all x = (phase / 2 pi + k) P
/// take the one nearest a reference coordinate. The reference says which way the order was found:
///
/// - a coarser period: its coordinate (two or more periods, coarse to fine);
/// - a Gray code: the centre of the cell;
/// - a volume-wide period: the middle of what the working volume can reach in this pixel (the
///   geometric constraint of An, Hyun, Zhang 2016, "Pixel-wise absolute phase unwrapping using
///   geometric constraints of structured light system");
/// - a known depth image: the coordinate that depth has.
struct UnwrapRow {
    int count = 0;                        ///< pixels
    const float* reference_px = nullptr;  ///< projector px; NaN gives NaN
    const float* phase_rad = nullptr;     ///< NaN gives NaN
    double period_px = 0.0;
    /// |x - reference| above this share of the period is masked; 0.5 masks nothing.
    float tolerance = 0.5F;
    float coordinate_min_px = -std::numeric_limits<float>::infinity();  ///< outside: masked
    float coordinate_max_px = std::numeric_limits<float>::infinity();
    float* coordinate_px = nullptr;  ///< out: projector px, NaN = none; not the inputs' memory
};

/// @thread any; rows are independent
/// @ownership borrows everything for the call
void unwrap_row(const UnwrapRow& row) noexcept;

/// The reference form, plain C++.
void unwrap_row_scalar(const UnwrapRow& row) noexcept;

#if XTRACK_WITH_HIGHWAY
void unwrap_row_highway(const UnwrapRow& row) noexcept;
#endif

}  // namespace xtrack
