// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include <xtrack/frame.hpp>
#include <xtrack/image.hpp>
#include <xtrack/result.hpp>

namespace xtrack::capture {

/// Decodes a JPEG into `out`, which is sized to it; colour becomes luma for grey8. OpenCV's decoder
/// fills what is ruined with grey, tells stderr and succeeds; here every warning is an error.
/// @param size that the image must have
/// @errors malformed: names `name`
[[nodiscard]] Result<void> decode_jpeg(std::string_view bytes, const std::string& name, Size size,
                                       PixelFormat format, Image<std::uint8_t>& out);

}  // namespace xtrack::capture
