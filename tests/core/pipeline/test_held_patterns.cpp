// SPDX-License-Identifier: Apache-2.0
// A camera that is not locked to its projector: each pattern is held for two frames, and the first
// of them saw the switch.
#include <cmath>

#include <gtest/gtest.h>

#include <xtrack/depth_decoder.hpp>

#include "core/pipeline/frame_window.hpp"
#include "tests/core/pipeline/plane_scene.hpp"

namespace xtrack {
namespace {

using test::plane_frame;
using test::plane_rig;

constexpr int kSwitchRow = 24;  // the first frame of a show is clean from here on
constexpr double kWall = 700.0;

PatternSequence wide() { return three_step_sequence(Axis::x, {512, 384}, 512.0); }

// Frame n of a stream in which every pattern is held for two; rows before the switch show the
// pattern before.
std::shared_ptr<Frame> held_frame(int n, double z_mm) {
    auto frame = plane_frame(plane_rig(), wide(), n / 2 % 3, n, z_mm);
    if (n % 2 == 0) {
        const auto before = plane_frame(plane_rig(), wide(), (n / 2 + 2) % 3, n, z_mm);
        for (int y = 0; y < kSwitchRow; ++y) {
            std::copy_n(before->pixels.row(y), frame->pixels.width(), frame->pixels.row(y));
        }
        frame->clean_row_begin = kSwitchRow;
    }
    return frame;
}

double good_share(const DepthFrame& depth, double z_mm) {
    int good = 0;
    for (int y = 0; y < depth.depth.height(); ++y) {
        for (int x = 0; x < depth.depth.width(); ++x) {
            good += std::fabs(depth.depth.at(x, y) * 0.1 - z_mm) < 0.01 * z_mm ? 1 : 0;
        }
    }
    return static_cast<double>(good) / (depth.depth.width() * depth.depth.height());
}

TEST(HeldPatterns, AStillSceneIsWholeInEveryFrame) {
    for (const MotionHandling motion : {MotionHandling::follow, MotionHandling::mask}) {
        DecodeSettings settings;
        settings.motion = motion;
        auto decoder = DepthDecoder::create(plane_rig(), wide(), plane_rig().camera.size, settings);
        ASSERT_TRUE(decoder) << decoder.error().message;
        for (int n = 0; n < 18; ++n) {
            const DecodeStatus status = decoder->push(held_frame(n, kWall));
            if (n >= 5) {
                ASSERT_EQ(status.state, DecodeState::depth_ready);
                EXPECT_GT(good_share(decoder->depth(), kWall), 0.95) << n;
                // Rows that saw the switch take the show before it, the others the newest.
                EXPECT_EQ(decoder->depth().span, std::chrono::milliseconds{50}) << n;
            }
        }
    }
}

TEST(HeldPatterns, ASceneThatJumpsIsWholeAgainWhenItRests) {
    auto decoder = DepthDecoder::create(plane_rig(), wide(), plane_rig().camera.size, {});
    ASSERT_TRUE(decoder) << decoder.error().message;
    for (int n = 0; n < 36; ++n) {
        decoder->push(held_frame(n, n < 18 ? 700.0 : 900.0));
    }
    EXPECT_GT(good_share(decoder->depth(), 900.0), 0.85);
}

TEST(HeldPatterns, TheWindowKeepsTheRowsOfTwoShowsAndNoMore) {
    FrameWindow window(3);
    for (int n = 0; n < 20; ++n) {
        window.push(held_frame(n, kWall));
    }
    // Frames 18 and 19 of pattern 0; of the show before, frame 12 adds nothing to frame 13.
    const auto entries = window.entries(0);
    ASSERT_TRUE(entries[0].frame && entries[1].frame && entries[2].frame);
    EXPECT_EQ(entries[0].frame->sequence, 19U);
    EXPECT_EQ(entries[1].frame->sequence, 18U);
    EXPECT_EQ(entries[2].frame->sequence, 13U);
    EXPECT_FALSE(entries[3].frame);
    EXPECT_EQ(window.held(0)->frame->sequence, 18U);
    EXPECT_EQ(window.fullest(0, 1)->frame->sequence, 13U);
    EXPECT_EQ(window.frames_of_last_show(), 2);
    std::array<const Frame*, FrameWindow::kFramesPerShow> frames{};
    EXPECT_EQ(window.clean_show(0, kSwitchRow, frames), 2U);
    EXPECT_EQ(window.clean_show(0, kSwitchRow - 1, frames), 1U);
    EXPECT_EQ(frames[0]->sequence, 19U);
    // The next show of pattern 0 begins after patterns 1 and 2; its upper rows are older.
    for (int n = 20; n < 25; ++n) {
        window.push(held_frame(n, kWall));
    }
    EXPECT_EQ(window.clean(0, kSwitchRow)->sequence, 24U);
    EXPECT_EQ(window.clean(0, kSwitchRow - 1)->sequence, 19U);
    EXPECT_EQ(window.held(0), nullptr);
}

TEST(HeldPatterns, ImagesOfAPatternThatNeverChangesAreNotAveraged) {
    FrameWindow window(1);
    const PatternSequence one = n_step_sequence(Axis::x, {512, 384}, 16.0, 1);
    for (int n = 0; n < 3; ++n) {
        window.push(plane_frame(plane_rig(), one, 0, n, kWall));
    }
    std::array<const Frame*, FrameWindow::kFramesPerShow> frames{};
    EXPECT_EQ(window.clean_show(0, 10, frames), 1U);
    EXPECT_EQ(frames[0]->sequence, 2U);
}

}  // namespace
}  // namespace xtrack
