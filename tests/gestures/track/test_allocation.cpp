// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdlib>

#include <xtrack/hand_tracker.hpp>

#include "tests/gestures/track/synthetic_hand.hpp"
#include "tests/support/allocation_counter.hpp"

namespace xtrack {
namespace {

TEST(HandTrackerAllocation, NoneInSteadyState) {
    if (!test::counts_allocations()) {
        GTEST_SKIP()
            << "allocations cannot be counted here: no glibc, or a sanitizer is in its way";
    }
    test::Scene scene;
    Result<HandTracker> made = HandTracker::create(scene.rig, scene.depth.depth.size());
    ASSERT_TRUE(made.ok());
    HandTracker tracker = std::move(made.value());
    long counted = -1;
    std::size_t seen = 0;
    for (int k = 0; k < 12; ++k) {
        scene.clear();
        scene.wall(1500.0F);
        scene.person(0.0F, 1000.0F);
        test::SyntheticHand hand;
        hand.palm_mm = {-100.0F + 10.0F * static_cast<float>(k), 0.0F, 600.0F};
        if (k != 6) {
            hand.draw(scene);
        }
        scene.noise(1.0, 0.05, static_cast<unsigned>(k));
        scene.depth.stamp = Stamp::from_us(k * 33'333);
        const long before = test::allocations();
        seen += tracker.track(scene.depth).count;
        if (k > 0) {
            counted = std::max(counted, test::allocations() - before);
        }
    }
    EXPECT_EQ(counted, 0);
    EXPECT_EQ(seen, 11U);
    const long before = test::allocations();
    void* volatile some = std::malloc(16);  // volatile: else the pair is optimised away
    std::free(some);
    EXPECT_GE(test::allocations() - before, 1) << "the count counts";
}

}  // namespace
}  // namespace xtrack
