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

TEST(ImageCodec, PngsAreThePixelsThatOpenCvSees) {
    cv::Mat colour(12, 16, CV_8UC3);
    cv::randu(colour, 0, 255);
    cv::Mat alpha;
    cv::cvtColor(colour, alpha, cv::COLOR_BGR2BGRA);
    cv::Mat plain;
    cv::cvtColor(colour, plain, cv::COLOR_BGR2GRAY);
    for (const cv::Mat& image : {colour, alpha, plain}) {
        std::vector<unsigned char> encoded;
        cv::imencode(".png", image, encoded);
        for (const PixelFormat format : {PixelFormat::grey8, PixelFormat::bgr8}) {
            const bool grey = format == PixelFormat::grey8;
            const cv::Mat want =
                cv::imdecode(encoded, grey ? cv::IMREAD_GRAYSCALE : cv::IMREAD_COLOR);
            Image<std::uint8_t> read;
            ASSERT_TRUE(decode_image(std::string(encoded.begin(), encoded.end()), "a.png", {16, 12},
                                     format, read)
                            .ok());
            for (int y = 0; y < want.rows; ++y) {
                ASSERT_TRUE(std::equal(read.row(y), read.row(y) + read.width(), want.ptr(y))) << y;
            }
        }
    }
    Image<std::uint16_t> depth(16, 12);
    for (int i = 0; i < 16 * 12; ++i) {
        depth.row(i / 16)[i % 16] = static_cast<std::uint16_t>(i * 341);
    }
    Image<std::uint16_t> read;
    ASSERT_TRUE(decode_depth(*encode_png(depth.view()), "a.png", {16, 12}, read).ok());
    for (int y = 0; y < 12; ++y) {
        ASSERT_TRUE(std::equal(read.row(y), read.row(y) + 16, depth.row(y))) << y;
    }
}

TEST(ImageCodec, TornAndFlippedPngsAreRefusedInSilence) {
    Image<std::uint16_t> image(40, 30, 1234);
    const std::string whole = *encode_png(image.view());
    Image<std::uint16_t> read;
    testing::internal::CaptureStderr();
    for (std::size_t i = 0; i < whole.size(); ++i) {
        EXPECT_FALSE(decode_depth(whole.substr(0, i), "a.png", {40, 30}, read).ok()) << i;
        std::string flipped = whole;
        flipped[i] = static_cast<char>(flipped[i] ^ 0x20);
        EXPECT_FALSE(decode_depth(flipped, "a.png", {40, 30}, read).ok()) << i;
    }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

// The checksums hold; what is wrong is in the compressed rows.
TEST(ImageCodec, PngsOfOtherHeightThanTheirRowsAreRefusedInSilence) {
    const std::string tall = png(CV_16UC1);
    Image<std::uint16_t> other(16, 20, 700);
    const std::string of_20_rows = *encode_png(other.view());
    constexpr std::size_t kHeaderEnd = 8 + 25;
    Image<std::uint16_t> read;
    testing::internal::CaptureStderr();
    const auto short_of_rows = decode_depth(
        of_20_rows.substr(0, kHeaderEnd) + tall.substr(kHeaderEnd), "a.png", {16, 20}, read);
    const auto with_more_rows = decode_depth(
        tall.substr(0, kHeaderEnd) + of_20_rows.substr(kHeaderEnd), "a.png", {16, 12}, read);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    for (const auto* result : {&short_of_rows, &with_more_rows}) {
        ASSERT_FALSE(result->ok());
        EXPECT_EQ(result->error().code, ErrorCode::malformed);
        EXPECT_THAT(result->error().message, testing::HasSubstr("a.png: the PNG is damaged"));
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
