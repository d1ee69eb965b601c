// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "gestures/segment/grid.hpp"
#include "gestures/segment/parts.hpp"
#include "tests/gestures/track/synthetic_hand.hpp"

namespace xtrack::segment {
namespace {

constexpr float kNearMm = 150.0F;
constexpr float kThickMm = 62.0F;
constexpr float kAreaMinMm2 = 1800.0F;

struct Cut {
    test::Scene scene;
    Grid grid;
    Parts parts;

    explicit Cut(Size size = {640, 480}) : scene(size) {
        grid.create(scene.rig, size, Grid::fine_scale(size), Grid::fine_scale(size));
        parts.create(grid);
    }
    void run() {
        grid.load(scene.depth, kNearMm);
        parts.find(grid, grid.z, kThickMm, kAreaMinMm2);
    }
};

TEST(Grid, HalvesAndKeepsTheNearestSurface) {
    Cut cut;
    cut.scene.wall(1000.0F);
    cut.scene.depth.depth.at(100, 100) = 9950;  // 995 mm: the same surface as its three neighbours
    cut.scene.depth.depth.at(200, 200) = 6000;  // a flying pixel
    cut.scene.depth.depth.at(300, 300) = 0;     // a hole
    cut.grid.load(cut.scene.depth, kNearMm);
    EXPECT_EQ(cut.grid.scale, 2);
    const auto z = [&](int x, int y) {
        return cut.grid.z[static_cast<std::size_t>(cut.grid.index(x, y))];
    };
    EXPECT_NEAR(z(50, 50), 998.75F, 0.01F);
    EXPECT_NEAR(z(100, 100), 1000.0F, 0.01F) << "dropped, and closed from its neighbours";
    EXPECT_NEAR(z(150, 150), 1000.0F, 0.01F);
    EXPECT_EQ(z(-1, 5), 0.0F) << "padding";
}

TEST(Grid, PointsLieOnTheirRays) {
    Cut cut;
    cut.scene.wall(600.0F);
    cut.grid.load(cut.scene.depth, kNearMm);
    // Grid pixel 0 covers image pixels 0 and 1: its centre is at 0.5; cx = 319.5, f = 600.
    const Vec3f p = cut.grid.point(cut.grid.index(0, 0));
    EXPECT_NEAR(p.x(), (0.5F - 319.5F) / 600.0F * 600.0F, 0.01F);
    EXPECT_NEAR(p.z(), 600.0F, 0.01F);
}

TEST(Parts, WallIsBodyAlone) {
    Cut cut;
    cut.scene.wall(1000.0F);
    cut.run();
    EXPECT_TRUE(cut.parts.parts().empty());
    ASSERT_EQ(cut.parts.bodies().size(), 1U);
    EXPECT_NEAR(cut.parts.bodies()[0].depth_mm, 1000.0F, 0.1F);
}

TEST(Parts, HandBeforeAWallIsOnePart) {
    Cut cut;
    cut.scene.wall(1200.0F);
    test::SyntheticHand hand;
    hand.draw(cut.scene);
    cut.run();
    // What the hand leaves of the wall between itself and the border may be thin, too.
    int hands = 0;
    Part part;
    for (const Part& p : cut.parts.parts()) {
        if (cut.grid.z[static_cast<std::size_t>(cut.parts.pixels(p)[0])] < 1000.0F) {
            part = p;
            ++hands;
        }
    }
    ASSERT_EQ(hands, 1);
    EXPECT_NEAR(part.thickest_mm, test::SyntheticHand::kPalmRadiusMm, 5.0F);
    EXPECT_EQ(part.root_pixels, 0);
    EXPECT_TRUE(part.touches_border) << "the forearm leaves the image";
}

TEST(Parts, ArmIsCutFromTheTorso) {
    Cut cut;
    cut.scene.person(0.0F, 900.0F);
    // An arm that grows out of the chest's side without a step in depth.
    cut.scene.capsule({150.0F, 120.0F, 960.0F}, {330.0F, 60.0F, 900.0F}, 38.0F, 30.0F);
    cut.run();
    ASSERT_GE(cut.parts.bodies().size(), 1U);
    bool arm = false;
    for (const Part& part : cut.parts.parts()) {
        const int middle = cut.parts.pixels(part)[cut.parts.pixels(part).size() / 2];
        if (cut.grid.point(middle).x() > 200.0F) {
            arm = true;
            EXPECT_GT(part.root_pixels, 0);
            EXPECT_LT(part.root_mm.x(), 240.0F);
            EXPECT_LT(part.thickest_mm, kThickMm);
        }
    }
    EXPECT_TRUE(arm);
}

TEST(Parts, RadiusIsTheInscribedCircles) {
    Cut cut;
    cut.scene.ball({0.0F, 0.0F, 600.0F}, 50.0F);
    cut.run();
    ASSERT_EQ(cut.parts.parts().size(), 1U);
    // The silhouette is seen 50 mm wide at the ball's centre depth, measured at its front (550 mm).
    EXPECT_NEAR(cut.parts.parts()[0].thickest_mm, 50.0F * 550.0F / 600.0F, 3.0F);
}

}  // namespace
}  // namespace xtrack::segment
