// SPDX-License-Identifier: Apache-2.0
#include <xtrack/relative_depth.hpp>

#include <cmath>
#include <limits>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace xtrack {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr Size kImage{320, 240};

// A wall under fringes of 20 px, as a tilted projector makes them.
double wall(int x, int y) {
    const double u = x / 160.0 - 1.0;
    const double v = y / 120.0 - 1.0;
    return (40.0 + 52.0 * u + 3.0 * v) / (1.0 + 0.05 * u - 0.03 * v);
}

// A bump that grows out of it.
double bump(int x, int y) {
    const double r2 = (x - 170.0) * (x - 170.0) + (y - 110.0) * (y - 110.0);
    return 5.0 * std::exp(-r2 / (2.0 * 35.0 * 35.0));
}

template <typename Phase>
PhaseMap photograph(const Phase& phase) {
    PhaseMap map;
    map.stamp = Stamp::from_us(5000);
    map.period_px = 32.0;
    map.phase_rad.resize(kImage.width, kImage.height);
    map.modulation = Image<float>(kImage.width, kImage.height, 50.0F);
    for (int y = 0; y < kImage.height; ++y) {
        for (int x = 0; x < kImage.width; ++x) {
            map.phase_rad.at(x, y) = static_cast<float>(std::remainder(phase(x, y), 2.0 * kPi));
        }
    }
    return map;
}

double worst(const Image<float>& height, double sign) {
    double worst = 0.0;
    for (int y = 0; y < kImage.height; ++y) {
        for (int x = 0; x < kImage.width; ++x) {
            const double h = static_cast<double>(height.at(x, y));
            worst = std::max(worst, std::isfinite(h) ? std::fabs(h - sign * bump(x, y)) : 100.0);
        }
    }
    return worst;
}

TEST(RelativeDepth, HeightsAreAboveThePlaneOfTheWall) {
    for (const double side : {1.0, -1.0}) {  // on which the projector stands
        auto depth = RelativeDepth::create(kImage).value();
        ASSERT_TRUE(depth.measure(
            photograph([&](int x, int y) { return wall(x, y) + side * bump(x, y); })));
        EXPECT_LT(worst(depth.height_rad(), 1.0), 0.03) << side;
        EXPECT_EQ(depth.component().at(0, 0), 1);
    }
}

TEST(RelativeDepth, HeightsAreAboveALearntBackground) {
    // A wall with a step, which no plane fits.
    const auto background = [](int x, int y) { return wall(x, y) + (x > 90 ? 9.0 : 0.0); };
    auto depth = RelativeDepth::create(kImage).value();
    ASSERT_TRUE(depth.learn_background(photograph(background)));
    ASSERT_TRUE(
        depth.measure(photograph([&](int x, int y) { return background(x, y) - bump(x, y); })));
    EXPECT_LT(worst(depth.height_rad(), 1.0), 1e-4);
}

TEST(RelativeDepth, DepthSaysThatItIsRelative) {
    auto depth = RelativeDepth::create(kImage).value();
    PhaseMap map = photograph([&](int x, int y) { return wall(x, y) + bump(x, y); });
    map.phase_rad.at(3, 4) = std::numeric_limits<float>::quiet_NaN();
    ASSERT_TRUE(depth.measure(map));
    const DepthFrame frame = depth.depth();
    EXPECT_FALSE(frame.metric);
    EXPECT_EQ(frame.stamp, Stamp::from_us(5000));
    EXPECT_EQ(frame.depth.at(3, 4), 0);
    EXPECT_NEAR(frame.depth.at(10, 10), 10000, 5);
    EXPECT_NEAR(frame.depth.at(170, 110), 10000 - 500, 5);
}

// What nothing connects with the wall lies as near to it as whole turns allow.
TEST(RelativeDepth, IslandsArePutNearTheBackground) {
    PhaseMap map = photograph([](int x, int y) {
        const bool island = x > 120 && x < 200 && y > 80 && y < 160;
        return wall(x, y) + (island ? 2.0 * kPi * 3.0 + 1.0 : 0.0);
    });
    for (int y = 78; y <= 162; ++y) {
        for (int x = 118; x <= 202; ++x) {
            if (x <= 120 || x >= 200 || y <= 80 || y >= 160) {
                map.phase_rad.at(x, y) = std::numeric_limits<float>::quiet_NaN();
            }
        }
    }
    auto depth = RelativeDepth::create(kImage).value();
    ASSERT_TRUE(depth.measure(map));
    EXPECT_NEAR(depth.height_rad().at(160, 120), 1.0, 0.02);
    EXPECT_NEAR(depth.height_rad().at(20, 20), 0.0, 0.02);
    EXPECT_EQ(depth.component().at(160, 120), 2);
}

TEST(RelativeDepth, RefusesWhatItCannotMeasure) {
    EXPECT_FALSE(RelativeDepth::create({0, 5}));
    auto depth = RelativeDepth::create(kImage).value();
    PhaseMap nothing = photograph([](int, int) { return 0.0; });
    nothing.phase_rad.fill(std::numeric_limits<float>::quiet_NaN());
    const auto measured = depth.measure(nothing);
    ASSERT_FALSE(measured);
    EXPECT_EQ(measured.error().code, ErrorCode::unsupported);
    EXPECT_THAT(measured.error().message, testing::HasSubstr("empty scene"));
    EXPECT_EQ(depth.measure(PhaseMap{}).error().code, ErrorCode::invalid_argument);
    EXPECT_EQ(depth.learn_background(PhaseMap{}).error().code, ErrorCode::invalid_argument);
    EXPECT_EQ(depth.depth().depth.at(5, 5), 0);
}

}  // namespace
}  // namespace xtrack
