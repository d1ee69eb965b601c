// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

#include <xtrack/image.hpp>
#include <xtrack/stamp.hpp>

namespace xtrack {

/// How the pixels of a frame lie in memory.
/// @since 0.1
enum class PixelFormat {
    grey8,  ///< one byte a pixel
    bgr8,   ///< three bytes a pixel: blue, green, red
};

/// What can be said of a frame as a whole; only `ok` frames carry pixels that mean something.
/// @since 0.1
enum class FrameStatus {
    ok,
    damaged,  ///< delivered, but the device says its content is wrong
};

/// `Frame::pattern` when nobody knows which pattern the camera saw.
inline constexpr int kUnknownPattern = -1;

/// One camera image. Published as FramePtr and immutable from then on.
/// @since 0.1
struct Frame {
    FrameStatus status = FrameStatus::ok;
    PixelFormat format = PixelFormat::grey8;
    Stamp stamp;                    ///< middle of the exposure (of the middle row, if rolling)
    std::uint64_t sequence = 0;     ///< the device's count; gaps are lost frames
    int pattern = kUnknownPattern;  ///< index into the PatternSequence
    int clean_row_begin = 0;        ///< rows [begin, end) saw that pattern and no other;
    int clean_row_end = 0;          ///< the rest mixes two patterns and must not be decoded
    Image<std::uint8_t> pixels;     ///< rows of width x channels(format) bytes

    [[nodiscard]] int channels() const noexcept { return format == PixelFormat::grey8 ? 1 : 3; }
    [[nodiscard]] int width() const noexcept { return pixels.width() / channels(); }
    [[nodiscard]] int height() const noexcept { return pixels.height(); }
    [[nodiscard]] Size size() const noexcept { return {width(), height()}; }
};

/// @ownership shared; the last holder returns the pixels to their pool.
using FramePtr = std::shared_ptr<const Frame>;

}  // namespace xtrack
