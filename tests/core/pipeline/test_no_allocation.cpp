// SPDX-License-Identifier: Apache-2.0
// This program counts every allocation: operator new in all its forms, and malloc beneath it.
#include <atomic>
#include <cstdlib>
#include <new>
#include <vector>

#include <gtest/gtest.h>

#include <xtrack/depth_decoder.hpp>

#include "tests/core/pipeline/plane_scene.hpp"

namespace {

std::atomic<long> allocations{0};

void* counted(std::size_t size, std::size_t alignment) {
    ++allocations;
    const std::size_t whole = (size + alignment - 1) / alignment * alignment;
    void* memory = std::aligned_alloc(alignment, whole);
    if (memory == nullptr) {
        throw std::bad_alloc();
    }
    return memory;
}

}  // namespace

void* operator new(std::size_t size) { return counted(size, alignof(std::max_align_t)); }
void* operator new[](std::size_t size) { return counted(size, alignof(std::max_align_t)); }
void* operator new(std::size_t size, std::align_val_t a) {
    return counted(size, static_cast<std::size_t>(a));
}
void* operator new[](std::size_t size, std::align_val_t a) {
    return counted(size, static_cast<std::size_t>(a));
}
[[gnu::noinline]] void operator delete(void* p) noexcept { std::free(p); }
[[gnu::noinline]] void operator delete[](void* p) noexcept { std::free(p); }
[[gnu::noinline]] void operator delete(void* p, std::size_t) noexcept { std::free(p); }
[[gnu::noinline]] void operator delete[](void* p, std::size_t) noexcept { std::free(p); }
[[gnu::noinline]] void operator delete(void* p, std::align_val_t) noexcept { std::free(p); }
[[gnu::noinline]] void operator delete[](void* p, std::align_val_t) noexcept { std::free(p); }
[[gnu::noinline]] void operator delete(void* p, std::size_t, std::align_val_t) noexcept {
    std::free(p);
}
[[gnu::noinline]] void operator delete[](void* p, std::size_t, std::align_val_t) noexcept {
    std::free(p);
}

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
// Eigen and C code call malloc directly.
extern "C" void* __libc_malloc(std::size_t size);
extern "C" void* malloc(std::size_t size) {
    allocations.fetch_add(1, std::memory_order_relaxed);
    return __libc_malloc(size);
}
#endif

namespace xtrack {
namespace {

TEST(NoAllocation, TheCounterCounts) {
    const long before = allocations;
    std::vector<int> some(1000);
    EXPECT_GT(allocations, before) << some.size();
}

void expect_none(const PatternSequence& patterns, PixelFormat format) {
    const Rig rig = test::plane_rig();
    DecodeSettings settings;
    settings.keep_maps = true;
    auto decoder = DepthDecoder::create(rig, patterns, rig.camera.size, settings);
    ASSERT_TRUE(decoder) << decoder.error().message;
    const int count = static_cast<int>(patterns.patterns.size());
    std::vector<FramePtr> frames;
    for (int n = 0; n < 6 * count; ++n) {
        // The wall moves, so that the code for moving things runs too.
        auto frame = test::plane_frame(rig, patterns, n % count, n, 600.0 + 8.0 * n, format);
        if (n % 5 == 4) {
            frame->clean_row_begin = 9;
        }
        frames.push_back(frame);
    }
    const long before = allocations;
    int depths = 0;
    for (const FramePtr& frame : frames) {
        depths += decoder->push(frame).state == DecodeState::depth_ready ? 1 : 0;
    }
    EXPECT_EQ(allocations - before, 0);
    EXPECT_EQ(depths, 5 * count + 1);
}

TEST(NoAllocation, DecodingAllocatesNothing) {
    for (const PixelFormat format : {PixelFormat::grey8, PixelFormat::bgr8}) {
        expect_none(three_step_sequence(Axis::x, {512, 384}, 512.0), format);
        expect_none(dual_sequence(Axis::x, {512, 384}, 512.0, 64.0), format);
        expect_none(gray_code_sequence(Axis::x, {512, 384}, 32.0), format);
    }
}

}  // namespace
}  // namespace xtrack
