// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>

#include <xtrack/hand_tracker.hpp>

#include "tests/gestures/track/synthetic_hand.hpp"

// Every way to the heap ends in one of these; glibc keeps its own under other names.
#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define XTRACK_COUNTS_MALLOC 1
namespace {
std::atomic<long> g_allocations{0};
}
extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
void* malloc(std::size_t n) {
    ++g_allocations;
    return __libc_malloc(n);
}
void* calloc(std::size_t n, std::size_t m) {
    ++g_allocations;
    return __libc_calloc(n, m);
}
void* realloc(void* p, std::size_t n) {
    ++g_allocations;
    return __libc_realloc(p, n);
}
void* aligned_alloc(std::size_t a, std::size_t n) {
    ++g_allocations;
    return __libc_memalign(a, n);
}
}
#endif

namespace xtrack {
namespace {

TEST(HandTrackerAllocation, NoneInSteadyState) {
#ifndef XTRACK_COUNTS_MALLOC
    GTEST_SKIP() << "malloc cannot be counted here: no glibc, or a sanitizer has taken it";
#else
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
        const long before = g_allocations;
        seen += tracker.track(scene.depth).count;
        if (k > 0) {
            counted = std::max(counted, g_allocations - before);
        }
    }
    EXPECT_EQ(counted, 0);
    EXPECT_EQ(seen, 11U);
    const long before = g_allocations;
    delete new int(1);
    std::free(std::malloc(16));
    EXPECT_GE(g_allocations - before, 1) << "the count counts";
#endif
}

}  // namespace
}  // namespace xtrack
