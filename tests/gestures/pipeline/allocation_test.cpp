// SPDX-License-Identifier: Apache-2.0
#include "tests/support/allocation_counter.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <utility>

#include <xtrack/session.hpp>
#include <xtrack/sim.hpp>

namespace xtrack {
namespace {

constexpr int kWarmUp_frames = 90;  // background learnt, every buffer grown to its size
constexpr int kCounted_frames = 90;

TEST(SessionAllocation, NoneAFrameFromTheCameraToTheCallback) {
    if (!test::counts_allocations()) {
        GTEST_SKIP()
            << "allocations cannot be counted here: no glibc, or a sanitizer is in its way";
    }
    auto settings = SimSettings::preset("ideal-60");
    ASSERT_TRUE(settings);
    settings->script = {{SimAction::idle, SimHand::right, 0.0, 0.5},
                        {SimAction::swipe_left, SimHand::right}};
    auto rig = SimulatedRig::create(*settings);
    ASSERT_TRUE(rig) << rig.error().message;
    auto session = Session::create(std::unique_ptr<FrameSource>(std::move(*rig)), {});
    ASSERT_TRUE(session) << session.error().message;
    int events = 0;
    std::size_t hands = 0;
    session->subscribe([&](const GestureEvent&) { ++events; });
    session->subscribe_hands([&](const HandFrame& frame) { hands += frame.count; });

    for (int i = 0; i < kWarmUp_frames; ++i) {
        ASSERT_TRUE(session->step());
    }
    const int events_before = events;
    hands = 0;
    const long before = test::allocations();
    for (int i = 0; i < kCounted_frames; ++i) {
        ASSERT_TRUE(session->step());
    }
    EXPECT_EQ(test::allocations() - before, 0);
    EXPECT_GE(hands, static_cast<std::size_t>(kCounted_frames) * 9 / 10);
    EXPECT_GT(events, events_before) << "the counted frames must hold an event";
}

}  // namespace
}  // namespace xtrack
