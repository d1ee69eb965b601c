// SPDX-License-Identifier: Apache-2.0
#include <xtrack/pattern_timeline.hpp>

#include <vector>

#include <gtest/gtest.h>

namespace xtrack {
namespace {

using std::chrono::milliseconds;

Stamp ms(double t) { return Stamp{static_cast<std::int64_t>(t * 1e6)}; }

// A projector that holds each of three patterns for 40 ms.
const std::vector<PatternShow> kShows = {{ms(0), 0}, {ms(40), 1}, {ms(80), 2}};

FrameTiming timing(double middle_ms, int exposure_ms, int readout_ms, int rows) {
    return {ms(middle_ms), milliseconds(exposure_ms), milliseconds(readout_ms), rows};
}

TEST(PatternTimeline, GlobalShutterInsideOneShowIsCleanThroughout) {
    EXPECT_EQ(assign_pattern(kShows, timing(60, 10, 0, 480)), (PatternAssignment{1, 0, 480}));
}

TEST(PatternTimeline, GlobalShutterAcrossTwoShowsHasNoCleanRow) {
    EXPECT_EQ(assign_pattern(kShows, timing(42, 10, 0, 480)),
              (PatternAssignment{kUnknownPattern, 0, 0}));
}

TEST(PatternTimeline, ExposureMayTouchBothEndsOfAShow) {
    EXPECT_EQ(assign_pattern(kShows, timing(60, 40, 0, 4)), (PatternAssignment{1, 0, 4}));
}

// 20 rows, 20 ms readout: row r is exposed around 1 ms * (r + 0.5 - 10) after the middle.
TEST(PatternTimeline, RollingShutterKeepsTheRowsOfTheLongerPart) {
    // Middles at 34.5 .. 53.5; exposure 10: rows whose middle lies in [45, 75] saw pattern 1 alone.
    // Before that only middles <= 35, row 0 (34.5), saw pattern 0 alone.
    EXPECT_EQ(assign_pattern(kShows, timing(44, 10, 20, 20)), (PatternAssignment{1, 11, 20}));
    // Middles at 20.5 .. 39.5: rows up to middle 35 saw pattern 0 alone.
    EXPECT_EQ(assign_pattern(kShows, timing(30, 10, 20, 20)), (PatternAssignment{0, 0, 15}));
}

TEST(PatternTimeline, OfTwoEquallyLongRunsTheEarlierRowsWin) {
    // Middles 30.5 .. 49.5 with no exposure: ten rows of pattern 0, ten of pattern 1.
    EXPECT_EQ(assign_pattern(kShows, timing(40, 0, 20, 20)), (PatternAssignment{0, 0, 10}));
}

TEST(PatternTimeline, ShowsOfTheSamePatternInARowAreOne) {
    const std::vector<PatternShow> refreshes = {{ms(0), 4}, {ms(16), 4}, {ms(32), 5}};
    EXPECT_EQ(assign_pattern(refreshes, timing(16, 12, 0, 8)), (PatternAssignment{4, 0, 8}));
}

TEST(PatternTimeline, AShowTooShortToSeeIsSkippedNotTaken) {
    const std::vector<PatternShow> shows = {{ms(0), 0}, {ms(10), 1}, {ms(10), 2}};
    EXPECT_EQ(assign_pattern(shows, timing(15, 4, 0, 8)), (PatternAssignment{2, 0, 8}));
}

TEST(PatternTimeline, LastShowHasNoEndAndFirstNoPast) {
    EXPECT_EQ(assign_pattern(kShows, timing(9000, 16, 30, 100)), (PatternAssignment{2, 0, 100}));
    EXPECT_EQ(assign_pattern(kShows, timing(-20, 4, 0, 100)),
              (PatternAssignment{kUnknownPattern, 0, 0}));
}

// The webcam preset: 33.3 ms frames, 60 Hz projector, exposure 16.7 ms, readout 16 ms, each pattern
// held for two camera frames. Every second frame at least must be mostly clean.
TEST(PatternTimeline, HoldingForTwoFramesGivesOneCleanFrameEach) {
    std::vector<PatternShow> shows(30);
    for (int i = 0; i < 30; ++i) {
        shows[static_cast<std::size_t>(i)] = {Stamp::from_us(i * 66667), i % 3};
    }
    for (int offset_us = 0; offset_us < 33333; offset_us += 1111) {
        for (int hold = 1; hold < 20; ++hold) {
            int best = 0;
            for (int f = 0; f < 2; ++f) {
                const FrameTiming t{Stamp::from_us((2 * hold + f) * 33333 + offset_us),
                                    std::chrono::microseconds(16667),
                                    std::chrono::microseconds(16000), 480};
                const PatternAssignment a = assign_pattern(shows, t);
                best = std::max(best, a.clean_row_end - a.clean_row_begin);
            }
            EXPECT_EQ(best, 480) << offset_us << " " << hold;
        }
    }
}

TEST(PatternTimeline, NonsenseGivesTheUnknownPattern) {
    const PatternAssignment none{kUnknownPattern, 0, 0};
    EXPECT_EQ(assign_pattern({}, timing(60, 10, 0, 480)), none);
    EXPECT_EQ(assign_pattern(kShows, timing(60, 10, 0, 0)), none);
    EXPECT_EQ(assign_pattern(kShows, timing(60, -10, 0, 480)), none);
    EXPECT_EQ(assign_pattern(kShows, timing(60, 10, -1, 480)), none);
}

}  // namespace
}  // namespace xtrack
