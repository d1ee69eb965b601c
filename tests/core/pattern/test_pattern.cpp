// SPDX-License-Identifier: Apache-2.0
#include <xtrack/pattern.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace xtrack {
namespace {

using testing::HasSubstr;

constexpr Size kProjector{64, 48};

void expect_refused(const PatternSequence& s, const std::string& field) {
    const auto result = validate(s);
    ASSERT_FALSE(result.ok()) << field;
    EXPECT_THAT(result.error().message, HasSubstr(field));
    EXPECT_THAT(result.error().message, HasSubstr(";"));
}

TEST(Pattern, BuildersMakeValidSequences) {
    for (const auto& s : {three_step_sequence(Axis::x, kProjector, 16.0),
                          n_step_sequence(Axis::y, kProjector, 12.5, 7),
                          dual_sequence(Axis::y, kProjector, 48.0, 8.0),
                          gray_code_sequence(Axis::x, kProjector, 8.0),
                          rgb_sequence(Axis::y, kProjector, {48.0, 8.0})}) {
        const auto result = validate(s);
        EXPECT_TRUE(result.ok()) << result.error().message;
    }
}

TEST(Pattern, DualSequenceIsCoarseThenFine) {
    const auto s = dual_sequence(Axis::y, {1024, 768}, 320.0, 32.0);
    ASSERT_EQ(s.patterns.size(), 6U);
    EXPECT_EQ(s.patterns[0].period_px, 320.0);
    EXPECT_EQ(s.patterns[5].period_px, 32.0);
    EXPECT_NEAR(s.patterns[5].phase_rad[0], -4.1887902, 1e-7);
    EXPECT_EQ(s.coded_length_px(), 768);
}

TEST(Pattern, GrayCodeSequenceHasTheBitsThatItsCellsNeed) {
    const auto s = gray_code_sequence(Axis::y, {1024, 768}, 32.0);  // 24 cells: 5 bits
    ASSERT_EQ(s.patterns.size(), 2U + 5U + 3U);
    EXPECT_EQ(s.patterns[2].bits, 5);
    EXPECT_EQ(s.patterns[6].bit, 4);
    EXPECT_EQ(s.patterns[9].kind, PatternKind::sine);
}

TEST(Pattern, BadFieldsAreNamed) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const auto good = dual_sequence(Axis::x, kProjector, 32.0, 8.0);
    auto s = good;
    s.patterns[3].period_px = 0.0;
    expect_refused(s, "sequence[3].period_px");
    s.patterns[3].period_px = nan;
    expect_refused(s, "sequence[3].period_px");
    s = good;
    s.patterns[1].phase_rad[0] = nan;
    expect_refused(s, "sequence[1].phase_rad");
    s = good;
    s.projector_size.width = 1000000000;
    expect_refused(s, "projector_size");
    s = good;
    s.gamma = -1.0;
    expect_refused(s, "gamma");
    s = good;
    s.patterns.clear();
    expect_refused(s, "sequence");
    s = gray_code_sequence(Axis::x, kProjector, 8.0);
    s.patterns[2].bit = 3;
    expect_refused(s, "sequence[2].bit");
    s.patterns[2].bits = 1000000000;
    expect_refused(s, "sequence[2].bits");
    s = gray_code_sequence(Axis::x, kProjector, 8.0);
    s.patterns[3].cell_px = 0.0;
    expect_refused(s, "sequence[3].cell_px");
    s.patterns[0].level = 1.5;
    expect_refused(s, "sequence[0].level");
}

TEST(Pattern, SineHasItsCrestAtTheFirstPixelOfEachPeriod) {
    const auto s = three_step_sequence(Axis::x, kProjector, 16.0);
    EXPECT_DOUBLE_EQ(intensity(s.patterns[0], 0.0), 1.0);
    EXPECT_NEAR(intensity(s.patterns[0], 8.0), 0.0, 1e-12);
    EXPECT_NEAR(intensity(s.patterns[0], 4.0), 0.5, 1e-12);
    // The three phases of one pixel add up to 3/2 everywhere.
    for (double x = 0.0; x < 20.0; x += 0.37) {
        double sum = 0.0;
        for (const Pattern& p : s.patterns) {
            sum += intensity(p, x);
        }
        EXPECT_NEAR(sum, 1.5, 1e-12);
    }
}

TEST(Pattern, GrayCodeChangesOneBitFromCellToCell) {
    Pattern p;
    p.kind = PatternKind::gray_code;
    p.bits = 3;
    p.cell_px = 4.0;
    p.offset_px = 2.0;
    // Cell of pixel x is floor((x + 2) / 4): pixels 0,1 | 2..5 | 6..9 | ... are 000 001 011 010 110
    const int expected[5] = {0b000, 0b001, 0b011, 0b010, 0b110};
    for (int x = 0; x < 18; ++x) {
        int code = 0;
        for (p.bit = 0; p.bit < 3; ++p.bit) {
            code = code * 2 + static_cast<int>(intensity(p, x));
        }
        EXPECT_EQ(code, expected[(x + 2) / 4]) << x;
    }
    p.bit = 2;
    EXPECT_EQ(intensity(p, 1.49), 0.0);  // still nearest to pixel 1
    EXPECT_EQ(intensity(p, 1.51), 1.0);
    p.inverted = true;
    EXPECT_EQ(intensity(p, 1.49), 1.0);
}

TEST(Pattern, RendersAlongEachAxis) {
    auto s = three_step_sequence(Axis::x, kProjector, 16.0);
    Image<std::uint8_t> image;
    ASSERT_EQ(*render_pattern(s, 0, image), PixelFormat::grey8);
    ASSERT_EQ(image.size(), kProjector);
    for (const int y : {0, 47}) {
        EXPECT_EQ(image.at(0, y), 255);
        EXPECT_EQ(image.at(4, y), 128);  // 127.5 rounds up
        EXPECT_EQ(image.at(8, y), 0);
        EXPECT_EQ(image.at(16, y), 255);
    }
    s.axis = Axis::y;
    ASSERT_TRUE(render_pattern(s, 0, image).ok());
    EXPECT_EQ(image.at(63, 0), 255);
    EXPECT_EQ(image.at(0, 8), 0);
    EXPECT_EQ(image.at(63, 8), 0);
}

TEST(Pattern, ColourIsInTheOrderBlueGreenRed) {
    const auto s = rgb_sequence(Axis::y, kProjector, {12.0});
    Image<std::uint8_t> image;
    ASSERT_EQ(*render_pattern(s, 0, image), PixelFormat::bgr8);
    ASSERT_EQ(image.width(), 3 * 64);
    // Red has phase 0: its crest is at row 0, where green and blue are at 1/4.
    EXPECT_EQ(image.at(3 * 10 + 2, 0), 255);
    EXPECT_EQ(image.at(3 * 10 + 1, 0), 64);
    EXPECT_EQ(image.at(3 * 10 + 0, 0), 64);
    // Green's crest is a third of the period on.
    EXPECT_EQ(image.at(3 * 10 + 1, 4), 255);
    EXPECT_EQ(image.at(3 * 10 + 0, 8), 255);
}

TEST(Pattern, CompensationNeedsAKnownGammaAndUndoesIt) {
    auto s = three_step_sequence(Axis::x, kProjector, 16.0);
    Image<std::uint8_t> image;
    const auto refused = render_pattern(s, 0, image, GammaCompensation::precompensate);
    ASSERT_FALSE(refused.ok());
    EXPECT_THAT(refused.error().message, HasSubstr("gamma"));
    s.gamma = 2.2;
    ASSERT_TRUE(render_pattern(s, 0, image).ok());
    EXPECT_EQ(image.at(4, 0), 128);
    ASSERT_TRUE(render_pattern(s, 0, image, GammaCompensation::precompensate).ok());
    EXPECT_NEAR(std::pow(image.at(4, 0) / 255.0, 2.2), 0.5, 0.01);
}

ProjectorResponse power_response(double red, double green, double blue) {
    ProjectorResponse response;
    for (int i = 0; i <= 51; ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
            response.light[c].push_back(
                std::pow(i / 51.0, std::array<double, 3>{red, green, blue}[c]));
        }
    }
    return response;
}

TEST(Pattern, CompensationUndoesAMeasuredResponseAlike) {
    auto s = three_step_sequence(Axis::x, kProjector, 16.0);
    s.gamma = 1.3;  // passed over where the response is known
    s.response = power_response(2.2, 2.2, 2.2);
    Image<std::uint8_t> image;
    ASSERT_EQ(*render_pattern(s, 0, image, GammaCompensation::precompensate), PixelFormat::grey8);
    for (int x = 0; x < 16; ++x) {
        EXPECT_NEAR(std::pow(image.at(x, 5) / 255.0, 2.2), intensity(s.patterns[0], x), 0.01) << x;
    }
}

TEST(Pattern, CompensationGivesEachColourItsOwn) {
    auto s = three_step_sequence(Axis::x, kProjector, 16.0);
    s.response = power_response(1.0, 1.8, 2.4);
    Image<std::uint8_t> image;
    ASSERT_EQ(*render_pattern(s, 0, image), PixelFormat::grey8);
    // A grey fringe then needs colours.
    ASSERT_EQ(*render_pattern(s, 0, image, GammaCompensation::precompensate), PixelFormat::bgr8);
    ASSERT_EQ(image.width(), 3 * 64);
    for (int x = 0; x < 16; ++x) {
        const double light = intensity(s.patterns[0], x);
        EXPECT_NEAR(std::pow(image.at(3 * x, 5) / 255.0, 2.4), light, 0.01) << x;
        EXPECT_NEAR(std::pow(image.at(3 * x + 1, 5) / 255.0, 1.8), light, 0.01) << x;
        EXPECT_NEAR(image.at(3 * x + 2, 5) / 255.0, light, 0.01) << x;
    }
}

TEST(Pattern, ResponsesThatAreNoneAreNamed) {
    auto s = three_step_sequence(Axis::x, kProjector, 16.0);
    s.response = power_response(1.0, 1.8, 2.4);
    EXPECT_TRUE(validate(s));
    s.response->light[1][7] = 0.0;
    expect_refused(s, "response_green[7]");
    s.response->light[1][7] = std::numeric_limits<double>::quiet_NaN();
    expect_refused(s, "response_green[7]");
    s.response = power_response(1.0, 1.8, 2.4);
    s.response->light[2].back() = 0.99;
    expect_refused(s, "response_blue");
    s.response->light[2].pop_back();
    expect_refused(s, "response_blue is 51 numbers long");
    s.response->light = {std::vector<double>{0.0, 1.0}, {0.0, 1.0}, {0.0, 1.0}};
    expect_refused(s, "response_red");
}

TEST(Pattern, IndexOutOfRangeIsRefused) {
    const auto s = three_step_sequence(Axis::x, kProjector, 16.0);
    Image<std::uint8_t> image;
    for (const int index : {-1, 3}) {
        const auto result = render_pattern(s, index, image);
        ASSERT_FALSE(result.ok());
        EXPECT_THAT(result.error().message, HasSubstr("pattern index"));
    }
}

}  // namespace
}  // namespace xtrack
