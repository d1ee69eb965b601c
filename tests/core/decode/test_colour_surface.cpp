// SPDX-License-Identifier: Apache-2.0
#include "core/decode/colour_surface.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/decode/colour_search.hpp"
#include "tests/core/decode/colour_scene.hpp"

namespace xtrack {
namespace {

using test::ColourPixel;
using test::kThirds_rad;

constexpr double kPi = std::numbers::pi;
constexpr ColourPeriod kFine{96.0, 0.4};
constexpr ColourPeriod kCoarse{768.0, -1.1};

Mat3d crosstalk() {
    Mat3d m;
    m << 0.86, 0.12, 0.02, 0.08, 0.84, 0.08, 0.01, 0.13, 0.86;
    return m;
}

// Pixels of all phases and shades, photographed in 8 bits, and the surface that follows from them.
ColourSurface fitted(const ColourModel& model, ColourPixel pixel, const Mat3d& camera,
                     const std::array<double, 3>& steps_rad = kThirds_rad, bool pairs = false) {
    ColourSurface believed;
    for (int step = 0; step < 20; ++step) {
        ColourFit fit;
        for (int n = 0; n < 400; ++n) {
            pixel.shade = 50.0 + (n * 37) % 40;
            const double x = 100.0 + 0.5 * n;
            std::uint8_t bgr[3];
            test::photograph(pixel.light(x, kFine, steps_rad), camera, bgr);
            const ColourModel::Inverse inverse = model.inverse(believed);
            const ColourModel::Light fine = inverse * model.light(bgr);
            fit.add(believed, fine, 1.0F);
            if (pairs) {
                ColourPixel opaque = pixel;
                opaque.fade = {1.0, 1.0, 1.0};
                test::photograph(opaque.light(x, kCoarse, steps_rad), camera, bgr);
                const ColourModel::Light coarse = model.coarse_inverse(believed) * model.light(bgr);
                const double fine_rad = std::atan2(fine[2], fine[1]);
                const double coarse_rad = std::atan2(coarse[2], coarse[1]);
                const double ratio = kFine.period_px / kCoarse.period_px;
                // The fine phase's error is within its period.
                const double error = std::remainder(
                    fine_rad - kFine.phase_rad - 2.0 * kPi * x / kFine.period_px, 2.0 * kPi);
                const double ahead = std::remainder(coarse_rad - kCoarse.phase_rad -
                                                        2.0 * kPi * x / kCoarse.period_px,
                                                    2.0 * kPi) -
                                     ratio * error;
                fit.add_pair(believed, fine, coarse, static_cast<float>(ratio),
                             static_cast<float>(ahead), 0.3F);
            }
        }
        believed = fit.solve(believed, 20.0F + 0.5F * fit.pixels());  // as the palette does
    }
    return believed;
}

void expect_gains(const ColourModel& model, const ColourSurface& found, const ColourPixel& truth,
                  double tolerance) {
    const std::array<float, 3> gains = model.gains(found);
    const double mean = std::cbrt(truth.gains[0] * truth.gains[1] * truth.gains[2]);
    for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_NEAR(static_cast<double>(gains[k]), truth.gains[k] / mean, tolerance) << k;
    }
    EXPECT_NEAR(static_cast<double>(found.contrast), truth.contrast, tolerance);
}

TEST(ColourFit, FindsGainsFromTheContrastAlone) {
    const ColourModel model = ColourModel::create(kThirds_rad, Mat3d::Identity()).value();
    const ColourPixel skin{{1.4, 0.95, 0.75}, {}, 0.8};
    expect_gains(model, fitted(model, skin, Mat3d::Identity()), skin, 0.01);
    const ColourPixel grey{{1.0, 1.0, 1.0}, {}, 0.6};
    expect_gains(model, fitted(model, grey, Mat3d::Identity()), grey, 0.01);
}

TEST(ColourFit, TwoPeriodsSayTheSame) {
    const ColourModel model = ColourModel::create(kThirds_rad, Mat3d::Identity()).value();
    const ColourPixel skin{{1.4, 0.95, 0.75}, {}, 0.8};
    expect_gains(model, fitted(model, skin, Mat3d::Identity(), kThirds_rad, true), skin, 0.01);
}

// Skin: light of a short period is washed out, that of red most.
TEST(ColourFit, TellsWhatFadesFromWhatTints) {
    const ColourModel model = ColourModel::create(kThirds_rad, Mat3d::Identity()).value();
    ColourPixel skin{{1.4, 0.95, 0.75}, {}, 0.8};
    skin.fade = {0.7, 0.85, 0.95};
    const ColourSurface found = fitted(model, skin, Mat3d::Identity(), kThirds_rad, true);
    const std::array<float, 3> gains = model.gains(found);
    EXPECT_NEAR(gains[0] / gains[1], 1.4 / 0.95, 0.05);
    EXPECT_NEAR(gains[2] / gains[1], 0.75 / 0.95, 0.05);
    EXPECT_NEAR(found.transfer, std::cbrt(0.7 * 0.85 * 0.95), 0.03);
    const ColourModel::Inverse inverse = model.inverse(found);
    double worst = 0.0;
    for (int n = 0; n < 96; ++n) {
        const ColourModel::Light seen =
            inverse * ColourModel::Light(skin.light(n, kFine).cast<float>());
        const double error = std::remainder(
            std::atan2(seen[2], seen[1]) - kFine.phase_rad - 2.0 * kPi * n / kFine.period_px,
            2.0 * kPi);
        worst = std::max(worst, std::fabs(error));
    }
    EXPECT_LT(worst, 0.03);
    // What is out of sight stays as it was.
    const ColourSurface unseen = ColourFit().solve(found, 20.0F);
    EXPECT_EQ(unseen.log_transfer, found.log_transfer);
    EXPECT_EQ(unseen.transfer, found.transfer);
    // One period alone calls it gains and a tint.
    EXPECT_EQ(fitted(model, skin, Mat3d::Identity()).transfer, 1.0F);
}

TEST(ColourFit, UndoesCrosstalkAndGoesTheOtherWayRound) {
    const std::array<double, 3> other{1.0, 1.0 + 2.0 * kPi / 3.0, 1.0 + 4.0 * kPi / 3.0};
    const ColourModel model = ColourModel::create(other, crosstalk()).value();
    const ColourPixel skin{{1.4, 0.95, 0.75}, {}, 0.8};
    expect_gains(model, fitted(model, skin, crosstalk(), other), skin, 0.02);
}

TEST(ColourFit, TintedRoomsCostLittle) {
    const ColourModel model = ColourModel::create(kThirds_rad, Mat3d::Identity()).value();
    const ColourPixel skin{{1.4, 0.95, 0.75}, {0.08, 0.02, -0.02}, 0.8};
    const ColourSurface found = fitted(model, skin, Mat3d::Identity());
    double squares = 0.0;
    for (int n = 0; n < 96; ++n) {
        const Vec3d light = skin.light(n, kFine);
        const ColourModel::Light seen =
            model.inverse(found) * ColourModel::Light(light.cast<float>());
        const double error = std::remainder(
            std::atan2(seen[2], seen[1]) - kFine.phase_rad - 2.0 * kPi * n / kFine.period_px,
            2.0 * kPi);
        squares += error * error;
    }
    EXPECT_LT(std::sqrt(squares / 96.0), 0.06);  // 1 px of 96; 0.2 rad without the fit
}

TEST(ColourFit, FewPixelsChangeLittle) {
    ColourFit fit;
    const ColourSurface believed{0.7F, {0.1F, 0.05F}, {}};
    fit.add(believed, ColourModel::Light(50.0F, 45.0F, 10.0F), 1.0F);
    EXPECT_NEAR(fit.solve(believed, 20.0F).contrast, 0.7F, 0.02F);
    EXPECT_EQ(ColourFit().solve(believed, 20.0F).log_gain, believed.log_gain);
}

TEST(ColourModel, RefusesWhatIsNoThirdOfATurn) {
    const auto unequal = ColourModel::create({0.0, 1.0, 2.0}, Mat3d::Identity());
    ASSERT_FALSE(unequal);
    EXPECT_THAT(unequal.error().message, testing::HasSubstr("thirds of a turn"));
    const auto singular = ColourModel::create(kThirds_rad, Mat3d::Zero());
    ASSERT_FALSE(singular);
    EXPECT_THAT(singular.error().message, testing::HasSubstr("camera_from_projector_rgb"));
}

TEST(ColourModel, GainsSurviveTheirSurface) {
    const ColourModel model = ColourModel::create(kThirds_rad, Mat3d::Identity()).value();
    const std::array<float, 3> gains = model.gains(model.surface({2.8F, 1.9F, 1.5F}, 0.7F));
    EXPECT_NEAR(gains[0] / gains[1], 2.8F / 1.9F, 1e-4F);
    EXPECT_NEAR(gains[2] / gains[1], 1.5F / 1.9F, 1e-4F);
    EXPECT_NEAR(gains[0] * gains[1] * gains[2], 1.0F, 1e-4F);
}

// One pixel's two images, of any gains, leave few places for it: the right one is nearly always the
// best or the second.
TEST(ColourSearch, FindsAPixelWhoseColourNobodyKnows) {
    const ColourModel model = ColourModel::create(kThirds_rad, Mat3d::Identity()).value();
    const ColourSearch search(model, kCoarse, kFine);
    int right = 0;
    int tried = 0;
    for (const std::array<double, 3>& gains :
         {std::array<double, 3>{1.4, 0.95, 0.75}, std::array<double, 3>{0.8, 1.0, 1.3},
          std::array<double, 3>{1.0, 1.0, 1.0}}) {
        for (double x = 130.0; x < 600.0; x += 7.0) {
            const ColourPixel pixel{gains, {}, 0.75};
            std::uint8_t coarse[3];
            std::uint8_t fine[3];
            test::photograph(pixel.light(x, kCoarse), Mat3d::Identity(), coarse);
            test::photograph(pixel.light(x, kFine), Mat3d::Identity(), fine);
            ColourSearch::Hypotheses found;
            const std::size_t count =
                search.find(model.light(coarse), model.light(fine), 100.0F, 640.0F, found);
            ASSERT_GT(count, 0U);
            ++tried;
            for (std::size_t n = 0; n < std::min<std::size_t>(count, 2); ++n) {
                const std::array<float, 3> g = model.gains(found[n].surface);
                const bool same =
                    std::fabs(static_cast<double>(found[n].coordinate_px) - x) < 8.0 &&
                    std::fabs(std::log(static_cast<double>(g[0] / g[1]) / (gains[0] / gains[1]))) <
                        0.2;
                if (same) {
                    ++right;
                    break;
                }
            }
        }
    }
    EXPECT_GT(right, tried * 9 / 10);
    ColourSearch::Hypotheses none;
    EXPECT_EQ(search.find(ColourModel::Light(1.0F, 1.0F, 1.0F),
                          ColourModel::Light(2.0F, 2.0F, 2.0F), 0.0F, 768.0F, none),
              0U);
}

}  // namespace
}  // namespace xtrack
