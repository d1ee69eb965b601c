// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include <xtrack/frame.hpp>
#include <xtrack/image.hpp>
#include <xtrack/result.hpp>

// The one place that knows OpenCV's image codecs, which throw. Messages name `name`, the file.
namespace xtrack::capture {

/// Decodes an 8-bit PNG or JPEG into `out`, which is sized to it; colour becomes luma for grey8.
/// @param size that the image must have
[[nodiscard]] Result<void> decode_image(std::string_view bytes, const std::string& name, Size size,
                                        PixelFormat format, Image<std::uint8_t>& out);

/// Decodes a 16-bit grey PNG.
[[nodiscard]] Result<void> decode_depth(std::string_view bytes, const std::string& name, Size size,
                                        Image<std::uint16_t>& out);

[[nodiscard]] Result<std::string> encode_png(ImageView<const std::uint8_t> image,
                                             PixelFormat format);
[[nodiscard]] Result<std::string> encode_png(ImageView<const std::uint16_t> image);
/// 32-bit float, one channel, not compressed.
[[nodiscard]] Result<std::string> encode_tiff(ImageView<const float> image);

}  // namespace xtrack::capture
