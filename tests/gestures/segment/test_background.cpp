// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>

#include "gestures/segment/background.hpp"

namespace xtrack::segment {
namespace {

/// Two pixels: a hand may stand before the first.
struct Scene {
    Background background;
    std::array<float, 2> z{};
    std::array<float, 2> foreground{};
    std::array<std::uint8_t, 2> hand{};

    explicit Scene(const Background::Settings& settings = {}) { background.create(2, settings); }
    void run(std::int64_t ms, std::int64_t step_ms = 50) {
        for (std::int64_t t = 0; t < ms; t += step_ms) {
            background.learn(z, hand, step_ms);
        }
        background.mask(z, foreground);
    }
};

TEST(Background, WallIsLearntWithinItsHold) {
    Scene scene;
    scene.z = {1000.0F, 1000.0F};
    scene.run(1500);
    EXPECT_EQ(scene.foreground[0], 1000.0F) << "not yet";
    scene.run(1000);
    EXPECT_EQ(scene.foreground[0], 0.0F);
    scene.z[0] = 980.0F;
    scene.background.mask(scene.z, scene.foreground);
    EXPECT_EQ(scene.foreground[0], 980.0F) << "nearer than the margin";
}

TEST(Background, HandOfTheFirstFrameMayRest) {
    Scene scene;
    scene.z = {600.0F, 1000.0F};
    scene.hand = {1, 0};
    scene.run(25'000);
    EXPECT_EQ(scene.foreground[0], 600.0F);
    EXPECT_EQ(scene.foreground[1], 0.0F);
    scene.run(10'000);
    EXPECT_EQ(scene.foreground[0], 0.0F) << "after hand_rest it is furniture";
    // It goes: the wall behind shows, and it may come back at once.
    scene.hand = {0, 0};
    scene.z[0] = 1000.0F;
    scene.run(100);
    scene.z[0] = 600.0F;
    scene.background.mask(scene.z, scene.foreground);
    EXPECT_EQ(scene.foreground[0], 600.0F);
}

TEST(Background, HandBeforeAKnownWallMayRest) {
    Scene scene;
    scene.z = {1000.0F, 1000.0F};
    scene.run(3000);
    scene.z[0] = 700.0F;
    scene.hand = {1, 0};
    scene.run(25'000);
    EXPECT_EQ(scene.foreground[0], 700.0F);
}

TEST(Background, HolesTeachNothing) {
    Scene scene;
    scene.z = {1000.0F, 1000.0F};
    scene.run(3000);
    scene.z[0] = 0.0F;
    scene.run(60'000);
    scene.z[0] = 1000.0F;
    scene.background.mask(scene.z, scene.foreground);
    EXPECT_EQ(scene.foreground[0], 0.0F);
}

TEST(Background, AStalledStreamProvesNothing) {
    Scene scene;
    scene.z = {1000.0F, 1000.0F};
    scene.background.learn(scene.z, scene.hand, 0);
    scene.background.learn(scene.z, scene.hand, 3'600'000);
    scene.background.mask(scene.z, scene.foreground);
    EXPECT_EQ(scene.foreground[0], 1000.0F);
}

}  // namespace
}  // namespace xtrack::segment
