// SPDX-License-Identifier: Apache-2.0
// The fast forms of the segmentation's kernels give the same bits as the plain ones.
#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "gestures/segment/block_row.hpp"
#include "gestures/segment/chamfer.hpp"
#include "gestures/segment/components.hpp"
#include "tests/core/decode/each_target.hpp"

namespace xtrack::segment {
namespace {

TEST(BlockRow, EveryInstructionSetAgreesWithScalarOnRandomDepth) {
    std::mt19937 random(3);
    for (const int scale : {1, 2, 3, 4, 5, 8}) {
        for (const int count : {1, 7, 8, 16, 17, 160, 211}) {
            const std::ptrdiff_t stride = static_cast<std::ptrdiff_t>(count) * scale + 3;
            std::vector<std::uint16_t> depth(static_cast<std::size_t>(stride * scale));
            for (std::uint16_t& d : depth) {
                // A surface, one 30 mm behind it, no depth, and the ends of the range.
                const unsigned kind = random() % 8;
                d = static_cast<std::uint16_t>(kind < 4   ? 6000 + random() % 100
                                               : kind < 6 ? 6300 + random() % 100
                                               : kind < 7 ? random() % 1600
                                                          : 65400 + random() % 136);
            }
            BlockRow row{depth.data(), stride, scale, count, 1500, 150, 0.1F, nullptr};
            std::vector<float> expected(static_cast<std::size_t>(count) + 1, -7.0F);
            row.z_mm = expected.data();
            block_row_scalar(row);
            test::for_each_target([&] {
                std::vector<float> actual(expected.size(), -7.0F);
                row.z_mm = actual.data();
                block_row(row);
                ASSERT_EQ(actual, expected) << scale << " " << count;
            });
        }
    }
}

TEST(BlockRow, OnePixelOfALargeBlockIsAFlyingOne) {
    std::vector<std::uint16_t> depth(16, 7000);
    depth[5] = 3000;
    float z = 0.0F;
    const BlockRow row{depth.data(), 4, 4, 1, 1500, 150, 0.1F, &z};
    block_row(row);
    EXPECT_FLOAT_EQ(z, 700.0F);
    depth[7] = 3000;
    block_row(row);
    EXPECT_FLOAT_EQ(z, 300.0F) << "two are a surface";
}

Grid empty_grid(Size size) {
    Rig rig;
    rig.camera.size = size;
    rig.camera.matrix(0, 0) = rig.camera.matrix(1, 1) = size.width;
    Grid grid;
    grid.create(rig, size, 1, 1);
    return grid;
}

TEST(Spread, EveryInstructionSetAgreesWithScalarOnRandomSeedsAndLabels) {
    std::mt19937 random(4);
    for (const Size size : {Size{5, 4}, Size{8, 8}, Size{13, 9}, Size{160, 30}}) {
        const Grid grid = empty_grid(size);
        std::vector<std::uint16_t> seeds(grid.size(), 0);
        std::vector<std::uint16_t> label(grid.size(), 0);
        for (std::size_t i = 0; i < seeds.size(); ++i) {
            seeds[i] = random() % 9 == 0 ? static_cast<std::uint16_t>(65535 - random() % 300) : 0;
            // Short runs of few labels: ends of labels come at every lane.
            label[i] = static_cast<std::uint16_t>(random() % 3 == 0 || i == 0 ? random() % 4
                                                                              : label[i - 1]);
        }
        for (const bool labelled : {false, true}) {
            std::vector<std::uint16_t> expected = seeds;
            const int first = grid.index(0, 0);
            spread_rows_scalar({expected.data() + first, labelled ? label.data() + first : nullptr,
                                grid.width, size.width, size.height});
            test::for_each_target([&] {
                std::vector<std::uint16_t> actual = seeds;
                spread(grid, grid.whole(), actual,
                       labelled ? std::span<const std::uint16_t>(label)
                                : std::span<const std::uint16_t>());
                ASSERT_EQ(actual, expected) << size.width << " " << labelled;
            });
        }
    }
}

TEST(Spread, DistancesAreWithinTwoPercent) {
    const Grid grid = empty_grid({101, 101});
    std::vector<std::uint16_t> nearness(grid.size(), 0);
    nearness[static_cast<std::size_t>(grid.index(50, 50))] = kNearnessMax;
    spread(grid, grid.whole(), nearness);
    for (int y = 0; y <= 100; y += 5) {
        for (int x = 0; x <= 100; x += 5) {
            const double truth = std::hypot(x - 50, y - 50);
            EXPECT_NEAR(static_cast<double>(
                            distance_px(nearness[static_cast<std::size_t>(grid.index(x, y))])),
                        truth, 0.021 * truth)
                << x << " " << y;
        }
    }
}

/// Components of a picture whose letters are what may be joined.
std::vector<int> components_of(const std::vector<std::string>& picture, int& count) {
    const Grid grid =
        empty_grid({static_cast<int>(picture.front().size()), static_cast<int>(picture.size())});
    std::vector<std::uint8_t> value(grid.size(), 0);
    for (int y = 0; y < grid.inner_height; ++y) {
        for (int x = 0; x < grid.inner_width; ++x) {
            const char c = picture[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)];
            value[static_cast<std::size_t>(grid.index(x, y))] =
                c == '.' ? std::uint8_t{0} : static_cast<std::uint8_t>(c);
        }
    }
    Components components;
    components.create(grid);
    components.find_in(grid, grid.whole(), std::span<const std::uint8_t>(value), [&](int a, int b) {
        return value[static_cast<std::size_t>(a)] == value[static_cast<std::size_t>(b)];
    });
    count = components.count();
    std::vector<int> of_run;
    for (const Components::Run& run : components.runs()) {
        of_run.push_back(run.component);
    }
    return of_run;
}

TEST(Components, AreJoinedAroundCornersAndByWhatIsTheSame) {
    int count = 0;
    // Arms of a U meet at last; a diagonal joins; letters part.
    EXPECT_EQ(components_of({"a..a..b", "a..a.b.", "aaaa..c"}, count),
              (std::vector<int>{0, 0, 1, 0, 0, 1, 0, 2}));
    EXPECT_EQ(count, 3);
    EXPECT_EQ(components_of({"aabb", "bbaa"}, count), (std::vector<int>{0, 1, 1, 0}))
        << "each touches its like across the corner";
    EXPECT_EQ(count, 2);
    components_of({"....", "...."}, count);
    EXPECT_EQ(count, 0);
}

}  // namespace
}  // namespace xtrack::segment
