// SPDX-License-Identifier: Apache-2.0
#include <xtrack/phase_ripple.hpp>

#include <array>
#include <cmath>
#include <complex>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/decode/taps.hpp"

namespace xtrack {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kWidth = 320;
constexpr int kHeight = 120;

std::vector<double> even_phases(int steps) {
    std::vector<double> phases;
    for (int n = 0; n < steps; ++n) {
        phases.push_back(-2.0 * kPi * n / steps);
    }
    return phases;
}

// A curved surface under fringes of about 40 px, turned by 0.2 rad; `grey` says what image n
// makes of the phase.
using Grey = std::function<double(int n, double phase)>;

PhaseMap photograph(int steps, const Grey& grey, bool down = false) {
    const TapSet taps = least_squares_taps(even_phases(steps)).value();
    PhaseMap map;
    map.period_px = 32.0;
    map.phase_rad.resize(down ? kHeight : kWidth, down ? kWidth : kHeight);
    map.modulation = map.phase_rad;
    for (int v = 0; v < kHeight; ++v) {
        for (int u = 0; u < kWidth; ++u) {
            const double phase = 2.0 * kPi * (u + 0.2 * v) / 40.0 + 4e-5 * (u - 150) * (u - 150);
            std::complex<double> z = 0.0;
            for (int n = 0; n < steps; ++n) {
                const Tap& tap = taps.taps[static_cast<std::size_t>(n)];
                z += grey(n, phase) * std::complex<double>(tap.re, tap.im);
            }
            (down ? map.phase_rad.at(v, u) : map.phase_rad.at(u, v)) =
                static_cast<float>(std::arg(z));
        }
    }
    return map;
}

double sine(int n, int steps, double phase) {
    return 0.5 + 0.5 * std::cos(phase - 2.0 * kPi * n / steps);
}

TEST(PhaseRipple, CleanFringesHaveNone) {
    for (const int steps : {3, 4, 5}) {
        const auto ripple = measure_ripple(
            photograph(steps, [&](int n, double phase) { return 100.0 * sine(n, steps, phase); }),
            steps);
        ASSERT_TRUE(ripple) << ripple.error().message;
        EXPECT_LT(ripple->brightness_rad, 0.003);
        EXPECT_LT(ripple->steps_rad, 0.003);
        EXPECT_LT(ripple->gamma_rad, 0.003);
        EXPECT_GT(ripple->pixels, 20000U);
        EXPECT_EQ(cause_of(*ripple), RippleCause::none);
    }
}

// Amplitude at three times the phase of what three steps say of value^gamma.
double ripple_of(double gamma) {
    const TapSet taps = least_squares_taps(even_phases(3)).value();
    constexpr int kSamples = 3600;
    double sum = 0.0;
    for (int i = 0; i < kSamples; ++i) {
        const double phase = 2.0 * kPi * i / kSamples;
        std::complex<double> z = 0.0;
        for (int n = 0; n < 3; ++n) {
            const Tap& tap = taps.taps[static_cast<std::size_t>(n)];
            z += std::pow(sine(n, 3, phase), gamma) * std::complex<double>(tap.re, tap.im);
        }
        sum += std::remainder(std::arg(z) - phase, 2.0 * kPi) * std::sin(3.0 * phase);
    }
    return std::fabs(2.0 * sum / kSamples);
}

TEST(PhaseRipple, GammaIsNamed) {
    EXPECT_NEAR(ripple_of(2.2), 0.26, 0.03);
    for (const double gamma : {2.2, 1.05}) {
        const auto ripple = measure_ripple(
            photograph(3, [=](int n, double p) { return std::pow(sine(n, 3, p), gamma); }), 3);
        ASSERT_TRUE(ripple);
        EXPECT_NEAR(ripple->gamma_rad, ripple_of(gamma), 0.03 * ripple_of(gamma)) << gamma;
        EXPECT_LT(ripple->brightness_rad + ripple->steps_rad, 0.03 * ripple_of(gamma));
        EXPECT_EQ(cause_of(*ripple), gamma > 2.0 ? RippleCause::gamma : RippleCause::none);
    }
}

TEST(PhaseRipple, ColumnsWillDo) {
    const auto ripple =
        measure_ripple(photograph(
                           3, [](int n, double p) { return std::pow(sine(n, 3, p), 2.2); }, true),
                       3);
    ASSERT_TRUE(ripple);
    EXPECT_NEAR(ripple->gamma_rad, ripple_of(2.2), 0.01);
}

// One image 10 % brighter: z gains 0.1 (A + B cos) 2 / 3, A = B, so 0.067 at the phase and half of
// that at twice the phase.
TEST(PhaseRipple, BrightnessIsNamed) {
    const auto ripple = measure_ripple(
        photograph(3, [](int n, double p) { return sine(n, 3, p) * (n == 1 ? 1.1 : 1.0); }), 3);
    ASSERT_TRUE(ripple);
    EXPECT_NEAR(ripple->brightness_rad, 0.066, 0.006);
    EXPECT_NEAR(ripple->steps_rad, 0.033, 0.006);
    EXPECT_EQ(cause_of(*ripple), RippleCause::brightness);
}

// Evenly wrong steps of e rad err by e / sqrt 3 at twice the phase.
TEST(PhaseRipple, StepsAreNamed) {
    constexpr double kWrong_rad = 0.1;
    const auto ripple = measure_ripple(
        photograph(3, [](int n, double p) { return sine(n, 3, p - kWrong_rad * n); }), 3);
    ASSERT_TRUE(ripple);
    EXPECT_NEAR(ripple->steps_rad, kWrong_rad / std::sqrt(3.0), 0.005);
    EXPECT_EQ(cause_of(*ripple), RippleCause::steps);
}

TEST(PhaseRipple, GammaIsFound) {
    for (const double gamma : {0.6, 1.0, 1.7, 2.4}) {
        const auto found = estimate_gamma(
            photograph(
                3, [&](int n, double p) { return 20.0 + 80.0 * std::pow(sine(n, 3, p), gamma); }),
            even_phases(3));
        ASSERT_TRUE(found) << found.error().message;
        EXPECT_NEAR(*found, gamma, 0.02 * gamma);
    }
}

TEST(PhaseRipple, FourStepsDoNotTellGamma) {
    const auto found =
        estimate_gamma(photograph(4, [](int n, double p) { return std::pow(sine(n, 4, p), 2.2); }),
                       even_phases(4));
    ASSERT_FALSE(found);
    EXPECT_EQ(found.error().code, ErrorCode::unsupported);
}

TEST(PhaseRipple, AsksForWholeFringes) {
    PhaseMap empty;
    empty.phase_rad = Image<float>(kWidth, kHeight, std::numeric_limits<float>::quiet_NaN());
    PhaseMap flat;
    flat.phase_rad = Image<float>(kWidth, kHeight, 1.0F);
    PhaseMap tiny;
    tiny.phase_rad = Image<float>(1, 1, 1.0F);
    for (const PhaseMap* map : std::array{&empty, &flat, &tiny}) {
        const auto ripple = measure_ripple(*map, 3);
        ASSERT_FALSE(ripple);
        EXPECT_EQ(ripple.error().code, ErrorCode::unsupported);
        EXPECT_THAT(ripple.error().message, testing::HasSubstr("whole fringes"));
        EXPECT_FALSE(estimate_gamma(*map, even_phases(3)));
    }
    EXPECT_FALSE(measure_ripple(PhaseMap{}, 3));
}

TEST(PhaseRipple, RefusesStepsThatGiveNoPhase) {
    const PhaseMap map = photograph(3, [](int n, double p) { return sine(n, 3, p); });
    EXPECT_EQ(measure_ripple(map, 2).error().code, ErrorCode::invalid_argument);
    EXPECT_EQ(measure_ripple(map, 1000).error().code, ErrorCode::invalid_argument);
    const std::vector<double> alike{0.0, 0.0, 0.0};
    EXPECT_EQ(estimate_gamma(map, alike).error().code, ErrorCode::invalid_argument);
}

}  // namespace
}  // namespace xtrack
