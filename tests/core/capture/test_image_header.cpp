// SPDX-License-Identifier: Apache-2.0
#include "core/capture/image_header.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/capture/image_codec.hpp"

namespace xtrack::capture {
namespace {

using testing::HasSubstr;

std::string png() {
    Image<std::uint16_t> image(40, 30, 1234);
    return *encode_png(image.view());
}

TEST(ImageHeader, ReadsHeaders) {
    const auto info = peek_image(png(), "a.png");
    ASSERT_TRUE(info.ok()) << info.error().message;
    EXPECT_EQ(info->size, (Size{40, 30}));
    EXPECT_EQ(info->bits, 16);
    EXPECT_EQ(info->channels, 1);
    Image<std::uint8_t> colour(3 * 8, 6, 9);
    const auto of_colour = peek_image(*encode_png(colour.view(), PixelFormat::bgr8), "b.png");
    ASSERT_TRUE(of_colour.ok());
    EXPECT_EQ(of_colour->size, (Size{8, 6}));
    EXPECT_EQ(of_colour->channels, 3);
}

TEST(ImageHeader, AClaimOfAbsurdSizeIsRefusedBeforeItIsReserved) {
    // The header of a PNG of 10^9 x 10^9; its checksum does not matter to a peek.
    std::string bytes = png();
    bytes.replace(16, 8, std::string("\x3B\x9A\xCA\x00\x3B\x9A\xCA\x00", 8));
    const auto info = peek_image(bytes, "a.png");
    ASSERT_TRUE(info.ok());
    EXPECT_EQ(info->size.width, 1000000000);
    Image<std::uint16_t> out;
    const auto decoded = decode_depth(bytes, "a.png", {40, 30}, out);
    ASSERT_FALSE(decoded.ok());
    EXPECT_THAT(decoded.error().message, HasSubstr("a.png"));
}

TEST(ImageHeader, DepthOfTheWrongKindIsNamed) {
    Image<std::uint8_t> grey(40, 30, 9);
    Image<std::uint16_t> out;
    const auto decoded =
        decode_depth(*encode_png(grey.view(), PixelFormat::grey8), "a.png", {40, 30}, out);
    ASSERT_FALSE(decoded.ok());
    EXPECT_THAT(decoded.error().message, HasSubstr("8 bits a channel; save it with 16"));
    EXPECT_FALSE(peek_image("GIF89a...............................", "a.gif").ok());
}

}  // namespace
}  // namespace xtrack::capture
