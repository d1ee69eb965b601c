// SPDX-License-Identifier: Apache-2.0
#include "core/decode/decode_row.hpp"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "core/decode/luma.hpp"
#include "tests/core/decode/each_target.hpp"

namespace xtrack {
namespace {

// Phases agree to a few units of rounding of an angle near pi; fused multiply-add makes them
// differ.
constexpr float kSamePhaseRad = 5e-6F;

struct Decoded {
    std::vector<float> phase, modulation;
};

Decoded run(DecodeRow row, void (*form)(const DecodeRow&) noexcept) {
    // A guard value after the end shows a kernel that writes too far.
    Decoded out{std::vector<float>(static_cast<std::size_t>(row.count) + 1, -77.0F),
                std::vector<float>(static_cast<std::size_t>(row.count) + 1, -77.0F)};
    row.phase_rad = out.phase.data();
    row.modulation = out.modulation.data();
    form(row);
    return out;
}

TEST(DecodeRow, EveryInstructionSetAgreesWithScalarOnRandomImages) {
    std::mt19937 random(7);
    std::uniform_int_distribution<int> grey(0, 255);
    std::uniform_real_distribution<float> weight(-0.7F, 0.7F);
    for (const int taps : {1, 3, 4, 5, 8, 32}) {
        for (const int count : {1, 3, 7, 16, 17, 33, 640, 1001}) {
            std::vector<std::vector<std::uint8_t>> pixels(static_cast<std::size_t>(taps));
            DecodeRow row;
            row.taps = taps;
            row.count = count;
            row.min_modulation = 20.0F;
            row.saturation_limit = 254;
            for (std::size_t n = 0; n < pixels.size(); ++n) {
                for (int i = 0; i < count; ++i) {
                    pixels[n].push_back(static_cast<std::uint8_t>(grey(random)));
                }
                row.source[n] = pixels[n].data();
                row.re[n] = weight(random);
                row.im[n] = weight(random);
            }
            const Decoded expected = run(row, decode_row_scalar);
            test::for_each_target([&] {
                const Decoded actual = run(row, decode_row);
                EXPECT_EQ(actual.phase.back(), -77.0F);
                for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
                    ASSERT_EQ(std::isnan(actual.phase[i]), std::isnan(expected.phase[i])) << i;
                    if (std::isnan(expected.phase[i])) {
                        ASSERT_EQ(actual.modulation[i], 0.0F);
                        continue;
                    }
                    const auto turn = static_cast<double>(actual.phase[i] - expected.phase[i]);
                    ASSERT_NEAR(std::remainder(turn, 2.0 * M_PI), 0.0, kSamePhaseRad) << i;
                    ASSERT_NEAR(actual.modulation[i], expected.modulation[i],
                                1e-5F * expected.modulation[i]);
                }
            });
        }
    }
}

TEST(DecodeRow, ArctangentIsGoodToTwoMicroradians) {
    // One image each for the real and the imaginary part: z = I0 - I1 + i (I2 - I3).
    std::vector<std::uint8_t> plus_x, minus_x, plus_y, minus_y;
    std::vector<double> angle;
    for (int y = -255; y <= 255; y += 3) {
        for (int x = -255; x <= 255; x += 3) {
            plus_x.push_back(static_cast<std::uint8_t>(std::max(x, 0)));
            minus_x.push_back(static_cast<std::uint8_t>(std::max(-x, 0)));
            plus_y.push_back(static_cast<std::uint8_t>(std::max(y, 0)));
            minus_y.push_back(static_cast<std::uint8_t>(std::max(-y, 0)));
            angle.push_back(std::atan2(y, x));
        }
    }
    DecodeRow row;
    row.taps = 4;
    row.count = static_cast<int>(angle.size());
    row.source = {plus_x.data(), minus_x.data(), plus_y.data(), minus_y.data()};
    row.re = {1.0F, -1.0F, 0.0F, 0.0F};
    row.im = {0.0F, 0.0F, 1.0F, -1.0F};
    test::for_each_target([&] {
        const Decoded out = run(row, decode_row);
        for (std::size_t i = 0; i < angle.size(); ++i) {
            ASSERT_NEAR(static_cast<double>(out.phase[i]), angle[i], 2.1e-6);
        }
    });
}

TEST(DecodeRow, MasksWeakAndSaturatedPixels) {
    const std::vector<std::uint8_t> a{100, 104, 255, 200}, b{100, 100, 100, 100},
        c{100, 100, 100, 100};
    DecodeRow row;
    row.taps = 3;
    row.count = 4;
    row.source = {a.data(), b.data(), c.data()};
    const TapSet taps = design_taps(TapDesign::three, 2.0 * M_PI / 3.0, 0.0).value();
    for (std::size_t n = 0; n < 3; ++n) {
        row.re[n] = taps.taps[n].re;
        row.im[n] = taps.taps[n].im;
    }
    row.min_modulation = 6.0F;
    row.saturation_limit = 255;
    const Decoded out = run(row, decode_row);
    EXPECT_TRUE(std::isnan(out.phase[0]));
    EXPECT_TRUE(std::isnan(out.phase[1]));  // B = 2/3 * 4
    EXPECT_TRUE(std::isnan(out.phase[2]));  // saturated
    EXPECT_NEAR(out.phase[3], 0.0F, 1e-5F);
    EXPECT_NEAR(out.modulation[3], 200.0F / 3.0F, 1e-3F);
    row.saturation_limit = kNoSaturationLimit;
    EXPECT_FALSE(std::isnan(run(row, decode_row).phase[2]));
}

TEST(Luma, WeighsAsImageLibrariesDo) {
    const std::vector<std::uint8_t> bgr{255, 255, 255, 0, 0, 0, 255, 0, 0, 0, 255, 0, 0, 0, 255};
    std::vector<std::uint8_t> grey(5);
    luma_row(bgr.data(), 5, grey.data());
    EXPECT_EQ(grey, (std::vector<std::uint8_t>{255, 0, 29, 150, 76}));
}

}  // namespace
}  // namespace xtrack
