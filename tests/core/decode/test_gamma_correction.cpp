// SPDX-License-Identifier: Apache-2.0
#include "core/decode/gamma_correction.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

namespace xtrack {
namespace {

TEST(GammaCorrection, RemovesTheRippleWhateverTheAmbientLight) {
    const std::vector<double> phases{0.0, -2.0943951, -4.1887902};
    const TapSet taps = least_squares_taps(phases).value();
    for (const double gamma : {0.6, 1.8, 2.2}) {
        const GammaCorrection correction(taps, phases, ResponseCurve(gamma));
        double worst_before = 0.0;
        double worst_after = 0.0;
        for (int i = 0; i < 500; ++i) {
            const double truth = -3.1 + 0.0124 * i;
            std::complex<double> z = 0.0;
            for (std::size_t n = 0; n < 3; ++n) {
                const double light = std::pow(0.5 + 0.5 * std::cos(truth + phases[n]), gamma);
                z += (17.0 + 90.0 * light) * std::complex<double>(taps.taps[n].re, taps.taps[n].im);
            }
            auto phase = static_cast<float>(std::arg(z));
            worst_before = std::max(worst_before, std::fabs(static_cast<double>(phase) - truth));
            correction.apply(1, &phase);
            worst_after =
                std::max(worst_after, std::fabs(std::remainder(static_cast<double>(phase) - truth,
                                                               2.0 * std::numbers::pi)));
        }
        EXPECT_GT(worst_before, 0.1) << gamma;
        EXPECT_LT(worst_after, 0.003) << gamma;
    }
}

// No power, and another for each colour, as colour fringes show them.
TEST(GammaCorrection, RemovesTheRippleOfCurvesThatDiffer) {
    const std::vector<double> phases{0.0, 2.0943951, 4.1887902};
    const TapSet taps = least_squares_taps(phases).value();
    const auto light = [](double value, double power, double s) {
        return (1.0 - s) * std::pow(value, power) + s * value * value * (3.0 - 2.0 * value);
    };
    std::vector<ResponseCurve> curves;
    for (std::size_t n = 0; n < 3; ++n) {
        std::vector<double> steps;
        for (int i = 0; i <= 32; ++i) {
            steps.push_back(light(i / 32.0, 1.5 + 0.3 * static_cast<double>(n), 0.4));
        }
        curves.emplace_back(steps);
    }
    const GammaCorrection correction(taps, phases, curves);
    double worst_before = 0.0;
    double worst_after = 0.0;
    for (int i = 0; i < 500; ++i) {
        const double truth = -3.1 + 0.0124 * i;
        std::complex<double> z = 0.0;
        for (std::size_t n = 0; n < 3; ++n) {
            const double value = 0.5 + 0.5 * std::cos(truth + phases[n]);
            z += (17.0 + 90.0 * light(value, 1.5 + 0.3 * static_cast<double>(n), 0.4)) *
                 std::complex<double>(taps.taps[n].re, taps.taps[n].im);
        }
        auto phase = static_cast<float>(std::arg(z));
        const auto error = [&] {
            return std::fabs(
                std::remainder(static_cast<double>(phase) - truth, 2.0 * std::numbers::pi));
        };
        worst_before = std::max(worst_before, error());
        correction.apply(1, &phase);
        worst_after = std::max(worst_after, error());
    }
    EXPECT_GT(worst_before, 0.1);
    EXPECT_LT(worst_after, 0.005);
}

TEST(ResponseCurve, GivesTheValueOfItsLight) {
    const ResponseCurve curve(std::vector<double>{0.0, 0.1, 0.1, 0.5, 1.0});
    EXPECT_DOUBLE_EQ(curve.light(0.125), 0.05);
    EXPECT_DOUBLE_EQ(curve.value(0.05), 0.125);
    EXPECT_DOUBLE_EQ(curve.value(0.1), 0.25);  // the least that gives it
    EXPECT_DOUBLE_EQ(curve.value(0.3), 0.625);
    EXPECT_EQ(curve.value(0.0), 0.0);
    EXPECT_EQ(curve.value(1.0), 1.0);
    EXPECT_EQ(curve.light(1.0), 1.0);
    EXPECT_FALSE(curve.linear());
    EXPECT_TRUE(ResponseCurve().linear());
    EXPECT_NEAR(ResponseCurve(2.2).value(ResponseCurve(2.2).light(0.3)), 0.3, 1e-12);
}

TEST(GammaCorrection, LeavesALinearProjectorAndMaskedPixelsAlone) {
    const std::vector<double> phases{0.0, 2.0943951, 4.1887902};
    const TapSet taps = least_squares_taps(phases).value();
    EXPECT_TRUE(GammaCorrection(taps, phases, ResponseCurve(1.0)).identity());
    float masked = std::numeric_limits<float>::quiet_NaN();
    GammaCorrection(taps, phases, ResponseCurve(2.2)).apply(1, &masked);
    EXPECT_TRUE(std::isnan(masked));
}

}  // namespace
}  // namespace xtrack
