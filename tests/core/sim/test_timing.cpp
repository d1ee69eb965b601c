// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/sim/renderer.hpp"
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

/// Mean column of the moving surface in a row; negative = none.
double middle_of(const sim::Renderer& renderer, int y) {
    double sum = 0.0;
    int count = 0;
    for (int x = 0; x < renderer.surfels().width(); ++x) {
        if (renderer.surfels().at(x, y).depth_mm < sim::kFarAway) {
            sum += x;
            ++count;
        }
    }
    return count > 20 ? sum / count : -1.0;
}

TEST(SimTiming, ARollingShutterSkewsAMovingHand) {
    // Each row of a rolling frame must show what a global shutter shows at the row's own time.
    SimSettings s = test::small_settings("webcam-30");
    s.script = {{SimAction::swipe_left, SimHand::right, -1.0, 1.0}};
    s.camera.readout_s = 32e-3;
    SimSettings fast = s;
    fast.camera.readout_s = 0.0;
    fast.camera.frame_hz = 240.0;
    fast.camera.exposure_s = 1e-3;
    sim::Renderer rolling(s, 1);
    sim::Renderer global(fast, 1);
    const SimLabel label = rolling.hands().front().labels().front();
    const double middle_s = 0.5e-6 * static_cast<double>(label.start.us() + label.end.us());
    const auto frame = static_cast<std::uint64_t>(middle_s * s.camera.frame_hz);
    rolling.draw_geometry(frame);
    const double stamp_s = 1e-9 * static_cast<double>(rolling.timing().stamp(frame).ns);
    int rows = 0;
    for (int y = 25; y < 110; y += 6) {
        const double row_s = stamp_s + rolling.timing().row_offset_s(y);
        const double at = (row_s - 1e-9 * static_cast<double>(global.timing().stamp(0).ns)) *
                          fast.camera.frame_hz;
        const auto low = static_cast<std::uint64_t>(at);
        global.draw_geometry(low);
        const double before = middle_of(global, y);
        global.draw_geometry(low + 1);
        const double after = middle_of(global, y);
        const double rolled = middle_of(rolling, y);
        if (before < 0.0 || after < 0.0 || rolled < 0.0) {
            continue;
        }
        ++rows;
        const double expected = before + (at - static_cast<double>(low)) * (after - before);
        EXPECT_NEAR(rolled, expected, 0.35) << "row " << y;
    }
    EXPECT_GE(rows, 8);
}

}  // namespace
}  // namespace xtrack
