// SPDX-License-Identifier: Apache-2.0
#include "core/light/ramp.hpp"

#include <cmath>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <xtrack/method.hpp>

namespace xtrack {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

PatternSequence flats(const std::vector<double>& levels) {
    PatternSequence s;
    s.projector_size = {64, 48};
    for (const double level : levels) {
        Pattern p;
        p.level = level;
        s.patterns.push_back(p);
    }
    return s;
}

TEST(Ramp, IsSortedByTheValuesThatEightBitsShow) {
    const Ramp ramp = Ramp::of(flats({1.0, 0.0, 0.5, 0.501}));
    ASSERT_EQ(ramp.steps.size(), 3U);  // two round to 128
    EXPECT_EQ(ramp.black(), 1);
    EXPECT_EQ(ramp.white(), 0);
    EXPECT_DOUBLE_EQ(ramp.steps[1].value, 128.0 / 255.0);
    EXPECT_TRUE(ramp.has_ends());
    EXPECT_FALSE(Ramp::of(flats({0.1, 1.0})).has_ends());
    EXPECT_TRUE(Ramp::of(light_sequence(Axis::x, {1280, 720})).has_ends());
}

TEST(Ramp, FallsOfNoiseArePooledAndOthersNamed) {
    const Ramp ramp = Ramp::of(flats({0.0, 0.2, 0.4, 0.6, 0.8, 1.0}));
    std::vector<double> shares{0.0, 0.30, 0.296, 0.5, 0.7, 1.0};
    ASSERT_TRUE(check_rising(ramp, shares));
    pool_falls(shares);
    EXPECT_NEAR(shares[1], 0.298, 1e-12);
    EXPECT_NEAR(shares[2], 0.298, 1e-12);
    EXPECT_EQ(shares[3], 0.5);
    const auto refused = check_rising(ramp, std::vector<double>{0.0, 0.3, 0.5, 0.4, 0.7, 1.0});
    ASSERT_FALSE(refused);
    EXPECT_THAT(refused.error().message,
                HasSubstr("the flat of 60 % is darker in the images than that of 40 %"));
}

TEST(Ramp, PoolsAgainstWhatCameBefore) {
    std::vector<double> shares{-0.01, 0.5, 0.3, 0.1, 0.9, 1.02};
    pool_falls(shares);
    EXPECT_THAT(shares,
                ElementsAre(0.0, testing::DoubleNear(0.3, 1e-12), testing::DoubleNear(0.3, 1e-12),
                            testing::DoubleNear(0.3, 1e-12), 0.9, 1.0));
}

TEST(Ramp, IsResampledAtEqualSteps) {
    const Ramp ramp = Ramp::of(flats({0.0, 51.0 / 255.0, 1.0}));
    // A straight line stays one, wherever its steps are.
    const std::vector<double> light = equal_steps(ramp, std::vector<double>{0.0, 0.2, 1.0});
    EXPECT_THAT(light, ElementsAre(0.0, testing::DoubleNear(0.5, 1e-12), 1.0));
}

TEST(Ramp, NearestGammaOfAPowerIsThePower) {
    std::vector<double> light;
    for (int i = 0; i <= 17; ++i) {
        light.push_back(std::pow(i / 17.0, 1.7));
    }
    EXPECT_NEAR(nearest_gamma(light), 1.7, 1e-9);
}

}  // namespace
}  // namespace xtrack
