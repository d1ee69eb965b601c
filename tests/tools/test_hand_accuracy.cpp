// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <gtest/gtest.h>

#include "tools/hand_accuracy.hpp"

namespace xtrack::tools {
namespace {

constexpr std::uint16_t kTrue = 6000;  // steps of 0.1 mm
constexpr double kLimit_mm = 20.0;

/// A hand of 10 x 10 pixels in the middle, the truth everywhere.
struct Scene {
    Scene() : truth(20, 20, kTrue), mask(20, 20, 6) {
        depth.depth = Image<std::uint16_t>(20, 20, kTrue);
        for (int y = 5; y < 15; ++y) {
            std::fill_n(mask.row(y) + 5, 10, std::uint8_t{1});
        }
    }
    [[nodiscard]] HandAccuracy measure() const {
        return measure_hand(depth, truth.view(), mask.view(), kLimit_mm);
    }
    DepthFrame depth;
    Image<std::uint16_t> truth;
    Image<std::uint8_t> mask;
};

TEST(HandAccuracy, CountsTheHandWithoutItsOutermostPixels) {
    const HandAccuracy hand = Scene().measure();
    EXPECT_EQ(hand.pixels, 36U);
    EXPECT_EQ(hand.close, 36U);
    EXPECT_EQ(hand.rms_mm(), 0.0);
    EXPECT_EQ(hand.off_percent(), 0.0);
    EXPECT_EQ(hand.missing_percent(), 0.0);
}

TEST(HandAccuracy, DepthThatIsDisplacedByThirtyMillimetresIsOff) {
    Scene scene;
    scene.depth.depth.fill(kTrue + 300);
    EXPECT_EQ(scene.measure().off_percent(), 100.0);
    scene.depth.depth.fill(kTrue - 300);
    EXPECT_EQ(scene.measure().off_percent(), 100.0);
    scene.depth.depth.fill(kTrue + 100);
    EXPECT_EQ(scene.measure().off_percent(), 0.0);
    EXPECT_NEAR(scene.measure().rms_mm(), 10.0, 1e-9);
}

TEST(HandAccuracy, TellsMissingFromOff) {
    Scene scene;
    scene.depth.depth.at(8, 8) = 0;
    scene.depth.depth.at(9, 9) = 1;
    scene.depth.depth.at(5, 5) = 0;  // an outermost pixel
    scene.truth.at(10, 10) = 0;      // nobody knows
    const HandAccuracy hand = scene.measure();
    EXPECT_EQ(hand.pixels, 35U);
    EXPECT_EQ(hand.missing, 1U);
    EXPECT_EQ(hand.off, 1U);
    EXPECT_EQ(hand.close, 33U);
}

TEST(HandAccuracy, AHandThatLeavesTheImageHasNoEdgeThere) {
    Scene scene;
    scene.mask.fill(1);
    EXPECT_EQ(scene.measure().pixels, 400U);
}

TEST(HandAccuracy, AddsUpPixels) {
    Scene good;
    Scene bad;
    bad.depth.depth.fill(0);
    HandAccuracy sum = good.measure();
    sum.add(bad.measure());
    EXPECT_EQ(sum.pixels, 72U);
    EXPECT_EQ(sum.missing_percent(), 50.0);
}

}  // namespace
}  // namespace xtrack::tools
