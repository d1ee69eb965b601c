// SPDX-License-Identifier: Apache-2.0
#include "core/depth/points_row.hpp"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "core/depth/distortion.hpp"
#include "core/depth/pixel_rays.hpp"
#include "tests/core/decode/each_target.hpp"

namespace xtrack {
namespace {

TEST(PointsRow, EveryInstructionSetAgreesWithScalar) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> ray(-0.7F, 0.7F);
    for (const bool affine : {true, false}) {
        for (const int count : {1, 6, 16, 29, 640}) {
            std::vector<std::uint16_t> depth;
            std::vector<float> x, y;
            for (int i = 0; i < count; ++i) {
                depth.push_back(i % 5 == 1 ? 0 : static_cast<std::uint16_t>(random() % 65536U));
                x.push_back(ray(random));
                y.push_back(ray(random));
            }
            PointsRow row;
            row.count = count;
            row.depth = depth.data();
            row.unit_mm = 0.1F;
            row.ray_x = affine ? nullptr : x.data();
            row.ray_y = affine ? nullptr : y.data();
            row.x0 = -0.5F;
            row.x_step = 1.0F / 640.0F;
            row.y0 = 0.2F;
            row.y_step = 1e-5F;
            const auto made = [&](void (*form)(const PointsRow&) noexcept, std::size_t offset) {
                // A row that is not on a border of 64 bytes is written another way.
                std::vector<float> out(3 * static_cast<std::size_t>(count) + offset + 1, -7.0F);
                row.xyz_mm = out.data() + offset;
                form(row);
                EXPECT_EQ(out.back(), -7.0F);
                return std::vector<float>(out.begin() + static_cast<std::ptrdiff_t>(offset),
                                          out.end());
            };
            const std::vector<float> expected = made(points_row_scalar, 0);
            test::for_each_target([&] {
                for (const std::size_t offset : {0U, 1U, 4U}) {
                    const std::vector<float> actual = made(points_row, offset);
                    for (std::size_t i = 0; i < expected.size(); ++i) {
                        ASSERT_EQ(std::isnan(actual[i]), std::isnan(expected[i])) << i;
                        if (!std::isnan(expected[i])) {
                            ASSERT_NEAR(actual[i], expected[i], 2e-3F) << i;
                        }
                    }
                }
            });
        }
    }
}

TEST(PixelRays, AreThoseOfTheCamera) {
    Pinhole camera;
    camera.matrix << 500.0, 0.0, 321.0, 0.0, 510.0, 238.0, 0.0, 0.0, 1.0;
    camera.size = {640, 480};
    for (const double k1 : {0.0, -0.1}) {
        camera.distortion[0] = k1;
        const PixelRays rays(camera);
        const std::vector<std::uint16_t> depth(640, 10000);
        std::vector<float> xyz(3 * 640);
        for (const int y : {0, 17, 479}) {
            PointsRow row;
            rays.prepare_row(y, row);
            row.count = 640;
            row.depth = depth.data();
            row.unit_mm = 0.1F;
            row.xyz_mm = xyz.data();
            points_row_scalar(row);
            for (const std::size_t u : {0U, 100U, 639U}) {
                const RayXY ray = ray_of_pixel(camera, static_cast<double>(u), y);
                EXPECT_NEAR(xyz[3 * u], 1000.0 * ray.x, 1e-2);
                EXPECT_NEAR(xyz[3 * u + 1], 1000.0 * ray.y, 1e-2);
                EXPECT_NEAR(xyz[3 * u + 2], 1000.0, 1e-3);
            }
        }
    }
}

}  // namespace
}  // namespace xtrack
