// SPDX-License-Identifier: Apache-2.0
#include "gestures/recognise/signal.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "gestures/recognise/motion_history.hpp"
#include "tests/gestures/recognise/play_hand.hpp"

namespace xtrack::test {
namespace {

using recognise::MotionHistory;
using recognise::MotionSample;
using recognise::Signal;
using recognise::SignalMeter;

/// Three seconds of a hand that swings `way_mm` to and fro once a second.
Signal measured(double noise_mm, double fps, float way_mm) {
    MotionHistory history;
    SignalMeter meter;
    Noise noise(3);
    for (int i = 0; i < static_cast<int>(3.0 * fps); ++i) {
        const double t_s = i / fps;
        MotionSample sample;
        sample.stamp = Stamp{static_cast<std::int64_t>(t_s * 1e9)};
        const float x = way_mm * static_cast<float>(std::sin(2.0 * M_PI * t_s));
        sample.palm_mm = {x + noise(noise_mm), noise(noise_mm), 400.0F + noise(noise_mm)};
        sample.aperture_mm = 60.0F + noise(noise_mm);
        if (history.add(sample)) {
            meter.update(history);
        }
    }
    return meter.signal();
}

TEST(MotionHistory, WhatIsFirstSeenBeganHalfAnImageBefore) {
    MotionHistory history;
    const auto add_at = [&](int ms) {
        MotionSample sample;
        sample.stamp = Stamp::from_us(1000LL * ms);
        history.add(sample);
    };
    add_at(0);
    EXPECT_EQ(history.unseen(), Duration::zero());
    add_at(50);
    EXPECT_EQ(history.unseen(), std::chrono::milliseconds{25});
    add_at(60);
    EXPECT_EQ(history.unseen(), std::chrono::milliseconds{5});
    add_at(460);  // a gap says little
    EXPECT_EQ(history.unseen(), std::chrono::milliseconds{50});
}

class SignalAt : public ::testing::TestWithParam<std::tuple<double, double>> {};

TEST_P(SignalAt, NoiseIsMeasuredWhileTheHandMoves) {
    const auto [noise_mm, fps] = GetParam();
    const Signal signal = measured(noise_mm, fps, 60.0F);
    EXPECT_NEAR(signal.palm_noise_mm, noise_mm, 0.25 * noise_mm + 0.35);
    EXPECT_NEAR(signal.aperture_noise_mm, noise_mm, 0.25 * noise_mm + 0.1);
    EXPECT_NEAR(signal.interval_s, 1.0 / fps, 1e-4);
}

INSTANTIATE_TEST_SUITE_P(Noise, SignalAt,
                         ::testing::Combine(::testing::Values(0.0, 1.0, 2.0, 4.0),
                                            ::testing::Values(30.0, 60.0, 120.0)));

TEST(Signal, StillnessIsThreeSigmaOfASlope) {
    Signal signal;
    signal.palm_noise_mm = 2.0;
    signal.interval_s = 1.0 / 60.0;
    // Seven samples in 100 ms: sigma = 2 * 60 * sqrt(12 / (7 * 48)) = 22.7 mm/s.
    EXPECT_NEAR(signal.still_mmps(20.0, std::chrono::milliseconds{101}), 68.0, 0.5);
    EXPECT_EQ(signal.still_mmps(100.0, std::chrono::milliseconds{101}), 100.0);
    EXPECT_EQ(signal.still_mm(5.0), 5.0);
    signal.palm_noise_mm = 8.0;
    EXPECT_EQ(signal.still_mm(5.0), 6.0);
    EXPECT_EQ(Signal::apart(10.0, 2.0), 10.0);
    EXPECT_EQ(Signal::apart(10.0, 4.0), 12.0);
}

}  // namespace
}  // namespace xtrack::test
