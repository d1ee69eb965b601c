// SPDX-License-Identifier: Apache-2.0
#include <xtrack/one_euro_filter.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "tests/gestures/recognise/play_hand.hpp"

namespace xtrack::test {
namespace {

struct Row {
    double s;
    double noisy;
    double filtered;
};

// The first rows of the authors' ground truth (groundTruth.csv of casiez/OneEuroFilter): a noisy
// sine at 120 Hz, min cutoff 1 Hz, beta 0.1, derivative cutoff 1 Hz; the authors allow 0.001.
constexpr std::array<Row, 40> kGroundTruth{{
    {0, -0.0385099, -0.0385099},
    {0.00833333, -0.0280664, -0.0379872},
    {0.0166667, 0.048622, -0.0334427},
    {0.025, 0.111498, -0.0252696},
    {0.0333333, 0.053026, -0.0207099},
    {0.0416667, 0.120548, -0.0119912},
    {0.05, 0.00972308, -0.0106507},
    {0.0583333, 0.074193, -0.00526521},
    {0.0666667, -0.0236801, -0.00641239},
    {0.075, 0.0462396, -0.00308863},
    {0.0833333, 0.0892027, 0.00291027},
    {0.0916667, 0.158329, 0.0135545},
    {0.1, 0.0423086, 0.01552},
    {0.108333, 0.0887203, 0.0206024},
    {0.116667, 0.039102, 0.0218784},
    {0.125, 0.140277, 0.030313},
    {0.133333, 0.156938, 0.0396331},
    {0.141667, 0.0961089, 0.0438101},
    {0.15, 0.216881, 0.0572083},
    {0.158333, 0.067538, 0.057997},
    {0.166667, 0.0737634, 0.0591871},
    {0.175, 0.0989231, 0.0621793},
    {0.183333, 0.148209, 0.0687489},
    {0.191667, 0.0959887, 0.0708137},
    {0.2, 0.225627, 0.0829925},
    {0.208333, 0.292078, 0.100305},
    {0.216667, 0.185221, 0.107391},
    {0.225, 0.133595, 0.109553},
    {0.233333, 0.216387, 0.118501},
    {0.241667, 0.316189, 0.135759},
    {0.25, 0.156782, 0.137568},
    {0.258333, 0.164811, 0.139884},
    {0.266667, 0.167903, 0.142239},
    {0.275, 0.273214, 0.153484},
    {0.283333, 0.305514, 0.166876},
    {0.291667, 0.342528, 0.182828},
    {0.3, 0.334796, 0.196929},
    {0.308333, 0.210729, 0.198186},
    {0.316667, 0.401551, 0.217377},
    {0.325, 0.267666, 0.222081},
}};

Stamp seconds(double s) { return Stamp{static_cast<std::int64_t>(s * 1e9 + 0.5)}; }

TEST(OneEuro, AgreesWithTheAuthors) {
    OneEuroFilter filter({1.0, 0.1, 1.0});
    for (std::size_t i = 0; i < kGroundTruth.size(); ++i) {
        // Their stamps are printed to six digits; the rate was 120 Hz.
        const double out =
            filter.filter(kGroundTruth[i].noisy, seconds(static_cast<double>(i) / 120));
        EXPECT_NEAR(out, kGroundTruth[i].filtered, 1e-6) << "row " << i;
    }
}

TEST(OneEuro, UsesTheRealTimeStep) {
    // The paper's equations in double precision, written apart from the filter, at uneven steps.
    const OneEuroSettings settings{0.7, 0.02, 0.9};
    OneEuroFilter filter(settings);
    const std::array<double, 6> steps_s{1.0 / 120, 1.0 / 30,  1.0 / 60,
                                        1.0 / 15,  1.0 / 240, 1.0 / 30};
    const auto alpha = [](double cutoff, double dt) {
        return 1.0 / (1.0 + 1.0 / (2.0 * std::numbers::pi * cutoff * dt));
    };
    double t = 0.0;
    double x = 0.0;
    double dx = 0.0;
    for (int i = 0; i < 300; ++i) {
        const double in = 100.0 * std::sin(0.13 * i) + 3.0 * std::cos(2.1 * i);
        const double before = t;
        if (i > 0) {
            t += steps_s[static_cast<std::size_t>(i) % steps_s.size()];
            // The filter sees whole nanoseconds.
            const double dt = to_seconds(seconds(t) - seconds(before));
            const double a_d = alpha(settings.derivative_cutoff_hz, dt);
            dx = a_d * (in - x) / dt + (1.0 - a_d) * dx;
            const double a =
                alpha(settings.min_cutoff_hz + settings.beta_hz_per_mmps * std::abs(dx), dt);
            x = a * in + (1.0 - a) * x;
        } else {
            x = in;
        }
        EXPECT_NEAR(filter.filter(in, seconds(t)), x, 1e-9) << "sample " << i;
    }
}

TEST(OneEuro, SkipsWhatIsNotLater) {
    OneEuroFilter filter;
    filter.filter(0.0, seconds(1.0));
    const double out = filter.filter(10.0, seconds(1.1));
    EXPECT_GT(out, 0.0);
    EXPECT_EQ(filter.filter(500.0, seconds(1.1)), out);
    EXPECT_EQ(filter.filter(500.0, seconds(0.9)), out);
    EXPECT_EQ(filter.filter(std::numeric_limits<double>::quiet_NaN(), seconds(1.2)), out);
    filter.reset();
    EXPECT_EQ(filter.filter(500.0, seconds(0.9)), 500.0);
}

struct Quality {
    double rest_mm;  ///< rms at rest
    double lag_ms;   ///< at 300 mm/s
};

Quality measure(const OneEuroSettings& settings) {
    constexpr double kHz = 60.0;
    Noise noise(11);
    Quality q;
    OneEuroFilter rest(settings);
    double squares = 0.0;
    constexpr int kFrames = 6000;
    for (int i = 0; i < kFrames; ++i) {
        const double out = rest.filter(static_cast<double>(noise(2.0)), seconds(1 + i / kHz));
        squares += i >= 600 ? out * out : 0.0;
    }
    q.rest_mm = std::sqrt(squares / (kFrames - 600));
    OneEuroFilter ramp(settings);
    double out = 0.0;
    double in = 0.0;
    for (int i = 0; i < 600; ++i) {
        in = 300.0 * i / kHz;
        out = ramp.filter(in, seconds(1 + i / kHz));
    }
    q.lag_ms = (in - out) / 300.0 * 1e3;
    return q;
}

TEST(OneEuro, DefaultsAreCalmAndQuick) {
    const Quality q = measure({});
    EXPECT_NEAR(q.rest_mm, 0.48, 0.10);  // of 2 mm white noise
    EXPECT_NEAR(q.lag_ms, 10.0, 3.0);
}

TEST(OneEuro, BetaIsWhatKeepsUp) {
    EXPECT_GT(measure({1.0, 0.0, 1.0}).lag_ms, 120.0);
    EXPECT_LT(measure({1.0, 0.02, 1.0}).lag_ms, 35.0);
}

TEST(OneEuro, APointIsThreeFilters) {
    OneEuroFilter3 point;
    OneEuroFilter y;
    for (int i = 0; i < 50; ++i) {
        const Vec3f in{0.0F, static_cast<float>(3 * i), -5.0F};
        const Vec3f out = point.filter(in, seconds(i / 60.0));
        EXPECT_FLOAT_EQ(out.y(), static_cast<float>(y.filter(3.0 * i, seconds(i / 60.0))));
        EXPECT_FLOAT_EQ(out.z(), -5.0F);
    }
}

}  // namespace
}  // namespace xtrack::test
