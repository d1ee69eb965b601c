// SPDX-License-Identifier: Apache-2.0
#include "core/capture/image_codec.hpp"

#include <exception>
#include <vector>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "core/base/setting_up.hpp"
#include "core/capture/decoders.hpp"
#include "core/capture/image_header.hpp"

namespace xtrack::capture {

namespace {

constexpr char kJpegFirst = '\xFF';

std::string text_of(Size s) { return std::to_string(s.width) + "x" + std::to_string(s.height); }

Result<void> check(std::string_view bytes, const std::string& name, Size size, int bits) {
    const auto info = peek_image(bytes, name);
    if (!info) {
        return info.error();
    }
    if (info->bits != bits) {
        return Error{ErrorCode::malformed, name + ": has " + std::to_string(info->bits) +
                                               " bits a channel; save it with " +
                                               std::to_string(bits)};
    }
    if (info->size != size) {
        return Error{ErrorCode::malformed, name + ": is " + text_of(info->size) +
                                               " pixels, the recording's images are " +
                                               text_of(size) + "; remove it or mend camera_size"};
    }
    return {};
}

Result<void> decode(std::string_view bytes, const std::string& name, const Rows& out) {
    const bool is_jpeg = bytes.front() == kJpegFirst;
    switch (is_jpeg ? decode_jpeg(bytes, out) : decode_png(bytes, out)) {
        case Decoded::whole: return {};
        case Decoded::no_memory: return base::out_of_memory(name.c_str());
        case Decoded::damaged: break;
    }
    return Error{ErrorCode::malformed, name + ": the " + (is_jpeg ? "JPEG" : "PNG") +
                                           " is damaged; copy the recording again, or remove its "
                                           "row"};
}

constexpr std::size_t kMostHeader = 1U << 16U;

Result<std::string> encode(const char* extension, const cv::Mat& image,
                           const std::vector<int>& parameters) {
    try {
        std::vector<unsigned char> bytes;
        // All that it can need: where memory ran out within libtiff, nobody could catch that.
        bytes.reserve(2 * image.total() * image.elemSize() + kMostHeader);
        if (cv::imencode(extension, image, bytes, parameters)) {
            return std::string(bytes.begin(), bytes.end());
        }
    } catch (const std::bad_alloc&) {
        return Error{ErrorCode::io, std::string("not enough memory to encode an image as ") +
                                        extension + "; close other programs"};
    } catch (const std::exception&) {
        // Falls through to the same message.
    }
    return Error{ErrorCode::io, std::string("an image cannot be encoded as ") + extension};
}

template <typename T>
cv::Mat wrap(ImageView<const T> image, int channels, int type) {
    return {image.height, image.width / channels, type,
            const_cast<T*>(image.data),  // NOLINT: OpenCV reads only
            static_cast<std::size_t>(image.stride) * sizeof(T)};
}

}  // namespace

Result<void> decode_image(std::string_view bytes, const std::string& name, Size size,
                          PixelFormat format, Image<std::uint8_t>& out) {
    constexpr int kBits = 8;
    if (auto ok = check(bytes, name, size, kBits); !ok) {
        return ok;
    }
    const bool grey = format == PixelFormat::grey8;
    out.resize(size.width * (grey ? 1 : 3), size.height);
    return decode(bytes, name,
                  {size, grey ? Layout::grey8 : Layout::bgr8, out.row(0),
                   static_cast<std::size_t>(out.stride())});
}

Result<void> decode_depth(std::string_view bytes, const std::string& name, Size size,
                          Image<std::uint16_t>& out) {
    constexpr int kBits = 16;
    if (auto ok = check(bytes, name, size, kBits); !ok) {
        return ok;
    }
    if (const auto info = peek_image(bytes, name); info && info->channels != 1) {
        // OpenCV would make a luma of it, which is no depth.
        return Error{ErrorCode::malformed, name + ": has " + std::to_string(info->channels) +
                                               " channels, depth has one; save it as 16-bit grey"};
    }
    out.resize(size.width, size.height);
    return decode(bytes, name,
                  {size, Layout::grey16,
                   reinterpret_cast<std::uint8_t*>(out.row(0)),  // NOLINT: the decoder's bytes
                   static_cast<std::size_t>(out.stride()) * sizeof(std::uint16_t)});
}

Result<std::string> encode_png(ImageView<const std::uint8_t> image, PixelFormat format) {
    const bool grey = format == PixelFormat::grey8;
    return encode(".png", wrap(image, grey ? 1 : 3, grey ? CV_8UC1 : CV_8UC3), {});
}

Result<std::string> encode_png(ImageView<const std::uint16_t> image) {
    return encode(".png", wrap(image, 1, CV_16UC1), {});
}

Result<std::string> encode_tiff(ImageView<const float> image) {
    constexpr int kNoCompression = 1;
    return encode(".tiff", wrap(image, 1, CV_32FC1),
                  {cv::IMWRITE_TIFF_COMPRESSION, kNoCompression});
}

}  // namespace xtrack::capture
