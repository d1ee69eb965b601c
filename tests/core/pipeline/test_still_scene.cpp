// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/still_scene.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace xtrack {
namespace {

constexpr Size kImage{48, 32};
constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
constexpr int kX = 20, kY = 16;
constexpr float kTurn_rad = 6.2831853F;

/// A surface of one phase with all its turns, before it a plate of another.
class Still : public testing::Test {
 protected:
    /// One image, 33 ms after the last, and what is learnt of it.
    void show(float wall_rad, float wall_grey) {
        phase_.fill(std::remainder(wall_rad, kTurn_rad));
        turned_.fill(wall_rad);
        light_.fill(wall_grey);
        ids_.fill(1);
    }
    void plate(float rad, float grey) {
        for (int y = 8; y < 24; ++y) {
            for (int x = 12; x < 28; ++x) {
                phase_.at(x, y) = std::remainder(rad, kTurn_rad);
                turned_.at(x, y) = rad;
                light_.at(x, y) = grey;
            }
        }
    }
    void look() { scene_.divide(phase_.view(), light_.view()); }
    void learn() {
        look();
        scene_.learn(turned_.view(), ids_.view(), light_.view(), 1.0, Stamp::from_us(now_us_));
        now_us_ += 33000;
    }
    void learn(int images) {
        for (int n = 0; n < images; ++n) {
            learn();
        }
    }
    [[nodiscard]] bool stands(int x, int y) const {
        return !std::isnan(scene_.still_rad().at(x, y));
    }
    [[nodiscard]] bool moves(int x, int y) const {
        return !std::isnan(scene_.moving_rad().at(x, y));
    }

    StillScene scene_{kImage};
    Image<float> phase_{kImage.width, kImage.height, kNone};
    Image<float> turned_{kImage.width, kImage.height, kNone};
    Image<float> light_{kImage.width, kImage.height, 0.0F};
    Image<std::uint16_t> ids_{kImage.width, kImage.height, 1};
    std::int64_t now_us_ = 0;
};

TEST_F(Still, WhatRestsKeepsItsTurns) {
    show(20.0F, 40.0F);
    learn();
    EXPECT_TRUE(moves(kX, kY)) << "nothing is known yet";
    learn(8);
    look();
    EXPECT_EQ(scene_.still_pixels(), kImage.width * kImage.height);
    EXPECT_NEAR(scene_.still_rad().at(kX, kY), 20.0F, 1e-4);
    // A little off is the same surface, and keeps what it is off.
    show(20.2F, 40.0F);
    look();
    EXPECT_NEAR(scene_.still_rad().at(kX, kY), 20.2F, 1e-4);
    scene_.forget();
    look();
    EXPECT_EQ(scene_.still_pixels(), 0);
}

TEST_F(Still, AThingBeforeItMovesThoughItsPhaseGoesOn) {
    show(20.0F, 40.0F);
    learn(9);
    plate(20.0F + kTurn_rad, 90.0F);
    look();
    EXPECT_TRUE(moves(kX, kY));
    EXPECT_FALSE(stands(kX, kY));
    EXPECT_TRUE(stands(4, 4));
    // Its outline is of two surfaces.
    EXPECT_FALSE(moves(12, kY));
    EXPECT_FALSE(stands(12, kY));
    // A shadow's penumbra is not: it is dark alone.
    show(20.0F, 40.0F);
    plate(20.0F, 20.0F);
    look();
    EXPECT_TRUE(stands(kX, kY));
}

TEST_F(Still, WhatIsInFrontIsTakenInLateAndWhatIsBehindSoon) {
    show(20.0F, 40.0F);
    learn(9);
    plate(24.0F, 40.0F);
    learn(150);  // five seconds
    look();
    EXPECT_TRUE(moves(kX, kY)) << "a hand that rests";
    learn(220);
    look();
    EXPECT_TRUE(stands(kX, kY)) << "furniture";
    EXPECT_NEAR(scene_.known_rad().at(kX, kY), 24.0F, 1e-3);
    show(20.0F, 40.0F);
    learn();
    EXPECT_FALSE(stands(kX, kY));
    learn(20);
    look();
    EXPECT_TRUE(stands(kX, kY));
}

TEST_F(Still, WhatWasNeverSeenGoesOnFromWhatIsBesideIt) {
    show(20.0F, 40.0F);
    for (int y = 8; y < 24; ++y) {  // a shadow from the start
        for (int x = 12; x < 28; ++x) {
            phase_.at(x, y) = kNone;
            ids_.at(x, y) = 0;
        }
    }
    learn(9);
    show(20.0F, 40.0F);
    look();
    EXPECT_TRUE(stands(kX, kY));
    EXPECT_NEAR(scene_.still_rad().at(kX, kY), 20.0F, 1e-3);
    plate(22.0F, 40.0F);
    look();
    EXPECT_TRUE(moves(kX, kY)) << "another phase";
    plate(20.0F, 90.0F);
    look();
    EXPECT_TRUE(moves(kX, kY)) << "another light";
}

}  // namespace
}  // namespace xtrack
