// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include <xtrack/geometry.hpp>

namespace xtrack::capture {

/// How the pixels lie in memory.
enum class Layout : std::uint8_t { grey8, bgr8, grey16 };

[[nodiscard]] constexpr std::size_t bytes_per_pixel(Layout layout) {
    return layout == Layout::grey8 ? 1 : layout == Layout::bgr8 ? 3 : 2;
}

enum class Decoded : std::uint8_t { whole, damaged, no_memory };

/// Where the rows go: `size.height` of them, `stride` bytes apart.
struct Rows {
    Size size;  ///< that the image must have
    Layout layout = Layout::grey8;
    std::uint8_t* first = nullptr;
    std::size_t stride = 0;  ///< [bytes]
};

/// libjpeg and libpng, called so that all they would say on stderr and swallow is `damaged`:
/// OpenCV's readers fill what is ruined with grey and succeed. Colour becomes luma for grey8, alpha
/// and what is no pixel (gamma, texts) is dropped.
/// @pre of a PNG: 8 bits a channel, or one channel of 16 for grey16; of a JPEG: not grey16
[[nodiscard]] Decoded decode_jpeg(std::string_view bytes, const Rows& out);
[[nodiscard]] Decoded decode_png(std::string_view bytes, const Rows& out);

}  // namespace xtrack::capture
