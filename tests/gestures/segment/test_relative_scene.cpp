// SPDX-License-Identifier: Apache-2.0
#include "gestures/segment/relative_scene.hpp"

#include <gtest/gtest.h>
#include <xtrack/paper_decoder.hpp>

namespace xtrack::segment {
namespace {

constexpr Size kImage{320, 240};
constexpr double kBackground_mm = 1000.0;
constexpr double kMmPerPx = 2.0;
constexpr std::uint16_t kStill = PaperDecoder::kStill;
constexpr std::uint16_t kHand = 1;

/// Relative depth of discs before a background, which are hands or heads.
class RelativeScenes : public testing::Test {
 protected:
    RelativeScenes() { clear(); }

    void clear() {
        relative_.metric = false;
        relative_.depth = Image<std::uint16_t>(kImage.width, kImage.height, code(0.0));
        relative_.quality = Image<std::uint8_t>(kImage.width, kImage.height, 255);
        component_ = Image<std::uint16_t>(kImage.width, kImage.height, kStill);
    }
    [[nodiscard]] std::uint16_t code(double height_px) const {
        return static_cast<std::uint16_t>((kBackground_mm - kMmPerPx * height_px) /
                                          relative_.depth_unit_mm);
    }
    void disc(int x, int y, int radius, double height_px, std::uint16_t id) {
        for (int v = y - radius; v <= y + radius; ++v) {
            for (int u = x - radius; u <= x + radius; ++u) {
                if ((u - x) * (u - x) + (v - y) * (v - y) <= radius * radius) {
                    relative_.depth.at(u, v) = code(height_px);
                    component_.at(u, v) = id;
                }
            }
        }
    }
    /// @return how often the scale was made anew
    int show(int images, bool followed = false) {
        int scales = 0;
        for (int n = 0; n < images; ++n) {
            scales += scene_.update(relative_, component_, 1, followed) ? 1 : 0;
        }
        return scales;
    }
    [[nodiscard]] double depth_mm(int u, int v) const {
        return scene_.depth().depth.at(u, v) * scene_.depth().depth_unit_mm;
    }

    DepthFrame relative_;
    Image<std::uint16_t> component_;
    RelativeScene scene_{kImage, kBackground_mm, kMmPerPx};
};

// A palm of 40 mm that is 20 px wide is 40 / 20 * 320 mm away where the image is as wide as far.
TEST_F(RelativeScenes, TheHandSaysHowFarAwayItIs) {
    disc(100, 120, 20, 100.0, kHand);
    EXPECT_FALSE(scene_.has_scale());
    EXPECT_EQ(show(4), 0);
    EXPECT_EQ(show(10), 1);
    EXPECT_NEAR(depth_mm(100, 120), 640.0, 40.0);
    EXPECT_EQ(depth_mm(250, 40), 0.0);  // the background is none
    // Nearer is nearer: 1/Z is linear in the height.
    const double z0 = depth_mm(100, 120);
    disc(100, 120, 20, 200.0, kHand);
    EXPECT_EQ(show(1, true), 0);
    const double background = 1.0 / (1.6 * z0);
    EXPECT_NEAR(depth_mm(100, 120), 1.0 / (background + 2.0 * (1.0 / z0 - background)), 15.0);
}

TEST_F(RelativeScenes, AHandThatMovesIsBelievedAndNotABodyThatStands) {
    disc(220, 120, 60, 60.0, kStill);
    ASSERT_EQ(show(10), 1);  // nothing moves: it is all there is
    EXPECT_NEAR(depth_mm(220, 120), 213.0, 15.0);
    disc(100, 120, 20, 100.0, kHand);
    EXPECT_EQ(show(10), 1);
    EXPECT_NEAR(depth_mm(100, 120), 640.0, 40.0);
    EXPECT_EQ(depth_mm(220, 120), 0.0);  // a body, behind the hand
    // A hand that comes to rest is one still.
    disc(100, 120, 20, 100.0, kStill);
    show(1);
    EXPECT_NEAR(depth_mm(100, 120), 640.0, 40.0);
}

TEST_F(RelativeScenes, AScaleThatServesIsKept) {
    disc(100, 120, 20, 100.0, kHand);
    ASSERT_EQ(show(10), 1);
    clear();
    disc(100, 120, 26, 100.0, kHand);
    EXPECT_EQ(show(40, true), 0);  // off by 1.3, and followed
    EXPECT_EQ(show(40, false), 1);
    clear();
    disc(100, 120, 50, 100.0, kHand);
    EXPECT_EQ(show(15, true), 0);
    EXPECT_EQ(show(40, true), 1);  // off by 1.9
}

TEST_F(RelativeScenes, ScrapsAreNoHands) {
    for (int n = 0; n < 12; ++n) {
        disc(20 + 25 * n, 30, 8, 300.0, static_cast<std::uint16_t>(n + 2));
    }
    disc(100, 120, 20, 100.0, kHand);
    ASSERT_EQ(show(10), 1);
    EXPECT_NEAR(depth_mm(100, 120), 640.0, 40.0);
}

}  // namespace
}  // namespace xtrack::segment
