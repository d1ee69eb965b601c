// SPDX-License-Identifier: Apache-2.0
#include "core/unwrap/region_links.hpp"

#include <gtest/gtest.h>

namespace xtrack {
namespace {

class RegionLinksTest : public testing::Test {
 protected:
    RegionLinksTest() {
        forest_.reserve(64);
        links_.reserve(256);
    }
    void link(std::uint32_t a, std::uint32_t b, std::int32_t order, std::uint32_t sound,
              std::uint32_t contact) {
        RegionLink link{a, b, order, sound * kSoundVotes, contact};
        links_.add(forest_, link);
    }
    [[nodiscard]] bool together(std::uint32_t a, std::uint32_t b) {
        return forest_.find(a).root == forest_.find(b).root;
    }
    /// Order of b when that of a is 0.
    [[nodiscard]] int order(std::uint32_t a, std::uint32_t b) {
        return forest_.find(b).order - forest_.find(a).order;
    }

    OrderForest forest_;
    RegionLinks links_;
};

TEST_F(RegionLinksTest, OrdersAddUpAlongAChain) {
    for (int i = 0; i < 40; ++i) {
        forest_.add(100);
    }
    for (std::uint32_t i = 0; i + 1 < 40; ++i) {
        // Named from either side.
        i % 2 == 0 ? link(i, i + 1, 2, 20, 20) : link(i + 1, i, -2, 20, 20);
    }
    links_.join_all(forest_, 0.5);
    EXPECT_TRUE(together(0, 39));
    EXPECT_EQ(order(0, 39), 78);
    EXPECT_EQ(order(25, 4), -42);
    EXPECT_EQ(forest_.pixels(forest_.find(7).root), 4000U);
}

TEST_F(RegionLinksTest, TheMajorityDecidesTheOrder) {
    const auto a = forest_.add(1000), b = forest_.add(1000);
    link(a, b, 1, 9, 9);
    link(a, b, 0, 30, 30);
    link(b, a, -1, 8, 8);
    links_.join_all(forest_, 0.5);
    EXPECT_TRUE(together(a, b));
    EXPECT_EQ(order(a, b), 0);
}

TEST_F(RegionLinksTest, SurfacesThatAgreeInPlacesOnlyStayApart) {
    const auto a = forest_.add(1000), b = forest_.add(1000);
    link(a, b, 1, 40, 40);
    link(a, b, 0, 0, 60);
    links_.join_all(forest_, 0.5);
    EXPECT_FALSE(together(a, b));
    links_.join_all(forest_, 0.3);
    EXPECT_TRUE(together(a, b));
    EXPECT_EQ(order(a, b), 1);
}

TEST_F(RegionLinksTest, AFragmentIsNoBridge) {
    const auto a = forest_.add(1000), b = forest_.add(1000), fragment = forest_.add(3);
    link(a, b, 0, 0, 50);
    link(a, fragment, 0, 3, 3);
    link(fragment, b, 1, 2, 3);
    links_.join_all(forest_, 0.5);
    EXPECT_TRUE(together(a, fragment));
    EXPECT_FALSE(together(a, b));
}

TEST_F(RegionLinksTest, TheStrongerPathIsTakenFirst) {
    // Round a ring the orders do not close; the weakest contact gives way.
    const auto a = forest_.add(1000), b = forest_.add(1000), c = forest_.add(1000);
    link(a, b, 1, 10, 12);
    link(b, c, 0, 50, 50);
    link(c, a, 0, 40, 41);
    links_.join_all(forest_, 0.5);
    EXPECT_TRUE(together(a, b));
    EXPECT_EQ(order(a, b), 0);
    EXPECT_EQ(order(a, c), 0);
}

TEST_F(RegionLinksTest, WithoutVotesNothingIsJoined) {
    const auto a = forest_.add(5), b = forest_.add(5);
    links_.join_all(forest_, 0.0);
    link(a, b, 0, 0, 5);
    links_.join_all(forest_, 0.0);
    EXPECT_FALSE(together(a, b));
}

}  // namespace
}  // namespace xtrack
