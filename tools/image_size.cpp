// SPDX-License-Identifier: Apache-2.0
#include "tools/image_size.hpp"

#include <charconv>

namespace xtrack::tools {

std::optional<Size> parse_size(const std::string& text) {
    Size size;
    const char* const end = text.data() + text.size();
    const auto width = std::from_chars(text.data(), end, size.width);
    if (width.ec != std::errc{} || width.ptr == end || *width.ptr != 'x') {
        return std::nullopt;
    }
    const auto height = std::from_chars(width.ptr + 1, end, size.height);
    if (height.ec != std::errc{} || height.ptr != end || !is_image_size(size)) {
        return std::nullopt;
    }
    return size;
}

}  // namespace xtrack::tools
