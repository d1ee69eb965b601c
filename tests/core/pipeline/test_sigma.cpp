// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <xtrack/depth_decoder.hpp>

#include "tests/core/pipeline/plane_scene.hpp"

namespace xtrack {
namespace {

constexpr Size kProjector{512, 384};

struct Camera {
    double read_levels = 0.0;
    double electrons_per_level = 1e5;
};

std::shared_ptr<Frame> noisy_frame(const PatternSequence& patterns, int number, double z_mm,
                                   const Camera& camera, std::mt19937& random, PixelFormat format) {
    const int count = static_cast<int>(patterns.patterns.size());
    auto frame =
        test::plane_frame(test::plane_rig(), patterns, number % count, number, z_mm, format);
    std::normal_distribution<double> noise(0.0, 1.0);
    for (int y = 0; y < frame->pixels.height(); ++y) {
        for (int x = 0; x < frame->pixels.width(); ++x) {
            const double grey = frame->pixels.at(x, y);
            const double sigma = std::sqrt(camera.read_levels * camera.read_levels +
                                           grey / camera.electrons_per_level);
            frame->pixels.at(x, y) = static_cast<std::uint8_t>(
                std::lround(std::clamp(grey + sigma * noise(random), 0.0, 255.0)));
        }
    }
    return frame;
}

// Root mean square of error / sigma: 1 where sigma tells the truth.
double error_in_sigmas(const PatternSequence& patterns, double z_mm, const Camera& camera,
                       PixelFormat format = PixelFormat::grey8) {
    DecodeSettings settings;
    settings.keep_maps = true;
    settings.motion = MotionHandling::off;
    // Rounding to whole levels is noise too.
    settings.read_noise_levels = std::sqrt(camera.read_levels * camera.read_levels + 1.0 / 12.0);
    settings.electrons_per_level = camera.electrons_per_level;
    auto decoder =
        DepthDecoder::create(test::plane_rig(), patterns, test::plane_rig().camera.size, settings);
    EXPECT_TRUE(decoder) << decoder.error().message;
    std::mt19937 random(9);
    double squares = 0.0;
    double pixels = 0.0;
    for (int n = 0; n < 12; ++n) {
        if (decoder->push(noisy_frame(patterns, n, z_mm, camera, random, format)).state !=
            DecodeState::depth_ready) {
            continue;
        }
        const DepthFrame& depth = decoder->depth();
        for (int y = 0; y < depth.depth.height(); ++y) {
            for (int x = 0; x < depth.depth.width(); ++x) {
                const auto sigma = static_cast<double>(decoder->sigma_mm().at(x, y));
                const double error = 0.1 * depth.depth.at(x, y) - z_mm;
                EXPECT_EQ(sigma > 0.0, depth.depth.at(x, y) != 0);
                if (sigma > 0.0 && std::fabs(error) < 12.0 * sigma) {
                    squares += error * error / (sigma * sigma);
                    pixels += 1.0;
                }
            }
        }
    }
    EXPECT_GT(pixels, 1000.0);
    return std::sqrt(squares / pixels);
}

TEST(Sigma, IsTheSpreadOfTheDepth) {
    const PatternSequence wide = three_step_sequence(Axis::x, kProjector, 512.0);
    const PatternSequence dual = dual_sequence(Axis::x, kProjector, 512.0, 64.0);
    const PatternSequence four = n_step_sequence(Axis::x, kProjector, 512.0, 4);
    const PatternSequence gray = gray_code_sequence(Axis::x, kProjector, 64.0);
    for (const double z_mm : {500.0, 700.0, 1000.0}) {
        for (const Camera& camera : {Camera{1.5, 1e5}, Camera{0.5, 30.0}}) {
            EXPECT_NEAR(error_in_sigmas(wide, z_mm, camera), 1.0, 0.1) << z_mm;
            EXPECT_NEAR(error_in_sigmas(dual, z_mm, camera), 1.0, 0.1) << z_mm;
            EXPECT_NEAR(error_in_sigmas(four, z_mm, camera), 1.0, 0.1) << z_mm;
            EXPECT_NEAR(error_in_sigmas(gray, z_mm, camera), 1.0, 0.1) << z_mm;
        }
    }
}

TEST(Sigma, KnowsTheTapsOfColours) {
    const PatternSequence rgb = rgb_sequence(Axis::x, kProjector, {512.0, 64.0});
    EXPECT_NEAR(error_in_sigmas(rgb, 700.0, {1.5, 1e5}, PixelFormat::bgr8), 1.0, 0.2);
}

TEST(Sigma, IsKeptOnlyOnRequest) {
    const auto decoder = DepthDecoder::create(
        test::plane_rig(), three_step_sequence(Axis::x, kProjector, 512.0), {96, 64}, {});
    ASSERT_TRUE(decoder);
    EXPECT_TRUE(decoder->sigma_mm().empty());
}

}  // namespace
}  // namespace xtrack
