// SPDX-License-Identifier: Apache-2.0
#include "core/base/time_histogram.hpp"

#include <gtest/gtest.h>

namespace xtrack {
namespace {

TEST(TimeHistogram, OfNothingIsZero) {
    const TimeHistogram times;
    EXPECT_EQ(times.count(), 0U);
    EXPECT_EQ(times.quantile_us(0.5), 0.0);
    EXPECT_EQ(times.max_us(), 0.0);
}

TEST(TimeHistogram, QuantilesAreWithinTwoPercent) {
    TimeHistogram times;
    for (int us = 100; us > 0; --us) {
        times.add(std::chrono::microseconds(us));
    }
    EXPECT_EQ(times.count(), 100U);
    EXPECT_GE(times.quantile_us(0.5), 50.0);
    EXPECT_LE(times.quantile_us(0.5), 51.0);
    EXPECT_GE(times.quantile_us(0.99), 99.0);
    EXPECT_LE(times.quantile_us(0.99), 100.0);
    EXPECT_EQ(times.quantile_us(1.0), 100.0);
    EXPECT_EQ(times.max_us(), 100.0);
}

TEST(TimeHistogram, TakesWhatNoBinIsMadeFor) {
    TimeHistogram times;
    times.add(Duration{-5});  // clocks of two devices
    times.add(std::chrono::hours(1));
    EXPECT_EQ(times.count(), 2U);
    EXPECT_LE(times.quantile_us(0.5), 0.1);
    EXPECT_EQ(times.max_us(), 3.6e9);
}

}  // namespace
}  // namespace xtrack
