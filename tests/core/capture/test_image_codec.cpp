// SPDX-License-Identifier: Apache-2.0
#include "core/capture/image_codec.hpp"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

namespace xtrack::capture {
namespace {

std::string png(int type) {
    std::vector<unsigned char> bytes;
    cv::imencode(".png", cv::Mat(12, 16, type, cv::Scalar::all(700)), bytes);
    return {bytes.begin(), bytes.end()};
}

TEST(ImageCodec, DepthIsOneChannelOf16Bits) {
    Image<std::uint16_t> depth;
    ASSERT_TRUE(decode_depth(png(CV_16UC1), "a.png", {16, 12}, depth).ok());
    EXPECT_EQ(depth.at(15, 11), 700);
    for (const auto& [type, said] :
         {std::pair{CV_16UC3, "a.png: has 3 channels, depth has one"},
          std::pair{CV_16UC4, "a.png: has 4 channels"}, std::pair{CV_8UC1, "a.png: has 8 bits"}}) {
        const auto read = decode_depth(png(type), "a.png", {16, 12}, depth);
        ASSERT_FALSE(read.ok()) << said;
        EXPECT_THAT(read.error().message, testing::HasSubstr(said));
    }
}

TEST(ImageCodec, OddChunksAreNotChattedAbout) {
    // A gamma of one byte, which libpng knows to be wrong; its checksum is right.
    const std::string odd("\0\0\0\1gAMA\0\x5F\xB8\x03\xCF", 13);
    constexpr std::size_t kHeaderEnd = 8 + 25;
    std::string bytes = png(CV_16UC1);
    const std::string plain = bytes;
    bytes.insert(kHeaderEnd, odd);
    Image<std::uint16_t> depth;
    testing::internal::CaptureStderr();
    const auto read = decode_depth(bytes, "a.png", {16, 12}, depth);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    ASSERT_TRUE(read.ok()) << read.error().message;
    EXPECT_EQ(depth.at(15, 11), 700);
}

}  // namespace
}  // namespace xtrack::capture
