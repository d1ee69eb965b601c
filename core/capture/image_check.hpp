// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
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

/// Reads the header of a PNG or JPEG and checks that the file is whole: for PNG every chunk's
/// length and CRC, for JPEG the marker of its end. Decoders fill what is torn with grey, print on
/// stderr, or reserve what a header claims; after this check they are not asked to.
/// @param name of the file, for messages
[[nodiscard]] Result<ImageInfo> check_image(std::string_view bytes, const std::string& name);

/// A PNG without its ancillary chunks (times, gammas, texts), if it has any: the pixels do not need
/// them, and libpng prints on stderr what it finds odd about them.
/// @pre check_image() took the file
[[nodiscard]] std::optional<std::string> without_ancillary_chunks(std::string_view bytes);

/// The header alone, of the first bytes of a file.
[[nodiscard]] Result<ImageInfo> peek_image(std::string_view bytes, const std::string& name);

}  // namespace xtrack::capture
