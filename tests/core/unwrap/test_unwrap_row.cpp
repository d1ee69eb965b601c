// SPDX-License-Identifier: Apache-2.0
#include "core/unwrap/unwrap_row.hpp"

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "tests/core/decode/each_target.hpp"

namespace xtrack {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

std::vector<float> run(UnwrapRow row, void (*form)(const UnwrapRow&) noexcept) {
    std::vector<float> out(static_cast<std::size_t>(row.count) + 1, -77.0F);
    row.coordinate_px = out.data();
    form(row);
    return out;
}

TEST(UnwrapRow, EveryInstructionSetAgreesWithScalarOnRandomPhases) {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> phase(-std::numbers::pi_v<float>,
                                                std::numbers::pi_v<float>);
    std::uniform_real_distribution<float> reference(-20.0F, 1100.0F);
    for (const int count : {1, 5, 16, 31, 640}) {
        std::vector<float> phases, references;
        for (int i = 0; i < count; ++i) {
            phases.push_back(i % 7 == 3 ? kNone : phase(random));
            references.push_back(i % 11 == 5 ? kNone : reference(random));
        }
        UnwrapRow row;
        row.count = count;
        row.phase_rad = phases.data();
        row.reference_px = references.data();
        row.period_px = 32.0;
        row.tolerance = 0.4F;
        row.coordinate_min_px = -1.5F;
        row.coordinate_max_px = 1024.5F;
        const std::vector<float> expected = run(row, unwrap_row_scalar);
        test::for_each_target([&] {
            const std::vector<float> actual = run(row, unwrap_row);
            EXPECT_EQ(actual.back(), -77.0F);
            for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
                ASSERT_EQ(std::isnan(actual[i]), std::isnan(expected[i])) << i;
                if (!std::isnan(expected[i])) {
                    ASSERT_NEAR(actual[i], expected[i], 2e-4F) << i;
                }
            }
        });
    }
}

TEST(UnwrapRow, FindsTheOrderFromACoarserPeriod) {
    std::vector<float> phases, references, truth;
    for (int i = 0; i < 1000; ++i) {
        const double x = 1.02 * i;
        truth.push_back(static_cast<float>(x));
        phases.push_back(static_cast<float>(
            std::remainder(2.0 * std::numbers::pi * x / 48.0, 2.0 * std::numbers::pi)));
        // Off by up to 23 of the 24 px that half a period allows.
        references.push_back(static_cast<float>(x + 23.0 * std::sin(i)));
    }
    UnwrapRow row;
    row.count = 1000;
    row.phase_rad = phases.data();
    row.reference_px = references.data();
    row.period_px = 48.0;
    const std::vector<float> x = run(row, unwrap_row);
    for (std::size_t i = 0; i < 1000; ++i) {
        ASSERT_NEAR(x[i], truth[i], 0.001F) << i;
    }
    row.tolerance = 0.25F;
    int masked = 0;
    for (std::size_t i = 0; i < 1000; ++i) {
        masked += std::isnan(run(row, unwrap_row)[i]) ? 1 : 0;
        if (i > 20) {
            break;
        }
    }
    EXPECT_GT(masked, 5);
}

}  // namespace
}  // namespace xtrack
