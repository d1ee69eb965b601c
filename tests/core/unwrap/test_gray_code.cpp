// SPDX-License-Identifier: Apache-2.0
#include "core/unwrap/gray_code.hpp"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "tests/core/decode/each_target.hpp"

namespace xtrack {
namespace {

constexpr int kBits = 5;
constexpr double kCell = 32.0;

TEST(GrayCode, NamesItsCells) {
    for (std::uint32_t cell = 0; cell < 4096; ++cell) {
        EXPECT_EQ(cell_of_gray(cell ^ (cell >> 1U)), cell);
    }
}

// A row that sees projector coordinate x at pixel x, with edges softened over two pixels.
struct Scene {
    std::vector<std::vector<std::uint8_t>> bits, inverses;
    std::vector<std::uint8_t> white, black;
    int count = 1024;

    explicit Scene(double offset_px) : bits(kBits), inverses(kBits) {
        for (int x = 0; x < count; ++x) {
            white.push_back(180);
            black.push_back(20);
            for (int b = 0; b < kBits; ++b) {
                const auto bit = [&](double at) {
                    const auto c = static_cast<std::uint32_t>(
                        std::floor((std::floor(at + 0.5) + offset_px) / kCell));
                    return static_cast<double>(((c ^ (c >> 1U)) >> (kBits - 1 - b)) & 1U);
                };
                const double soft = 0.25 * (bit(x - 1.0) + 2.0 * bit(x) + bit(x + 1.0));
                bits[static_cast<std::size_t>(b)].push_back(
                    static_cast<std::uint8_t>(20.0 + 160.0 * soft));
                inverses[static_cast<std::size_t>(b)].push_back(
                    static_cast<std::uint8_t>(180.0 - 160.0 * soft));
            }
        }
    }
    GrayRow row() const {
        GrayRow r;
        r.count = count;
        r.bits = kBits;
        for (std::size_t b = 0; b < kBits; ++b) {
            r.image[b] = bits[b].data();
        }
        r.white = white.data();
        r.black = black.data();
        r.cell_px = kCell;
        r.min_modulation = 6.0F;
        r.edge_guard = 0.3F;
        return r;
    }
};

struct Result {
    std::vector<float> x, modulation;
};
Result run(GrayRow row) {
    Result out{std::vector<float>(static_cast<std::size_t>(row.count)),
               std::vector<float>(static_cast<std::size_t>(row.count))};
    row.coordinate_px = out.x.data();
    row.modulation = out.modulation.data();
    gray_code_row(row);
    return out;
}

TEST(GrayCode, GivesTheCentreOfItsCellAndTheEdgeWhereABitIsUncertain) {
    const Scene scene(0.0);
    const Result out = run(scene.row());
    int edges = 0;
    for (int x = 2; x < scene.count - 2; ++x) {
        const float got = out.x[static_cast<std::size_t>(x)];
        const double centre = std::floor(x / kCell) * kCell + 0.5 * kCell - 0.5;
        if (std::fabs(got - static_cast<float>(centre)) > 0.01F) {
            ++edges;
            // Within a pixel and a half of the edge that it names.
            EXPECT_NEAR(got, x, 1.5) << x;
        }
        EXPECT_LE(std::fabs(got - static_cast<float>(x)), 0.5F * 32.0F + 0.01F) << x;
    }
    EXPECT_EQ(edges, 2 * 31);
    EXPECT_FLOAT_EQ(out.modulation[100], 80.0F);
}

TEST(GrayCode, ReadsOffsetsAndInvertedBits) {
    const Scene scene(0.0);
    GrayRow row = scene.row();
    row.white = nullptr;
    row.black = nullptr;
    for (std::size_t b = 0; b < kBits; ++b) {
        row.inverse[b] = scene.inverses[b].data();
    }
    row.centre_only = true;
    EXPECT_FLOAT_EQ(run(row).x[100], 111.5F);
    EXPECT_FLOAT_EQ(run(row).modulation[100], 80.0F);

    // With an offset of 16 px the cell of pixel 100 spans 79.5 ... 111.5.
    const Scene moved(16.0);
    GrayRow shifted = moved.row();
    shifted.offset_px = 16.0;
    EXPECT_FLOAT_EQ(run(shifted).x[100], 95.5F);
}

TEST(GrayCode, EveryInstructionSetAgreesWithScalarOnRandomImages) {
    std::mt19937 random(5);
    for (const bool inverted : {false, true}) {
        for (const int count : {1, 7, 16, 29, 640}) {
            std::vector<std::vector<std::uint8_t>> pixels(22);
            for (auto& image : pixels) {
                for (int i = 0; i < count; ++i) {
                    image.push_back(static_cast<std::uint8_t>(random() & 255U));
                }
            }
            GrayRow row;
            row.count = count;
            row.bits = 10;
            for (std::size_t b = 0; b < 10; ++b) {
                row.image[b] = pixels[b].data();
                row.inverse[b] = inverted ? pixels[10 + b].data() : nullptr;
            }
            row.white = inverted ? nullptr : pixels[20].data();
            row.black = inverted ? nullptr : pixels[21].data();
            row.cell_px = 2.0;
            row.offset_px = 3.0;
            row.min_modulation = inverted ? 3.0F : 20.0F;
            row.saturation_limit = 254;
            row.edge_guard = 0.02F;
            Result expected{std::vector<float>(static_cast<std::size_t>(count)),
                            std::vector<float>(static_cast<std::size_t>(count))};
            GrayRow reference = row;
            reference.coordinate_px = expected.x.data();
            reference.modulation = expected.modulation.data();
            gray_code_row_scalar(reference);
            test::for_each_target([&] {
                const Result actual = run(row);
                for (std::size_t i = 0; i < actual.x.size(); ++i) {
                    ASSERT_EQ(std::isnan(actual.x[i]), std::isnan(expected.x[i])) << i;
                    ASSERT_EQ(actual.modulation[i], expected.modulation[i]) << i;
                    if (!std::isnan(expected.x[i])) {
                        ASSERT_EQ(actual.x[i], expected.x[i]) << i;
                    }
                }
            });
        }
    }
}

TEST(GrayCode, MasksDarkPixelsAndMixturesOfSurfaces) {
    Scene scene(0.0);
    scene.white[50] = 30;
    EXPECT_TRUE(std::isnan(run(scene.row()).x[50]));
    EXPECT_EQ(run(scene.row()).modulation[50], 0.0F);
    // The first bit uncertain far from the middle: its flip leads to a cell far away.
    scene.bits[0][200] = 100;
    EXPECT_TRUE(std::isnan(run(scene.row()).x[200]));
}

}  // namespace
}  // namespace xtrack
