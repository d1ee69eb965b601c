// SPDX-License-Identifier: Apache-2.0
// Counts what the heap is asked for while frames come: nothing, once the pool is warm.
#include <gtest/gtest.h>

#include "tests/core/sim/small_rig.hpp"
#include "tests/support/allocation_counter.hpp"

namespace xtrack {
namespace {

TEST(SimMemory, FramesAndTruthAllocateNothing) {
    if (!test::counts_allocations()) {
        GTEST_SKIP()
            << "allocations cannot be counted here: no glibc, or a sanitizer is in its way";
    }
    for (const char* preset : {"ideal-60", "webcam-30"}) {
        SimSettings s = test::small_settings(preset);
        s.script = {{SimAction::swipe_left, SimHand::right, -1.0, 1.0},
                    {SimAction::idle, SimHand::left, -1.0, 1.0}};
        s.duration_s = 0.4;
        const auto rig = test::make_rig(s);
        (void)rig->next({});
        (void)rig->truth();
        const long before = test::allocations();
        int frames = 0;
        while (rig->next({}).status == SourceStatus::ok) {
            (void)rig->truth();
            ++frames;
        }
        EXPECT_EQ(test::allocations() - before, 0) << preset;
        EXPECT_GT(frames, 10);
    }
}

}  // namespace
}  // namespace xtrack
