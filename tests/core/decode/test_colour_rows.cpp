// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "core/decode/colour_cost.hpp"
#include "core/decode/rgb_row.hpp"
#include "tests/core/decode/colour_scene.hpp"
#include "tests/core/decode/each_target.hpp"

namespace xtrack {
namespace {

constexpr float kGuard = -77.0F;

struct Decoded {
    std::vector<float> phase, modulation;
};

Decoded run(RgbRow row, void (*form)(const RgbRow&) noexcept) {
    Decoded out{std::vector<float>(static_cast<std::size_t>(row.count) + 1, kGuard),
                std::vector<float>(static_cast<std::size_t>(row.count) + 1, kGuard)};
    row.phase_rad = out.phase.data();
    row.modulation = out.modulation.data();
    form(row);
    return out;
}

TEST(RgbRow, EveryInstructionSetAgreesWithScalarOnRandomImages) {
    std::mt19937 random(11);
    std::uniform_int_distribution<int> grey(0, 255);
    std::uniform_real_distribution<float> weight(-0.9F, 0.9F);
    for (const std::size_t frames : {1U, 2U, 4U}) {
        for (const int count : {1, 7, 16, 17, 33, 640}) {
            const auto size = static_cast<std::size_t>(count);
            std::vector<std::vector<std::uint8_t>> pixels(frames);
            std::vector<std::vector<float>> taps(6, std::vector<float>(size));
            RgbRow row;
            row.frames = frames;
            row.count = count;
            row.min_modulation = 20.0F;
            row.saturation_limit = 254;
            for (std::size_t n = 0; n < frames; ++n) {
                for (int i = 0; i < 3 * count; ++i) {
                    pixels[n].push_back(static_cast<std::uint8_t>(grey(random)));
                }
                row.bgr[n] = pixels[n].data();
                row.turn[n] = {weight(random), weight(random)};
            }
            for (std::size_t t = 0; t < taps.size(); ++t) {
                for (float& tap : taps[t]) {
                    tap = weight(random);
                }
                (t < 3 ? row.re[t] : row.im[t - 3]) = taps[t].data();
            }
            const Decoded expected = run(row, rgb_row_scalar);
            test::for_each_target([&] {
                const Decoded actual = run(row, rgb_row);
                EXPECT_EQ(actual.phase.back(), kGuard);
                for (std::size_t i = 0; i < size; ++i) {
                    ASSERT_EQ(std::isnan(actual.phase[i]), std::isnan(expected.phase[i])) << i;
                    if (!std::isnan(expected.phase[i])) {
                        ASSERT_NEAR(actual.phase[i], expected.phase[i], 1e-5F) << i;
                    }
                    ASSERT_NEAR(actual.modulation[i], expected.modulation[i], 1e-3F) << i;
                }
            });
        }
    }
}

struct Scene {
    std::vector<std::vector<float>> planes{7};
    ColourCost row;
    std::vector<float> cost;
};

// Pixels of one surface, coordinates 100 px and up.
Scene scene(const test::ColourPixel& pixel, int count, double reference_off_px = 0.0) {
    Scene s;
    s.row.fine = {96.0, 0.3};
    s.row.coarse = {768.0, 0.9};
    s.row.has_coarse = true;
    for (int i = 0; i < count; ++i) {
        const double x = 100.0 + i;
        const Vec3d fine = pixel.light(x, s.row.fine);
        const Vec3d coarse = pixel.light(x, s.row.coarse);
        for (std::size_t k = 0; k < 3; ++k) {
            s.planes[k].push_back(static_cast<float>(fine[static_cast<int>(k)]));
            s.planes[k + 3].push_back(static_cast<float>(coarse[static_cast<int>(k)]));
        }
        s.planes[6].push_back(i % 7 == 6 ? std::numeric_limits<float>::quiet_NaN()
                                         : static_cast<float>(x + reference_off_px));
    }
    for (std::size_t k = 0; k < 3; ++k) {
        s.row.samples.fine[k] = s.planes[k].data();
        s.row.samples.coarse[k] = s.planes[k + 3].data();
    }
    s.row.samples.reference_px = s.planes[6].data();
    s.row.count = count;
    s.cost.assign(static_cast<std::size_t>(count) + 1, kGuard);
    s.row.cost = s.cost.data();
    return s;
}

TEST(ColourCost, IsNothingUnderTheRightSurfaceAndMuchUnderAnother) {
    const ColourModel model = ColourModel::create(test::kThirds_rad, Mat3d::Identity()).value();
    // The reference serves the coarse period alone: 300 px off do not matter.
    Scene s = scene({{1.4, 0.95, 0.75}, {}, 0.8}, 400, 300.0);
    s.row.inverse = model.inverse(model.surface({1.4F, 0.95F, 0.75F}, 0.8F));
    s.row.coarse_inverse = model.coarse_inverse(model.surface({1.4F, 0.95F, 0.75F}, 0.8F));
    colour_cost(s.row);
    for (int i = 0; i < s.row.count; ++i) {
        ASSERT_LT(s.cost[static_cast<std::size_t>(i)], 1e-4F) << i;
    }
    EXPECT_EQ(s.cost.back(), kGuard);
    s.row.inverse = model.inverse(ColourSurface{});
    s.row.coarse_inverse = model.coarse_inverse(ColourSurface{});
    colour_cost(s.row);
    double sum = 0.0;
    for (int i = 0; i < s.row.count; ++i) {
        sum += static_cast<double>(s.cost[static_cast<std::size_t>(i)]);
    }
    EXPECT_GT(sum / s.row.count, 0.1);
}

TEST(ColourCost, WithoutACoarsePeriodTheReferenceAndTheContrastMustAgree) {
    const ColourModel model = ColourModel::create(test::kThirds_rad, Mat3d::Identity()).value();
    Scene s = scene({{1.0, 1.0, 1.0}, {}, 0.8}, 64, 24.0);  // a quarter of a period
    s.row.inverse = model.inverse(ColourSurface{});
    s.row.has_coarse = false;
    s.row.transfer = 0.5F;  // has no meaning then
    s.row.contrast = 0.7F;
    colour_cost(s.row);
    EXPECT_NEAR(s.cost[0], 4.0F * 0.25F * 0.25F + 4.0F * 0.1F * 0.1F, 1e-3F);
    EXPECT_NEAR(s.cost[6], 4.0F * 0.1F * 0.1F, 1e-3F);  // no reference
}

TEST(ColourCost, EveryInstructionSetAgreesWithScalar) {
    const ColourModel model = ColourModel::create(test::kThirds_rad, Mat3d::Identity()).value();
    for (const int count : {1, 5, 16, 36, 160}) {
        for (const bool has_coarse : {false, true}) {
            Scene s = scene({{1.3, 0.9, 0.8}, {0.1, 0.0, 0.0}, 0.9}, count, 40.0);
            s.row.has_coarse = has_coarse;
            s.row.inverse = model.inverse(ColourSurface{0.8F, {0.05F, -0.02F}, {}});
            s.row.coarse_inverse = model.coarse_inverse(ColourSurface{0.8F, {0.03F, -0.02F}, {}});
            s.row.transfer = 0.8F;
            colour_cost_scalar(s.row);
            const std::vector<float> expected = s.cost;
            test::for_each_target([&] {
                colour_cost(s.row);
                for (std::size_t i = 0; i < expected.size(); ++i) {
                    ASSERT_NEAR(s.cost[i], expected[i], 1e-4F) << i;
                }
            });
        }
    }
}

}  // namespace
}  // namespace xtrack
