// SPDX-License-Identifier: Apache-2.0
#include "core/unwrap/spatial_row.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "tests/core/decode/each_target.hpp"

namespace xtrack {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
constexpr int kWords = 3;
constexpr int kPixels = kWords * kWordPixels;
constexpr std::size_t kPadded = kPixels + 2 * kRowMargin;

/// Padded rows of random phases and modulations, some of them none.
class Rows {
 public:
    Rows() {
        std::mt19937 random(7);
        std::uniform_real_distribution<float> phase(-3.14F, 3.14F);
        std::uniform_real_distribution<float> level(0.0F, 90.0F);
        for (std::size_t r = 0; r < 6; ++r) {
            rows_[r].assign(kPadded, r == 5 ? 0.0F : kNone);
            for (int x = 0; x < kPixels; ++x) {
                const bool none = random() % 5 == 0;
                rows_[r][static_cast<std::size_t>(x + kRowMargin)] =
                    r == 5 ? level(random) : (none ? kNone : phase(random));
            }
        }
    }
    [[nodiscard]] const float* operator[](std::size_t r) const {
        return rows_[r].data() + kRowMargin;
    }

 private:
    std::vector<float> rows_[6];
};

/// Everything a form writes, as bits, so that NaN equals itself.
using Bits = std::vector<std::uint64_t>;

void append(Bits& bits, const std::vector<float>& values) {
    for (const float value : values) {
        bits.push_back(std::isnan(value) ? 1U : std::bit_cast<std::uint32_t>(value));
    }
}

Bits taken(void (*form)(const TakeRow&) noexcept, int count) {
    const Rows rows;
    std::vector<float> phase(rows[0], rows[0] + count), level(rows[5], rows[5] + count);
    phase[0] = std::numeric_limits<float>::infinity();
    phase.back() = 3.2F;
    level[static_cast<std::size_t>(count / 2)] = kNone;
    level[static_cast<std::size_t>(count / 3)] = -2.0F;
    std::vector<float> out_phase(kPadded, -7.0F), out_level(kPadded, -7.0F), best(kWords, -7.0F);
    TakeRow row;
    row.count = count;
    row.phase_rad = phase.data();
    row.modulation = level.data();
    row.padded_phase_rad = out_phase.data();
    row.padded_modulation = out_level.data();
    row.best_modulation = best.data();
    form(row);
    Bits bits;
    append(bits, out_phase);
    append(bits, out_level);
    append(bits, best);
    return bits;
}

Bits stepped(void (*form)(const StepRow&) noexcept) {
    const Rows rows;
    std::vector<float> right(kPadded, -7.0F), below(kPadded, -7.0F);
    Bits bits(5 * kWords);
    StepRow row;
    row.words = kWords;
    row.phase_rad = rows[0];
    row.below_rad = rows[1];
    row.right_step_rad = right.data();
    row.below_step_rad = below.data();
    row.valid = bits.data();
    row.right_up = bits.data() + kWords;
    row.right_down = bits.data() + 2 * kWords;
    row.below_up = bits.data() + 3 * kWords;
    row.below_down = bits.data() + 4 * kWords;
    form(row);
    append(bits, right);
    append(bits, below);
    return bits;
}

Bits judged(void (*form)(const JudgeRow&) noexcept) {
    const Rows rows;
    Bits bits(2 * kWords);
    JudgeRow row;
    row.words = kWords;
    row.step_rad = rows[2];
    row.beside_rad = {rows[0], rows[1], rows[3], rows[4]};
    row.modulation = rows[5];
    row.other_modulation = rows[5] + 1;
    row.limit_rad = 2.0F;
    row.noise = 40.0F;
    row.sound_limit_rad = 1.5F;
    row.floor_rad = 0.3F;
    row.possible = bits.data();
    row.sound = bits.data() + kWords;
    form(row);
    return bits;
}

Bits subtracted(void (*form)(const SubtractRow&) noexcept, int count) {
    const Rows rows;
    std::vector<float> out(kPixels, -7.0F);
    form({count, rows[0], rows[1], out.data()});
    Bits bits;
    append(bits, out);
    return bits;
}

Bits pieced(void (*form)(const PieceRow&) noexcept, int count) {
    const Rows rows;
    std::vector<float> out(kPixels, -7.0F);
    std::vector<std::uint16_t> component(kPixels, 77);
    std::vector<PhasePiece> pieces;
    for (int end = 0, id = 0; end < count; ++id) {
        end = std::min(count, end + 1 + 7 * id % 23);
        pieces.push_back({end, id % 3 == 0 ? kNone : 6.25F * static_cast<float>(id),
                          static_cast<std::uint16_t>(id)});
    }
    form({count, pieces, rows[0], out.data(), component.data()});
    Bits bits(component.begin(), component.end());
    append(bits, out);
    return bits;
}

TEST(SpatialRow, EveryInstructionSetGivesTheBitsOfTheScalarForm) {
    test::for_each_target([] {
        for (const int count : {1, 17, 64, 65, kPixels}) {
            EXPECT_EQ(taken(take_row, count), taken(take_row_scalar, count)) << count;
            EXPECT_EQ(subtracted(subtract_row, count), subtracted(subtract_row_scalar, count));
            EXPECT_EQ(pieced(piece_row, count), pieced(piece_row_scalar, count)) << count;
        }
        EXPECT_EQ(stepped(step_row), stepped(step_row_scalar));
        EXPECT_EQ(judged(judge_row), judged(judge_row_scalar));
    });
}

TEST(SpatialRow, StepsWrapTowardTheNearerTurn) {
    std::vector<float> phase(kPadded, kNone), below(kPadded, kNone);
    std::vector<float> right_step(kPadded), below_step(kPadded);
    phase[kRowMargin] = 3.0F;
    phase[kRowMargin + 1] = -3.0F;
    phase[kRowMargin + 2] = 2.5F;
    below[kRowMargin] = 2.0F;
    std::uint64_t words[5] = {};
    step_row_scalar({1, phase.data() + kRowMargin, below.data() + kRowMargin,
                     right_step.data() + kRowMargin, below_step.data() + kRowMargin, &words[0],
                     &words[1], &words[2], &words[3], &words[4]});
    EXPECT_EQ(words[0], 0b111U);
    EXPECT_EQ(words[1], 0b001U);
    EXPECT_EQ(words[2], 0b010U);
    EXPECT_EQ(words[3], 0U);
    EXPECT_EQ(words[4], 0U);
    EXPECT_NEAR(right_step[kRowMargin], 0.2832F, 1e-4F);
    EXPECT_NEAR(right_step[kRowMargin + 1], -0.7832F, 1e-4F);
    EXPECT_TRUE(std::isnan(right_step[kRowMargin + 2]));
    EXPECT_EQ(below_step[kRowMargin], -1.0F);
}

TEST(SpatialRow, DifferencesStayWithinATurn) {
    const std::vector<float> phase{3.0F, -3.0F, 1.0F, kNone, 3.1415927F};
    const std::vector<float> from{-3.0F, 3.0F, 0.5F, 0.0F, -3.1415927F};
    std::vector<float> off(5);
    subtract_row_scalar({5, phase.data(), from.data(), off.data()});
    EXPECT_NEAR(off[0], -0.2832F, 1e-4F);
    EXPECT_NEAR(off[1], 0.2832F, 1e-4F);
    EXPECT_EQ(off[2], 0.5F);
    EXPECT_TRUE(std::isnan(off[3]));
    EXPECT_NEAR(off[4], 0.0F, 1e-6F);
}

TEST(SpatialRow, DeviationIsFromTheMedianOfItsNeighbours) {
    EXPECT_NEAR(step_deviation(0.3F, 0.3F, 0.3F, 0.3F, 0.3F), 0.0F, 1e-6F);
    // A depth step, one that a pixel on the edge halves, and the step beside one.
    EXPECT_NEAR(step_deviation(2.3F, 0.3F, 0.3F, 0.3F, 0.3F), 2.0F, 1e-6F);
    EXPECT_NEAR(step_deviation(1.3F, 0.3F, 0.3F, 1.3F, 0.3F), 1.0F, 1e-6F);
    EXPECT_NEAR(step_deviation(0.3F, 0.3F, 2.3F, 0.3F, 0.3F), 0.0F, 1e-6F);
    // A crease, half way between its slopes.
    EXPECT_NEAR(step_deviation(0.3F, 0.3F, 0.3F, 0.7F, 0.7F), 0.2F, 1e-6F);
    // At borders, and alone.
    EXPECT_NEAR(step_deviation(0.9F, kNone, kNone, 0.2F, 0.4F), 0.6F, 1e-6F);
    EXPECT_NEAR(step_deviation(0.9F, kNone, 0.5F, kNone, kNone), 0.4F, 1e-6F);
    EXPECT_NEAR(step_deviation(-0.9F, kNone, kNone, kNone, kNone), 0.9F, 1e-6F);
    EXPECT_TRUE(std::isnan(step_deviation(kNone, 0.1F, 0.1F, 0.1F, 0.1F)));
}

}  // namespace
}  // namespace xtrack
