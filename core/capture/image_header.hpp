// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include <xtrack/geometry.hpp>
#include <xtrack/result.hpp>

namespace xtrack::capture {

/// What an image file says of itself.
struct ImageInfo {
    Size size;
    int bits = 8;  ///< of one channel of one pixel
    int channels = 1;
};

/// Reads the header of a PNG or JPEG, before a decoder reserves what it claims.
/// @param bytes the first of a file, or all
/// @param name of the file, for messages
/// @errors malformed: neither PNG nor JPEG, or no header can be read
[[nodiscard]] Result<ImageInfo> peek_image(std::string_view bytes, const std::string& name);

}  // namespace xtrack::capture
