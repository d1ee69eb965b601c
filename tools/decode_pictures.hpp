// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <xtrack/image.hpp>
#include <xtrack/result.hpp>

namespace xtrack::tools {

/// PNG bytes of depth in 256 colours between `low_mm` and `high_mm`, near is red, black is no
/// depth, with a legend beside it.
[[nodiscard]] Result<std::string> depth_preview(ImageView<const std::uint16_t> depth,
                                                double unit_mm, double low_mm, double high_mm,
                                                const std::string& title);

/// PNG bytes of a wrapped phase, NaN in black, with a legend from -pi to pi.
[[nodiscard]] Result<std::string> phase_preview(ImageView<const float> phase_rad,
                                                const std::string& title);

/// PNG bytes of heights, rad, NaN in black, with a legend from the 1st to the 99th percentile.
[[nodiscard]] Result<std::string> height_preview(ImageView<const float> height_rad,
                                                 const std::string& title);

/// PNG bytes of grey levels, rounded and limited to 0..255.
[[nodiscard]] Result<std::string> grey_png(ImageView<const float> image);

}  // namespace xtrack::tools
