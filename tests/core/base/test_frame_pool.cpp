// SPDX-License-Identifier: Apache-2.0
#include "core/base/frame_pool.hpp"

#include <atomic>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/allocation_counter.hpp"

namespace xtrack::base {
namespace {

TEST(FramePool, LendsAtMostItsCapacity) {
    FramePool pool(2, {8, 4}, PixelFormat::bgr8);
    auto a = pool.acquire();
    auto b = pool.acquire();
    ASSERT_TRUE(a && b);
    EXPECT_NE(a.get(), b.get());
    EXPECT_EQ(a->size(), (Size{8, 4}));
    EXPECT_EQ(a->pixels.width(), 24);
    EXPECT_EQ(pool.acquire(), nullptr);
    EXPECT_EQ(pool.available(), 0U);
    b.reset();
    EXPECT_EQ(pool.available(), 1U);
    EXPECT_NE(pool.acquire(), nullptr);
}

TEST(FramePool, FieldsStartAfresh) {
    FramePool pool(1, {8, 4}, PixelFormat::grey8);
    auto frame = pool.acquire();
    frame->pattern = 3;
    frame->sequence = 9;
    frame->format = PixelFormat::bgr8;
    frame->pixels.resize(24, 4);
    frame.reset();
    frame = pool.acquire();
    EXPECT_EQ(frame->pattern, kUnknownPattern);
    EXPECT_EQ(frame->sequence, 0U);
    EXPECT_EQ(frame->format, PixelFormat::grey8);
    EXPECT_EQ(frame->size(), (Size{8, 4}));
}

TEST(FramePool, AllocatesNothingOnceItStands) {
    if (!test::counts_allocations()) {
        GTEST_SKIP()
            << "allocations cannot be counted here: no glibc, or a sanitizer is in its way";
    }
    FramePool pool(4, {640, 480}, PixelFormat::grey8);
    const long before = test::allocations();
    for (int i = 0; i < 1000; ++i) {
        const FramePtr a = pool.acquire();
        const FramePtr b = pool.acquire();
        const FramePtr shared = a;  // NOLINT: a copy is what is tested
        ASSERT_TRUE(a && b);
    }
    EXPECT_EQ(test::allocations() - before, 0);
    { const FramePool another(1, {8, 4}, PixelFormat::grey8); }
    EXPECT_GT(test::allocations(), before) << "nothing is counted";
}

TEST(FramePool, FramesMayOutliveIt) {
    FramePtr frame;
    {
        FramePool pool(2, {8, 4}, PixelFormat::grey8);
        auto lent = pool.acquire();
        lent->pixels.fill(7);
        frame = std::move(lent);
    }
    EXPECT_EQ(frame->pixels.at(3, 3), 7);
}

TEST(FramePool, ThreadsShareIt) {
    FramePool pool(8, {16, 16}, PixelFormat::grey8);
    std::atomic<int> clashes{0};
    std::vector<std::thread> threads(4);
    for (int t = 0; t < 4; ++t) {
        threads[static_cast<std::size_t>(t)] = std::thread([&pool, &clashes, t] {
            for (int i = 0; i < 2000; ++i) {
                if (auto frame = pool.acquire()) {
                    frame->pattern = t;
                    std::this_thread::yield();
                    clashes += frame->pattern == t ? 0 : 1;
                }
            }
        });
    }
    for (std::thread& thread : threads) {
        thread.join();
    }
    EXPECT_EQ(clashes.load(), 0);
    EXPECT_EQ(pool.available(), 8U);
}

}  // namespace
}  // namespace xtrack::base
