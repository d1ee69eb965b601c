// SPDX-License-Identifier: Apache-2.0
// Counts what the heap is asked for while frames come: nothing, once the pool is warm.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "tests/core/sim/small_rig.hpp"

namespace {
std::atomic<long> allocations{0};
}

void* operator new(std::size_t size) {
    ++allocations;
    if (void* p = std::malloc(size)) {
        return p;
    }
    throw std::bad_alloc();
}
void* operator new(std::size_t size, std::align_val_t alignment) {
    ++allocations;
    const auto a = static_cast<std::size_t>(alignment);
    if (void* p = std::aligned_alloc(a, (size + a - 1) / a * a)) {
        return p;
    }
    throw std::bad_alloc();
}
// The temporary buffer of std::stable_sort comes this way; AddressSanitizer has one of its own.
void* operator new(std::size_t size, const std::nothrow_t& /*tag*/) noexcept {
    ++allocations;
    return std::malloc(size);
}
[[gnu::noinline]] void operator delete(void* p) noexcept { std::free(p); }
[[gnu::noinline]] void operator delete(void* p, std::size_t) noexcept { std::free(p); }
[[gnu::noinline]] void operator delete(void* p, std::align_val_t) noexcept { std::free(p); }
[[gnu::noinline]] void operator delete(void* p, std::size_t, std::align_val_t) noexcept {
    std::free(p);
}

namespace xtrack {
namespace {

TEST(SimMemory, FramesAndTruthAllocateNothing) {
    for (const char* preset : {"ideal-60", "webcam-30"}) {
        SimSettings s = test::small_settings(preset);
        s.script = {{SimAction::swipe_left, SimHand::right, -1.0, 1.0},
                    {SimAction::idle, SimHand::left, -1.0, 1.0}};
        s.duration_s = 0.4;
        const auto rig = test::make_rig(s);
        (void)rig->next({});
        (void)rig->truth();
        const long before = allocations;
        int frames = 0;
        while (rig->next({}).status == SourceStatus::ok) {
            (void)rig->truth();
            ++frames;
        }
        EXPECT_EQ(allocations - before, 0) << preset;
        EXPECT_GT(frames, 10);
    }
}

}  // namespace
}  // namespace xtrack
