// SPDX-License-Identifier: Apache-2.0
#include "core/decode/gamma_correction.hpp"

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
        const GammaCorrection correction(taps, phases, gamma);
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

TEST(GammaCorrection, LeavesALinearProjectorAndMaskedPixelsAlone) {
    const std::vector<double> phases{0.0, 2.0943951, 4.1887902};
    const TapSet taps = least_squares_taps(phases).value();
    EXPECT_TRUE(GammaCorrection(taps, phases, 1.0).identity());
    float masked = std::numeric_limits<float>::quiet_NaN();
    GammaCorrection(taps, phases, 2.2).apply(1, &masked);
    EXPECT_TRUE(std::isnan(masked));
}

}  // namespace
}  // namespace xtrack
