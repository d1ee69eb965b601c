// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/sim/timing.hpp"
#include "tests/core/sim/small_rig.hpp"

namespace xtrack {
namespace {

/// Patterns as flat greys on a bare wall: a row's brightness tells what light it saw.
SimSettings flat_webcam() {
    SimSettings s = test::small_settings("webcam-30");
    test::make_clean(s);
    s.camera.colour = false;
    s.camera.chroma_422 = false;
    s.script.clear();
    s.user.visible_body = false;
    s.projector.light_grey = 400.0;
    test::show_flat(s, {1.0, 0.6, 0.2});
    s.duration_s = 1.0;
    return s;
}

double row_mean(const Frame& f, int y) {
    double sum = 0.0;
    for (int x = 50; x < 110; ++x) {
        sum += f.pixels.at(x, y);
    }
    return sum / 60.0;
}

TEST(SimTiming, CleanRowsSawOnePatternAndTheRestAMixture) {
    const SimSettings s = flat_webcam();
    // The same wall under each pattern alone.
    std::vector<FramePtr> alone;
    for (const double level : {1.0, 0.6, 0.2}) {
        SimSettings one = s;
        test::show_flat(one, {level});
        alone.push_back(test::make_rig(one)->next({}).frame);
    }
    const auto rig = test::make_rig(s);
    int clean_frames = 0;
    int frames = 0;
    int mixed_rows = 0;
    constexpr int kFirstRow = 25;  // above, the wall is out of the projector's frame
    for (;;) {
        const FrameSource::Item item = rig->next({});
        if (item.status != SourceStatus::ok) {
            break;
        }
        const Frame& f = *item.frame;
        ++frames;
        ASSERT_GE(f.pattern, 0);
        clean_frames += f.clean_row_begin == 0 && f.clean_row_end == f.height() ? 1 : 0;
        for (int y = kFirstRow; y < f.height() - 10; ++y) {
            const double own = row_mean(*alone[static_cast<std::size_t>(f.pattern)], y);
            const double ratio = row_mean(f, y) / own;
            if (y >= f.clean_row_begin && y < f.clean_row_end) {
                EXPECT_NEAR(ratio, 1.0, 0.05) << f.sequence << " row " << y;
            } else if (std::abs(ratio - 1.0) > 0.05) {
                ++mixed_rows;
            }
        }
    }
    EXPECT_EQ(frames, 30);
    // Each pattern is held for two frames: one of the two is clean from edge to edge.
    EXPECT_NEAR(clean_frames, 15, 1);
    EXPECT_GT(mixed_rows, 10 * 15);
}

TEST(SimTiming, AMixedRowHoldsTheLightOfBothPatterns) {
    const SimSettings s = flat_webcam();
    const sim::Timing timing(s);
    // An exposure that straddles a switch, one quarter before it.
    const double change = s.clocks.phase_s + 2.0 / 30.0 * (1.0 + s.clocks.drift_ppm * 1e-6);
    const double exposure = s.camera.exposure_s;
    const sim::PatternMix mix = timing.shown(change - 0.25 * exposure, change + 0.75 * exposure);
    ASSERT_EQ(mix.count, 2U);
    EXPECT_EQ(mix.shares[0].pattern, 0U);
    EXPECT_NEAR(mix.shares[0].weight, 0.25F, 1e-4F);
    EXPECT_EQ(mix.shares[1].pattern, 1U);
    EXPECT_NEAR(mix.shares[1].weight, 0.75F, 1e-4F);
}

TEST(SimTiming, ClocksDriftApart) {
    SimSettings s = flat_webcam();
    s.clocks.drift_ppm = 1000.0;
    const sim::Timing timing(s);
    // 1000 ppm of 20 s are 20 ms: the switch has moved through the frame.
    const PatternAssignment early = timing.assign(0);
    const PatternAssignment late = timing.assign(600);
    EXPECT_NE(early.clean_row_end - early.clean_row_begin,
              late.clean_row_end - late.clean_row_begin);
}

/// Mean column of the hand in a row of the mask; negative = no hand.
double middle_of(const SimTruth& truth, int y) {
    double sum = 0.0;
    int count = 0;
    for (int x = 0; x < truth.mask.width(); ++x) {
        if (truth.mask.at(x, y) == static_cast<std::uint8_t>(SimPart::hand)) {
            sum += x;
            ++count;
        }
    }
    return count > 0 ? sum / count : -1.0;
}

TEST(SimTiming, ARollingShutterSkewsAMovingHand) {
    // The same stroke by both shutters. Stamps are mid-exposure of the middle row for both, so the
    // rows above the middle must lag and those below lead, by the speed times the row's time.
    SimSettings s = test::small_settings("webcam-30");
    s.script = {{SimAction::swipe_left, SimHand::right, -1.0, 1.0}};
    s.camera.readout_s = 25e-3;
    SimSettings global = s;
    // Same stamps: what the readout does not add to the first stamp, the exposure does.
    global.camera.readout_s = 0.0;
    const auto rolling_rig = test::make_rig(s);
    const auto global_rig = test::make_rig(global);
    const SimLabel label = rolling_rig->labels().front();
    const double frame_us = 1e6 / s.camera.frame_hz;
    const int at =
        static_cast<int>(static_cast<double>(label.start.us() + label.end.us()) / 2.0 / frame_us);
    const double lag_s = 0.5 * s.camera.readout_s;  // of the rolling stamps
    double before = 0.0;
    double after = 0.0;
    constexpr int kRow = 60;
    Stamp global_stamp;
    for (int i = 0; i <= at + 1; ++i) {
        const FrameSource::Item item = global_rig->next({});
        ASSERT_EQ(item.status, SourceStatus::ok);
        if (i == at) {
            before = middle_of(global_rig->truth(), kRow);
            global_stamp = item.frame->stamp;
        } else if (i == at + 1) {
            after = middle_of(global_rig->truth(), kRow);
        }
    }
    const double speed_px_s = (after - before) * s.camera.frame_hz;
    ASSERT_GT(speed_px_s, 50.0);  // user's left is the image's right
    Stamp stamp;
    for (int i = 0; i <= at; ++i) {
        stamp = rolling_rig->next({}).frame->stamp;
    }
    ASSERT_NEAR(to_seconds(stamp - global_stamp), lag_s, 1e-6);
    const SimTruth& truth = rolling_rig->truth();
    // Against the row's own time: rows far apart differ by the skew.
    const sim::Timing timing(s);
    constexpr int kHigh = 45;
    const double rolled = middle_of(truth, kRow) - middle_of(truth, kHigh);
    // The same frame of the global shutter, replayed, gives the shape without skew.
    const auto again = test::make_rig(global);
    for (int i = 0; i <= at; ++i) {
        ASSERT_EQ(again->next({}).status, SourceStatus::ok);
    }
    const double straight = middle_of(again->truth(), kRow) - middle_of(again->truth(), kHigh);
    const double expected = speed_px_s * (timing.row_offset_s(kRow) - timing.row_offset_s(kHigh));
    EXPECT_GT(expected, 0.3);
    EXPECT_NEAR(rolled - straight, expected, 0.4 * expected + 0.25);
}

}  // namespace
}  // namespace xtrack
