// SPDX-License-Identifier: Apache-2.0
#include "core/depth/depth_row.hpp"

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "tests/core/decode/each_target.hpp"

namespace xtrack {
namespace {

struct Out {
    std::vector<std::uint16_t> depth;
    std::vector<std::uint8_t> quality;
};
Out run(DepthRow row, void (*form)(const DepthRow&) noexcept) {
    Out out{std::vector<std::uint16_t>(static_cast<std::size_t>(row.count) + 1, 7777),
            std::vector<std::uint8_t>(static_cast<std::size_t>(row.count) + 1, 77)};
    row.depth = out.depth.data();
    row.quality = out.quality.data();
    form(row);
    return out;
}

TEST(DepthRow, EveryInstructionSetAgreesWithScalarOnRandomCoordinates) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> coordinate(-50.0F, 1100.0F);
    std::uniform_real_distribution<float> level(0.0F, 300.0F);
    for (const bool affine : {true, false}) {
        for (const int count : {1, 6, 16, 29, 640}) {
            std::vector<float> x, modulation, a, c;
            DepthRow row;
            row.count = count;
            row.a0 = 300.0F;
            row.a_step = 1.1F;
            row.c0 = 1.0F;
            row.c_step = -0.0004F;
            row.b = 180000.0F;
            row.d = 30.0F;
            row.near_mm = 300.0F;
            row.far_mm = 2000.0F;
            for (int i = 0; i < count; ++i) {
                x.push_back(i % 13 == 2 ? std::numeric_limits<float>::quiet_NaN()
                                        : coordinate(random));
                modulation.push_back(level(random));
                a.push_back(row.a0 + row.a_step * static_cast<float>(i));
                c.push_back(row.c0 + row.c_step * static_cast<float>(i));
            }
            row.coordinate_px = x.data();
            row.modulation = modulation.data();
            if (!affine) {
                row.a = a.data();
                row.c = c.data();
            }
            const Out expected = run(row, depth_row_scalar);
            test::for_each_target([&] {
                const Out actual = run(row, depth_row);
                EXPECT_EQ(actual.depth.back(), 7777);
                EXPECT_EQ(actual.quality.back(), 77);
                for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
                    // Fused multiply-add may round the last step of 0.1 mm the other way.
                    ASSERT_NEAR(actual.depth[i], expected.depth[i], 1) << i;
                    ASSERT_EQ(actual.quality[i], expected.quality[i]) << i;
                }
            });
        }
    }
}

TEST(DepthRow, ClipsToTheVolumeAndToAByteOfQuality) {
    // x = b / Z: a = 0, c = 1, d = 0 gives Z = b / x.
    const std::vector<float> x{
        100.0F, 1000.0F, 10.0F, 125.0F, std::numeric_limits<float>::quiet_NaN(), 0.0F};
    const std::vector<float> modulation{300.0F, 50.0F, 50.0F, 0.2F, 50.0F, 50.0F};
    DepthRow row;
    row.count = 6;
    row.coordinate_px = x.data();
    row.modulation = modulation.data();
    row.c0 = 1.0F;
    row.b = 100000.0F;
    row.near_mm = 500.0F;
    row.far_mm = 2000.0F;
    const Out out = run(row, depth_row);
    EXPECT_EQ(out.depth, (std::vector<std::uint16_t>{10000, 0, 0, 8000, 0, 0, 7777}));
    EXPECT_EQ(out.quality, (std::vector<std::uint8_t>{255, 0, 0, 1, 0, 0, 77}));
}

}  // namespace
}  // namespace xtrack
