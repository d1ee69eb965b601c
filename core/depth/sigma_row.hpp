// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/depth/depth_row.hpp"

namespace xtrack {

/// What the camera's noise does to one row of depth.
struct SigmaRow {
    const float* mean = nullptr;        ///< grey levels without fringes
    const float* noise_gain = nullptr;  ///< sigma_phi = noise_gain * sigma_I / B
    float period_px = 0.0F;             ///< of the phase that gave the coordinate
    float read_noise_levels = 0.0F;     ///< rms, quantisation included
    float electrons_per_level = 0.0F;   ///< shot noise: sigma^2 = mean / it; 0: none
    float* sigma_mm = nullptr;          ///< out: standard deviation of depth, 0 = no depth
};

/// sigma_Z = sigma_phi (P / 2 pi) / |dx/dZ|, where x = (a Z + b) / (c Z + d).
/// @param depth as depth_row() has filled it
/// @thread any; rows are independent
void sigma_row(const DepthRow& depth, const SigmaRow& row) noexcept;

}  // namespace xtrack
