// SPDX-License-Identifier: Apache-2.0
// The matrix of a camera's and a projector's colours, judged by the simulator's own.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <numbers>
#include <string>

#include <gmock/gmock.h>

#include "tests/core/light/shown_light.hpp"

namespace xtrack {
namespace {

using testing::HasSubstr;

Mat3d some_crosstalk() {
    Mat3d rgb;
    rgb << 0.86, 0.12, 0.02, 0.08, 0.84, 0.08, 0.01, 0.13, 0.86;
    return rgb;
}

Mat3d strong_crosstalk() {
    Mat3d rgb;
    rgb << 0.70, 0.25, 0.05, 0.20, 0.60, 0.20, 0.05, 0.30, 0.65;
    return rgb;
}

SimSettings colour_wall(const Mat3d& rgb, const char* preset = "ideal-60") {
    SimSettings s = test::light_on_a_wall(preset);
    s.camera.colour = true;
    s.rig.camera_from_projector_rgb = rgb;
    return s;
}

// Rows that sum to one: what the wall's own colour does to the camera's white is not the rig's.
double worst_of_balanced(const Mat3d& found, const Mat3d& truth) {
    const auto balanced = [](const Mat3d& m) -> Mat3d {
        return m.rowwise().sum().cwiseInverse().asDiagonal() * m;
    };
    return (balanced(found) - balanced(truth)).cwiseAbs().maxCoeff();
}

struct Scene {
    const char* name;
    const char* preset;
    bool strong;
    double gamma;
    std::array<double, 3> s_curve;
    double matrix_error;
};
class ColourScenes : public testing::TestWithParam<Scene> {};

TEST_P(ColourScenes, GiveTheMatrix) {
    const Mat3d rgb = GetParam().strong ? strong_crosstalk() : some_crosstalk();
    SimSettings s = colour_wall(rgb, GetParam().preset);
    s.projector.gamma = GetParam().gamma;
    s.projector.s_curve = GetParam().s_curve;
    const auto found = test::calibrate(s);
    ASSERT_TRUE(found) << found.error().message;
    ASSERT_TRUE(found->colour);
    const ColourSelfTest& test = *found->colour;
    const double error = worst_of_balanced(test.camera_from_projector_rgb, rgb);
    std::printf(
        "%s: matrix off by %.4f, condition %.2f, residual %.4f, gain %.4f, contrast %.3f, "
        "phase %.4f rad, %.2f mm, %zu pixels: %s\n",
        GetParam().name, error, test.condition, test.residual, test.gain_change, test.contrast,
        test.phase_error_rad, test.depth_error_mm.value_or(-1.0), test.pixels, test.reason.c_str());
    EXPECT_TRUE(test.passed) << test.reason;
    EXPECT_EQ(works_as_shown(test), GetParam().gamma == 1.0) << test.bend_rad;
    EXPECT_LT(error, GetParam().matrix_error);
    EXPECT_LT(test.gain_change, 0.01);
    ASSERT_TRUE(test.depth_error_mm);
    // 600 mm away a millimetre moves the projector's coordinate by so many px.
    const auto row_px = [&](double z_mm) {
        const Vec3d p =
            s.rig.projector->matrix *
            (s.rig.projector_from_camera_R * Vec3d(0.0, 0.0, z_mm) + s.rig.projector_from_camera_T);
        return p.y() / p.z();
    };
    const double px_per_mm = std::fabs(row_px(600.5) - row_px(599.5));
    EXPECT_NEAR(*test.depth_error_mm / test.phase_error_rad,
                96.0 / (2.0 * std::numbers::pi) / px_per_mm, 0.3);
}

INSTANTIATE_TEST_SUITE_P(
    Simulated, ColourScenes,
    testing::Values(Scene{"linear", "ideal-60", false, 1.0, {}, 0.005},
                    Scene{"strong", "ideal-60", true, 1.0, {}, 0.005},
                    Scene{"gamma", "ideal-60", false, 2.2, {}, 0.01},
                    Scene{"curves", "ideal-60", true, 2.4, {0.3, 0.6, 0.9}, 0.01},
                    Scene{"webcam", "webcam-30", false, 2.2, {}, 0.02}),
    [](const auto& each) { return std::string(each.param.name); });

// The error of three steps at gamma 2.2 has an amplitude of 0.264 rad.
TEST(ColourSelfTest, SaysWhatTheProjectorDoesToColourFringes) {
    SimSettings s = colour_wall(some_crosstalk());
    s.projector.gamma = 2.2;
    const auto bent = test::calibrate(s).value();
    EXPECT_NEAR(bent.colour->bend_rad, 0.264 / std::sqrt(2.0), 0.02);
    EXPECT_THAT(bent.colour->reason, HasSubstr("once pictures are compensated"));
    s.projector.compensation = bent.response->response;
    const auto straight = test::calibrate(s).value();
    EXPECT_LT(straight.colour->bend_rad, 0.01);
    EXPECT_TRUE(works_as_shown(*straight.colour));
}

// A light part of the wall's colour: the camera sees it, and so does the matrix.
TEST(ColourSelfTest, HoldsTheWallsColour) {
    const auto found = test::calibrate(colour_wall(some_crosstalk())).value();
    const Mat3d& rgb = found.colour->camera_from_projector_rgb;
    EXPECT_NEAR(rgb.sum(), 3.0, 1e-9);
    // The simulator's wall reflects 1.03 of red, 1.00 of green, 0.95 of blue.
    EXPECT_NEAR(rgb.row(0).sum() / rgb.row(2).sum(), 1.03 / 0.95, 0.01);
    EXPECT_NEAR(rgb.row(1).sum() / rgb.row(2).sum(), 1.00 / 0.95, 0.01);
}

std::string verdict(const SimSettings& s, const std::function<void(Frame&)>& disturb = {}) {
    const auto found = test::calibrate(s, disturb);
    if (!found) {
        return "error: " + found.error().message;
    }
    return (found->colour->passed ? "passed: " : "failed: ") + found->colour->reason;
}

// Multiplies each channel of the colour fringes (blue, green, red).
std::function<void(Frame&)> gains(double blue, double green, double red) {
    return [=](Frame& frame) {
        if (frame.pattern < 24) {
            return;
        }
        const double gain[3] = {blue, green, red};
        for (int y = 0; y < frame.height(); ++y) {
            for (int x = 0; x < frame.pixels.width(); ++x) {
                std::uint8_t& value = frame.pixels.at(x, y);
                value = static_cast<std::uint8_t>(std::min(254.0, value * gain[x % 3]));
            }
        }
    };
}

TEST(ColourSelfTest, RefusesColoursThatAreAlike) {
    Mat3d alike;
    alike << 0.40, 0.35, 0.25, 0.30, 0.40, 0.30, 0.28, 0.33, 0.39;
    EXPECT_THAT(verdict(colour_wall(alike)),
                HasSubstr("failed: the camera's colours are too alike"));
    Mat3d same = Mat3d::Constant(1.0 / 3.0);
    same.diagonal().array() += 1e-3;
    EXPECT_THAT(verdict(colour_wall(same)), HasSubstr("failed: "));
}

TEST(ColourSelfTest, NoticesAutomaticWhiteBalanceAndExposure) {
    const SimSettings s = colour_wall(some_crosstalk());
    EXPECT_THAT(verdict(s, gains(1.15, 1.0, 0.9)), HasSubstr("failed: the camera's white balance"));
    EXPECT_THAT(verdict(s, gains(0.8, 0.8, 0.8)),
                HasSubstr("failed: the camera's exposure or gain changed by 3"));
    EXPECT_THAT(verdict(s, gains(1.0, 1.0, 1.0)), HasSubstr("passed"));
}

// Many webcams brighten the dark: what they add up is then no longer light.
TEST(ColourSelfTest, NoticesACameraThatIsNotLinear) {
    const auto with_gamma = [](double gamma) {
        return [gamma](Frame& frame) {
            for (int y = 0; y < frame.height(); ++y) {
                for (int x = 0; x < frame.pixels.width(); ++x) {
                    std::uint8_t& value = frame.pixels.at(x, y);
                    value = static_cast<std::uint8_t>(
                        std::lround(254.0 * std::pow(value / 255.0, 1.0 / gamma)));
                }
            }
        };
    };
    const SimSettings s = colour_wall(strong_crosstalk());
    EXPECT_THAT(verdict(s, with_gamma(2.2)), HasSubstr("it has a gamma of its own"));
    // A little of it passes, and costs a little.
    const auto slight = test::calibrate(s, with_gamma(1.3)).value();
    EXPECT_TRUE(slight.colour->passed) << slight.colour->reason;
    EXPECT_LT(worst_of_balanced(slight.colour->camera_from_projector_rgb, strong_crosstalk()),
              0.03);
}

TEST(ColourSelfTest, NoticesTooLittleLight) {
    SimSettings s = colour_wall(some_crosstalk());
    s.rig.camera_from_projector_rgb->row(2) *= 0.1;
    EXPECT_THAT(verdict(s), HasSubstr("grey levels of blue"));
}

// A camera whose colours come from blocks of 24 pixels, as hard compression makes them.
TEST(ColourSelfTest, NoticesColoursThatAreTooCoarse) {
    const auto coarse = [](Frame& frame) {
        constexpr int kBlock = 24;
        for (int y0 = 0; y0 < frame.height(); y0 += kBlock) {
            for (int x0 = 0; x0 < frame.width(); x0 += kBlock) {
                const int y1 = std::min(y0 + kBlock, frame.height());
                const int x1 = std::min(x0 + kBlock, frame.width());
                double mean[3] = {};
                for (int y = y0; y < y1; ++y) {
                    for (int x = x0; x < x1; ++x) {
                        for (int c = 0; c < 3; ++c) {
                            mean[c] += frame.pixels.at(3 * x + c, y);
                        }
                    }
                }
                const double pixels = (y1 - y0) * (x1 - x0);
                const double grey = (mean[0] + mean[1] + mean[2]) / 3.0 / pixels;
                for (int y = y0; y < y1; ++y) {
                    for (int x = x0; x < x1; ++x) {
                        std::uint8_t* pixel = frame.pixels.row(y) + 3 * x;
                        const double here = (pixel[0] + pixel[1] + pixel[2]) / 3.0;
                        for (int c = 0; c < 3; ++c) {
                            pixel[c] = static_cast<std::uint8_t>(
                                std::clamp(here + mean[c] / pixels - grey, 0.0, 254.0));
                        }
                    }
                }
            }
        }
    };
    EXPECT_THAT(verdict(colour_wall(some_crosstalk()), coarse),
                HasSubstr("failed: the shortest colour fringes keep"));
}

}  // namespace
}  // namespace xtrack
