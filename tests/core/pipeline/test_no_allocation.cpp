// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <xtrack/depth_decoder.hpp>
#include <xtrack/paper_decoder.hpp>

#include "tests/core/pipeline/plane_scene.hpp"
#include "tests/core/pipeline/step_scene.hpp"
#include "tests/support/allocation_counter.hpp"

namespace xtrack {
namespace {

void expect_none(const PatternSequence& patterns, PixelFormat format, int wanted, int threads = 1) {
    if (!test::counts_allocations()) {
        GTEST_SKIP()
            << "allocations cannot be counted here: no glibc, or a sanitizer is in its way";
    }
    const Rig rig = test::plane_rig();
    DecodeSettings settings;
    settings.keep_maps = true;
    settings.threads = threads;
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
    const long before = test::allocations();
    int depths = 0;
    for (const FramePtr& frame : frames) {
        depths += decoder->push(frame).state == DecodeState::depth_ready ? 1 : 0;
    }
    EXPECT_EQ(test::allocations() - before, 0);
    EXPECT_EQ(depths, wanted);
}

TEST(NoAllocation, DecodingAllocatesNothing) {
    for (const PixelFormat format : {PixelFormat::grey8, PixelFormat::bgr8}) {
        for (const PatternSequence& patterns : {three_step_sequence(Axis::x, {512, 384}, 512.0),
                                                dual_sequence(Axis::x, {512, 384}, 512.0, 64.0),
                                                gray_code_sequence(Axis::x, {512, 384}, 32.0)}) {
            expect_none(patterns, format, 5 * static_cast<int>(patterns.patterns.size()) + 1);
        }
    }
    // Colour: a depth with every image of the finest pattern.
    expect_none(rgb_sequence(Axis::x, {512, 384}, {512.0, 64.0}), PixelFormat::bgr8, 6);
    expect_none(rgb_sequence(Axis::x, {512, 384}, {512.0, 64.0}), PixelFormat::bgr8, 6, 3);
}

void expect_none_in_paper_mode(const Rig* rig, MotionHandling motion) {
    if (!test::counts_allocations()) {
        GTEST_SKIP()
            << "allocations cannot be counted here: no glibc, or a sanitizer is in its way";
    }
    const PatternSequence patterns = three_step_sequence(Axis::x, {1280, 768}, 32.0);
    DecodeSettings settings;
    settings.motion = motion;
    settings.keep_maps = true;
    auto decoder = PaperDecoder::create(patterns, test::StepScene::kCamera, settings, rig);
    ASSERT_TRUE(decoder) << decoder.error().message;
    test::StepScene scene;
    std::vector<FramePtr> frames;
    for (int n = 0; n < 21; ++n) {
        scene.plate_left_mm = 4.0 * n - 60.0;
        scene.plate_right_mm = 4.0 * n + 40.0;
        auto frame = scene.frame(patterns, n % 3, n);
        frame->clean_row_begin = n % 5 == 4 ? 9 : 0;
        frames.push_back(frame);
    }
    for (int n = 0; n < 3; ++n) {  // the background is found
        decoder->push(frames[static_cast<std::size_t>(n)]);
    }
    const long before = test::allocations();
    int depths = 0;
    for (std::size_t n = 3; n < frames.size(); ++n) {
        settings.mode = n < 9 ? CaptureMode::sliding : CaptureMode::burst;
        ASSERT_TRUE(decoder->set_settings(settings));
        depths += decoder->push(frames[n]).state == DecodeState::depth_ready ? 1 : 0;
    }
    settings.mode = CaptureMode::hold;
    ASSERT_TRUE(decoder->set_settings(settings));
    decoder->decode_again();
    EXPECT_EQ(test::allocations() - before, 0);
    EXPECT_EQ(depths, 6 + 4);
}

TEST(NoAllocation, PaperModeAllocatesNothing) {
    const Rig rig = test::StepScene::rig();
    for (const MotionHandling motion : {MotionHandling::off, MotionHandling::follow}) {
        expect_none_in_paper_mode(&rig, motion);
        expect_none_in_paper_mode(nullptr, motion);
    }
}

}  // namespace
}  // namespace xtrack
