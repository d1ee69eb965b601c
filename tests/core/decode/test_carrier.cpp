// SPDX-License-Identifier: Apache-2.0
#include "core/decode/carrier.hpp"

#include <cmath>
#include <complex>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace xtrack {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kLength = 320;
constexpr int kLines = 48;

struct Fringes {
    double period_px = 12.0;
    double bump_rad = 0.0;  // what stands out in the middle
    double noise_levels = 0.0;
    bool down = false;

    [[nodiscard]] double phase(int i) const {
        const double x = (i - 0.5 * kLength) / 60.0;
        return 2.0 * kPi * i / period_px + bump_rad * std::exp(-0.5 * x * x);
    }
    [[nodiscard]] Image<std::uint8_t> image() const {
        std::mt19937 random(5);
        std::normal_distribution<double> noise(0.0, 1.0);
        Image<std::uint8_t> out(down ? kLines : kLength, down ? kLength : kLines);
        for (int i = 0; i < kLength; ++i) {
            for (int line = 0; line < kLines; ++line) {
                const double shade = 1.0 + 0.3 * std::sin(0.02 * i);
                const double grey = shade * (90.0 + 60.0 * std::cos(phase(i)));
                (down ? out.at(line, i) : out.at(i, line)) = static_cast<std::uint8_t>(
                    std::lround(std::clamp(grey + noise_levels * noise(random), 0.0, 255.0)));
            }
        }
        return out;
    }
    // Largest error of the phase away from the ends, in one line, rad.
    [[nodiscard]] double worst(double carrier_px, double pattern_phase_rad = 0.0) const {
        const Image<std::uint8_t> seen = image();
        const TapSet taps = carrier_taps(carrier_px, down, pattern_phase_rad);
        double worst = 0.0;
        for (int i = 40; i < kLength - 40; ++i) {
            std::complex<double> z;
            for (std::size_t n = 0; n < static_cast<std::size_t>(taps.count); ++n) {
                const Tap& tap = taps.taps[n];
                const int grey = down ? seen.at(20, i + tap.dy) : seen.at(i + tap.dx, 20);
                z +=
                    std::complex<double>(static_cast<double>(tap.re), static_cast<double>(tap.im)) *
                    static_cast<double>(grey);
            }
            const double sign = carrier_px < 0.0 ? -1.0 : 1.0;
            const double want = sign * phase(i) - pattern_phase_rad;
            worst = std::max(worst, std::fabs(std::remainder(std::arg(z) - want, 2.0 * kPi)));
        }
        return worst;
    }
};

TEST(Carrier, ItsPeriodShowsInTheImage) {
    for (const double period_px : {5.0, 8.5, 12.0, 20.0, 27.0}) {
        for (const bool down : {false, true}) {
            const Fringes fringes{period_px, 2.0, 4.0, down};
            EXPECT_NEAR(find_carrier_px(fringes.image().view(), down), period_px, 0.06 * period_px);
        }
    }
}

TEST(Carrier, NoiseAndShadingHaveNone) {
    Fringes noise{12.0, 0.0, 30.0, false};
    Image<std::uint8_t> image = noise.image();
    std::mt19937 random(3);
    for (int y = 0; y < image.height(); ++y) {
        for (int x = 0; x < image.width(); ++x) {
            image.at(x, y) =
                static_cast<std::uint8_t>(100 + x / 4 + static_cast<int>(random() % 9));
        }
    }
    EXPECT_EQ(find_carrier_px(image.view(), false), 0.0);
    EXPECT_EQ(find_carrier_px(Image<std::uint8_t>(20, 20, 7).view(), false), 0.0);
}

TEST(Carrier, OneImageIsAPhase) {
    const Fringes flat;
    EXPECT_LT(flat.worst(12.0), 0.03);
    EXPECT_LT(flat.worst(12.4), 0.05);  // the period need not be exact
    const Fringes bump{12.0, 6.0, 0.0, true};
    EXPECT_LT(bump.worst(12.0), 0.08);
    EXPECT_LT((Fringes{12.0, 6.0, 2.0, false}.worst(12.0)), 0.15);
}

TEST(Carrier, KnowsThePatternsPhaseAndDirection) {
    EXPECT_LT(Fringes{}.worst(12.0, 1.3), 0.03);
    EXPECT_LT(Fringes{}.worst(-12.0, 0.4), 0.03);
}

}  // namespace
}  // namespace xtrack
