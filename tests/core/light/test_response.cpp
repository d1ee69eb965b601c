// SPDX-License-Identifier: Apache-2.0
// The projector's response from a ramp of flats, judged by the simulator's own.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <vector>

#include <gmock/gmock.h>

#include "tests/core/light/shown_light.hpp"

namespace xtrack {
namespace {

using testing::HasSubstr;

class Projectors : public testing::TestWithParam<test::BentProjector> {};

// A grey camera sees one mix of the colours: BT.601 luma, as the simulator's does.
TEST_P(Projectors, AreMeasuredByAGreyCamera) {
    const SimSettings s = test::bent_wall(GetParam());
    const auto found = test::calibrate(s);
    ASSERT_TRUE(found) << found.error().message;
    ASSERT_TRUE(found->response);
    EXPECT_FALSE(found->colour);
    const std::vector<double>& light = found->response->response.light[0];
    EXPECT_EQ(light, found->response->response.light[2]);
    double worst = 0.0;
    for (std::size_t i = 0; i < light.size(); ++i) {
        const double value = static_cast<double>(i) / static_cast<double>(light.size() - 1);
        const double truth = 0.299 * test::true_light(s.projector, value, 0) +
                             0.587 * test::true_light(s.projector, value, 1) +
                             0.114 * test::true_light(s.projector, value, 2);
        worst = std::max(worst, std::fabs(light[i] - truth));
    }
    std::printf("%s, grey: off by %.4f of full light, single pixels spread %.4f\n", GetParam().name,
                worst, found->response->spread);
    EXPECT_LT(worst, 0.003);
    EXPECT_GT(found->response->spread, worst);
    EXPECT_GT(found->response->pixels, 5000U);
    PatternSequence with = s.patterns;
    with.response = found->response->response;
    EXPECT_TRUE(validate(with));
}

// With crosstalk and a wall that is not white.
TEST_P(Projectors, AreMeasuredColourByColour) {
    SimSettings s = test::bent_wall(GetParam());
    s.camera.colour = true;
    Mat3d rgb;
    rgb << 0.86, 0.12, 0.02, 0.08, 0.84, 0.08, 0.01, 0.13, 0.86;
    s.rig.camera_from_projector_rgb = rgb;
    const auto found = test::calibrate(s);
    ASSERT_TRUE(found) << found.error().message;
    ASSERT_TRUE(found->response && found->colour);
    EXPECT_TRUE(found->colour->passed) << found->colour->reason;
    double worst = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
        worst = std::max(worst, test::worst_error(s.projector, found->response->response, k));
    }
    std::printf("%s, colours: off by %.4f of full light, phase error %.4f rad: %s\n",
                GetParam().name, worst, found->colour->phase_error_rad,
                found->colour->reason.c_str());
    EXPECT_LT(worst, 0.005);
}

INSTANTIATE_TEST_SUITE_P(Simulated, Projectors, testing::ValuesIn(test::kBentProjectors),
                         test::name_of_projector);

TEST(LightCalibrator, SaysWhatImagesLack) {
    const auto message = [](const SimSettings& s, const std::function<void(Frame&)>& disturb = {}) {
        const auto found = test::calibrate(s, disturb);
        return found ? std::string() : found.error().message;
    };
    SimSettings dark = test::light_on_a_wall();
    dark.projector.light_grey = 8.0;
    EXPECT_THAT(message(dark), HasSubstr("too dark"));
    SimSettings bright = test::light_on_a_wall();
    bright.projector.light_grey = 1000.0;
    bright.room.wall_distance_mm = 600.0;
    EXPECT_THAT(message(bright), HasSubstr("clipped"));
    SimSettings short_one = test::light_on_a_wall();
    short_one.duration_s *= 0.3;
    EXPECT_THAT(message(short_one), HasSubstr("no image shows pattern 8"));
    // A camera that turns its gain down once the wall is bright.
    EXPECT_THAT(message(test::light_on_a_wall(),
                        [](Frame& frame) {
                            if (frame.pattern >= 12) {
                                for (int y = 0; y < frame.height(); ++y) {
                                    for (int x = 0; x < frame.width(); ++x) {
                                        frame.pixels.at(x, y) /= 2;
                                    }
                                }
                            }
                        }),
                HasSubstr("the flat of 71 % is darker in the images than that of 65 %"));
}

TEST(LightCalibrator, SaysWhatASequenceLacks) {
    const auto message = [](const PatternSequence& sequence) {
        const auto made = LightCalibrator::create(sequence, {640, 480});
        return made ? std::string() : made.error().message;
    };
    PatternSequence s = light_sequence(Axis::x, {1280, 720});
    EXPECT_EQ(message(s), "");
    PatternSequence no_white = s;
    no_white.patterns.erase(no_white.patterns.begin() + 17);
    EXPECT_THAT(message(no_white), HasSubstr("levels 0 and 1"));
    PatternSequence few = s;
    few.patterns.erase(few.patterns.begin() + 1, few.patterns.begin() + 14);
    EXPECT_THAT(message(few), HasSubstr("the ramp is incomplete: it has 5 grey levels"));
    PatternSequence no_ramp = s;
    no_ramp.patterns.erase(no_ramp.patterns.begin(), no_ramp.patterns.begin() + 18);
    EXPECT_THAT(message(no_ramp), HasSubstr("response is not known"));
    no_ramp.gamma = 1.0;
    EXPECT_EQ(message(no_ramp), "");
    no_ramp.gamma = 2.2;
    EXPECT_THAT(message(no_ramp), HasSubstr("black and white"));
    PatternSequence no_sines = s;
    std::erase_if(no_sines.patterns, [](const Pattern& p) { return p.kind == PatternKind::sine; });
    EXPECT_THAT(message(no_sines), HasSubstr("three grey sines"));
    EXPECT_THAT(message(three_step_sequence(Axis::x, {1280, 720}, 64.0)), HasSubstr("neither"));
    s.patterns[3].level = 2.0;
    EXPECT_THAT(message(s), HasSubstr("sequence[3].level"));
}

TEST(LightCalibrator, TakesOnlyImagesOfItsSize) {
    const PatternSequence s = light_sequence(Axis::x, {1280, 720});
    auto calibrator = LightCalibrator::create(s, {64, 48}).value();
    Frame frame;
    frame.pixels = Image<std::uint8_t>(64, 40, 0);
    frame.clean_row_end = 40;
    frame.pattern = 0;
    const auto wrong = calibrator.add(frame);
    ASSERT_FALSE(wrong);
    EXPECT_THAT(wrong.error().message, HasSubstr("64x40"));
    frame.pixels = Image<std::uint8_t>(64, 48, 0);
    frame.pattern = 26;
    EXPECT_THAT(calibrator.add(frame).error().message, HasSubstr("give 0 to 25"));
    frame.pattern = kUnknownPattern;
    EXPECT_TRUE(calibrator.add(frame));
    EXPECT_FALSE(LightCalibrator::create(s, {0, 48}));
}

}  // namespace
}  // namespace xtrack
