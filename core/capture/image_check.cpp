// SPDX-License-Identifier: Apache-2.0
#include "core/capture/image_check.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <utility>

namespace xtrack::capture {

namespace {

constexpr std::string_view kPngSignature{"\x89PNG\r\n\x1a\n", 8};
constexpr std::string_view kJpegSignature{"\xFF\xD8\xFF", 3};
constexpr std::string_view kJpegEnd{"\xFF\xD9", 2};
constexpr std::size_t kChunkOverhead = 12;  // length, type, CRC
// Some writers put a few bytes of their own behind the end of a JPEG.
constexpr std::size_t kJpegTail = 4096;

constexpr std::array<std::uint32_t, 256> make_crc_table() {
    std::array<std::uint32_t, 256> table{};
    for (std::uint32_t n = 0; n < 256; ++n) {
        std::uint32_t c = n;
        for (int k = 0; k < 8; ++k) {
            c = (c & 1U) != 0U ? 0xEDB88320U ^ (c >> 1U) : c >> 1U;
        }
        table[n] = c;
    }
    return table;
}

std::uint32_t crc32(std::string_view bytes) {
    static constexpr std::array<std::uint32_t, 256> kTable = make_crc_table();
    std::uint32_t c = 0xFFFFFFFFU;
    for (const char b : bytes) {
        c = kTable[(c ^ static_cast<unsigned char>(b)) & 0xFFU] ^ (c >> 8U);
    }
    return c ^ 0xFFFFFFFFU;
}

std::uint32_t big_endian(std::string_view bytes, std::size_t at, std::size_t count) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < count; ++i) {
        value = (value << 8U) | static_cast<unsigned char>(bytes[at + i]);
    }
    return value;
}

Error torn(const std::string& name, const std::string& what) {
    return {ErrorCode::malformed,
            name + ": " + what + "; the file is torn, copy or record it again"};
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

Result<void> check_png_chunks(std::string_view bytes, const std::string& name) {
    std::size_t at = kPngSignature.size();
    while (at + kChunkOverhead <= bytes.size()) {
        const std::size_t length = big_endian(bytes, at, 4);
        if (length > bytes.size() - at - kChunkOverhead) {
            break;
        }
        if (crc32(bytes.substr(at + 4, 4 + length)) != big_endian(bytes, at + 8 + length, 4)) {
            return torn(name, "a PNG checksum does not hold");
        }
        if (bytes.substr(at + 4, 4) == "IEND") {
            return {};
        }
        at += kChunkOverhead + length;
    }
    return torn(name, "the PNG ends before its end");
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
        return torn(name, "the image's header cannot be read");
    }
    return *info;
}

std::optional<std::string> without_ancillary_chunks(std::string_view bytes) {
    if (bytes.substr(0, kPngSignature.size()) != kPngSignature) {
        return std::nullopt;
    }
    std::string rest;
    rest.reserve(bytes.size());
    rest += kPngSignature;
    std::size_t at = kPngSignature.size();
    while (at + kChunkOverhead <= bytes.size()) {
        const std::size_t length = kChunkOverhead + big_endian(bytes, at, 4);
        const std::string_view chunk = bytes.substr(at, length);
        constexpr unsigned kAncillary = 0x20;  // a small first letter
        if ((static_cast<unsigned char>(chunk[4]) & kAncillary) == 0U) {
            rest += chunk;
        }
        if (chunk.substr(4, 4) == "IEND") {
            break;
        }
        at += length;
    }
    return rest.size() < bytes.size() ? std::optional(std::move(rest)) : std::nullopt;
}

Result<ImageInfo> check_image(std::string_view bytes, const std::string& name) {
    auto info = peek_image(bytes, name);
    if (!info) {
        return info;
    }
    if (bytes[0] == kPngSignature[0]) {
        if (auto ok = check_png_chunks(bytes, name); !ok) {
            return ok.error();
        }
    } else {
        const std::size_t tail = std::min(bytes.size(), kJpegTail);
        if (bytes.substr(bytes.size() - tail).find(kJpegEnd) == std::string_view::npos) {
            return torn(name, "the JPEG ends before its end");
        }
    }
    return info;
}

}  // namespace xtrack::capture
