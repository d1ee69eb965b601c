// SPDX-License-Identifier: Apache-2.0
#include "core/capture/image_header.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>

namespace xtrack::capture {

namespace {

constexpr std::string_view kPngSignature{"\x89PNG\r\n\x1a\n", 8};
constexpr std::string_view kJpegSignature{"\xFF\xD8\xFF", 3};

std::uint32_t big_endian(std::string_view bytes, std::size_t at, std::size_t count) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < count; ++i) {
        value = (value << 8U) | static_cast<unsigned char>(bytes[at + i]);
    }
    return value;
}

// Sides beyond this are refused later by name; here they must only fit an int.
int side(std::uint32_t v) { return static_cast<int>(std::min<std::uint32_t>(v, 1U << 30U)); }

std::optional<ImageInfo> png_header(std::string_view bytes) {
    constexpr std::size_t kHeaderEnd = 26;  // up to the colour type
    if (bytes.size() < kHeaderEnd || bytes.substr(12, 4) != "IHDR") {
        return std::nullopt;
    }
    static constexpr int kChannels[7] = {1, 0, 3, 3, 2, 0, 4};  // a palette unfolds to three
    const std::uint32_t colour_type = big_endian(bytes, 25, 1);
    if (colour_type > 6 || kChannels[colour_type] == 0) {
        return std::nullopt;
    }
    ImageInfo info;
    info.size = {side(big_endian(bytes, 16, 4)), side(big_endian(bytes, 20, 4))};
    info.bits = static_cast<int>(big_endian(bytes, 24, 1));
    info.channels = kChannels[colour_type];
    return info;
}

bool is_start_of_frame(std::uint32_t marker) {
    return marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
}

std::optional<ImageInfo> jpeg_header(std::string_view bytes) {
    std::size_t at = 2;
    while (at + 9 < bytes.size()) {
        if (big_endian(bytes, at, 1) != 0xFF) {
            return std::nullopt;
        }
        const std::uint32_t marker = big_endian(bytes, at + 1, 1);
        if (marker == 0xFF) {  // padding
            ++at;
            continue;
        }
        if (is_start_of_frame(marker)) {
            ImageInfo info;
            info.bits = static_cast<int>(big_endian(bytes, at + 4, 1));
            info.size = {side(big_endian(bytes, at + 7, 2)), side(big_endian(bytes, at + 5, 2))};
            info.channels = static_cast<int>(big_endian(bytes, at + 9, 1));
            return info;
        }
        at += 2 + big_endian(bytes, at + 2, 2);
    }
    return std::nullopt;
}

}  // namespace

Result<ImageInfo> peek_image(std::string_view bytes, const std::string& name) {
    std::optional<ImageInfo> info;
    if (bytes.substr(0, kPngSignature.size()) == kPngSignature) {
        info = png_header(bytes);
    } else if (bytes.substr(0, kJpegSignature.size()) == kJpegSignature) {
        info = jpeg_header(bytes);
    } else {
        return Error{ErrorCode::malformed,
                     name + ": is neither PNG nor JPEG; save the image as PNG"};
    }
    if (!info || info->size.width < 1 || info->size.height < 1) {
        return Error{ErrorCode::malformed, name +
                                               ": the image's header cannot be read; the file is "
                                               "torn, copy or record it again"};
    }
    return *info;
}

}  // namespace xtrack::capture
