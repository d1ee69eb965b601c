// SPDX-License-Identifier: Apache-2.0
#include "core/capture/image_codec.hpp"

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

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

std::string jpeg() {
    cv::Mat image(120, 160, CV_8UC3);
    cv::randu(image, 0, 255);
    cv::GaussianBlur(image, image, {9, 9}, 3.0);
    std::vector<unsigned char> bytes;
    cv::imencode(".jpg", image, bytes);
    return {bytes.begin(), bytes.end()};
}

TEST(ImageCodec, JpegsAreThePixelsThatOpenCvSees) {
    const std::string bytes = jpeg();
    const cv::Mat encoded(1, static_cast<int>(bytes.size()), CV_8UC1,
                          const_cast<char*>(bytes.data()));  // NOLINT: OpenCV reads only
    for (const PixelFormat format : {PixelFormat::grey8, PixelFormat::bgr8}) {
        const bool grey = format == PixelFormat::grey8;
        const cv::Mat want = cv::imdecode(encoded, grey ? cv::IMREAD_GRAYSCALE : cv::IMREAD_COLOR);
        Image<std::uint8_t> read;
        ASSERT_TRUE(decode_image(bytes, "a.jpg", {160, 120}, format, read).ok());
        for (int y = 0; y < want.rows; ++y) {
            ASSERT_TRUE(std::equal(read.row(y), read.row(y) + read.width(), want.ptr(y))) << y;
        }
    }
}

TEST(ImageCodec, RuinedJpegsAreRefusedInSilence) {
    const std::string whole = jpeg();
    const std::string end = "\xFF\xD9";
    const std::size_t third = whole.size() / 3;
    std::string zeros = whole;
    zeros.replace(2 * third, third / 2, third / 2, '\0');
    const std::string missing = whole.substr(0, 2 * third) + end;
    const std::string too_much = whole.substr(0, whole.size() - 2) + std::string(2000, '\0') + end;
    for (const std::string& bytes : {zeros, missing, too_much}) {
        Image<std::uint8_t> read;
        testing::internal::CaptureStderr();
        const auto result = decode_image(bytes, "a.jpg", {160, 120}, PixelFormat::grey8, read);
        EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
        ASSERT_FALSE(result.ok());
        EXPECT_THAT(result.error().message, testing::HasSubstr("a.jpg: the JPEG is damaged"));
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
