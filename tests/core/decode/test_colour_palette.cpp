// SPDX-License-Identifier: Apache-2.0
#include "core/decode/colour_palette.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/core/decode/colour_scene.hpp"

namespace xtrack {
namespace {

using test::ColourPixel;

constexpr Size kImage{320, 240};
constexpr ColourPeriod kFine{96.0, 0.0};
constexpr ColourPeriod kCoarse{768.0, 0.0};
const ColourPixel kSkin{{1.45, 1.0, 0.69}, {}, 0.75, 70.0};
const ColourPixel kShirt{{0.8, 1.0, 1.25}, {}, 0.5, 50.0};
const ColourPixel kWall{{1.05, 1.0, 0.95}, {}, 0.4, 45.0};

// A hand before a shirt before a wall. They stand at different depths.
struct Scene {
    double hand_left_px = 100.0;

    [[nodiscard]] bool hand(double x, double y) const {
        return x >= hand_left_px && x < hand_left_px + 101.0 && y >= 70.0 && y < 190.0;
    }
    [[nodiscard]] Vec3d light(int x, int y, const ColourPeriod& period) const {
        if (hand(x, y)) {
            return kSkin.light(420.0 + 0.9 * x, period);
        }
        return x > 40 && x < 260 && y > 40 ? kShirt.light(330.0 + 0.9 * x, period)
                                           : kWall.light(200.0 + 0.9 * x, period);
    }
};

class Palette : public testing::Test {
 protected:
    void look(const Scene& scene) {
        palette_.begin();
        for (int y = 0; y < kImage.height; y += ColourPalette::kSampleStepPx) {
            const ColourSamplesOut out = palette_.row(y);
            for (int x = 0; x < kImage.width; x += ColourPalette::kSampleStepPx) {
                put(scene, x, y, static_cast<std::size_t>(x / ColourPalette::kSampleStepPx), out);
            }
            palette_.add_row(y);
        }
        palette_.choose();
    }

    void put(const Scene& scene, int x, int y, std::size_t at, const ColourSamplesOut& out) {
        const ColourModel::Light fine = seen(scene.light(x, y, kFine));
        const ColourModel::Light coarse = seen(scene.light(x, y, kCoarse));
        for (int k = 0; k < 3; ++k) {
            out.fine[static_cast<std::size_t>(k)][at] = fine[k];
            out.coarse[static_cast<std::size_t>(k)][at] = coarse[k];
        }
        out.reference_px[at] = 384.0F;
    }

    [[nodiscard]] ColourModel::Light seen(const Vec3d& light) const {
        std::uint8_t bgr[3];
        test::photograph(light, Mat3d::Identity(), bgr);
        return model_.light(bgr);
    }

    void settle(const Scene& scene) {
        look(scene);
        while (!palette_.settled()) {
            palette_.learn();
            look(scene);
        }
    }

    [[nodiscard]] const ColourSurface& at(int x, int y) const {
        constexpr int kStep = ColourPalette::kFineStepPx;
        return palette_.surface(
            ColourPalette::surface_of(palette_.surfaces().at(x / kStep, y / kStep)));
    }

    void expect(const ColourPixel& truth, int x, int y) const {
        const std::array<float, 3> gains = model_.gains(at(x, y));
        EXPECT_NEAR(static_cast<double>(gains[0] / gains[1]), truth.gains[0] / truth.gains[1], 0.05)
            << x << ' ' << y;
        EXPECT_NEAR(static_cast<double>(gains[2] / gains[1]), truth.gains[2] / truth.gains[1], 0.05)
            << x << ' ' << y;
    }

    ColourModel model_ = ColourModel::create(test::kThirds_rad, Mat3d::Identity()).value();
    ColourPalette palette_{kImage,
                           model_,
                           kFine,
                           kCoarse,
                           Image<float>(ColourPalette::samples(kImage).width,
                                        ColourPalette::samples(kImage).height, 100.0F),
                           Image<float>(ColourPalette::samples(kImage).width,
                                        ColourPalette::samples(kImage).height, 760.0F)};
};

TEST_F(Palette, LearnsSurfacesThatNobodyNamed) {
    settle({});
    expect(kSkin, 150, 130);
    expect(kSkin, 110, 80);
    expect(kShirt, 60, 200);
    expect(kShirt, 240, 60);
    expect(kWall, 20, 20);
    expect(kWall, 300, 220);
}

TEST_F(Palette, AHandMayGoWhereItLikes) {
    settle({});
    for (int n = 1; n <= 6; ++n) {
        look({100.0 + 20.0 * n});
        palette_.learn();
    }
    look({220.0});
    expect(kSkin, 300, 100);
    expect(kSkin, 230, 100);
    expect(kShirt, 120, 130);
}

TEST_F(Palette, DrawsBordersToTwoPixels) {
    const Scene scene;
    settle(scene);
    constexpr int kSide = ColourPalette::kFineSamples;
    constexpr int kStep = ColourPalette::kFineStepPx;
    constexpr int kCell = ColourPalette::kCellPx;
    const int cy = 120 / kCell;
    const int cx = 100 / kCell;
    EXPECT_TRUE(palette_.at_border(cx, cy));
    EXPECT_FALSE(palette_.at_border(150 / kCell, cy));
    std::array<std::array<float, static_cast<std::size_t>(kSide) * kSide>, 7> planes{};
    const ColourSamplesOut out{{planes[0].data(), planes[1].data(), planes[2].data()},
                               {planes[3].data(), planes[4].data(), planes[5].data()},
                               planes[6].data()};
    for (int j = 0; j < kSide; ++j) {
        for (int i = 0; i < kSide; ++i) {
            put(scene, cx * kCell + (i - 1) * kStep, cy * kCell + (j - 1) * kStep,
                static_cast<std::size_t>(j * kSide + i), out);
        }
    }
    const std::array<float, static_cast<std::size_t>(kSide) * kSide> still{};
    palette_.draw_border(cx, cy,
                         {{planes[0].data(), planes[1].data(), planes[2].data()},
                          {planes[3].data(), planes[4].data(), planes[5].data()},
                          planes[6].data()},
                         {still.data(), still.data(), still.data()});
    expect(kShirt, 97, 122);
    expect(kSkin, 103, 122);
}

TEST_F(Palette, ForgetsWhenTold) {
    settle({});
    EXPECT_GT(palette_.count(), 2U);
    palette_.clear();
    EXPECT_FALSE(palette_.settled());
    EXPECT_EQ(palette_.count(), 2U);
    settle({});
    expect(kSkin, 150, 130);
}

TEST_F(Palette, TheSameFramesGiveTheSameBits) {
    settle({});
    const ColourSurface first = at(150, 130);
    palette_.clear();
    settle({});
    EXPECT_EQ(at(150, 130).log_gain, first.log_gain);
    EXPECT_EQ(at(150, 130).contrast, first.contrast);
}

// One period and nothing else: a contrast must not change with the phase.
class LonePalette : public Palette {
 protected:
    LonePalette() {
        const Size samples = ColourPalette::samples(kImage);
        const Image<float> first_px(samples.width, samples.height, 0.0F);
        const Image<float> last_px(samples.width, samples.height, 1024.0F);
        palette_ = ColourPalette(kImage, model_, kFine, {}, first_px, last_px);
    }
    void put_alone(const Scene& scene) {
        palette_.begin();
        for (int y = 0; y < kImage.height; y += ColourPalette::kSampleStepPx) {
            const ColourSamplesOut out = palette_.row(y);
            for (int x = 0; x < kImage.width; x += ColourPalette::kSampleStepPx) {
                const auto at = static_cast<std::size_t>(x / ColourPalette::kSampleStepPx);
                put(scene, x, y, at, out);
                out.reference_px[at] = std::numeric_limits<float>::quiet_NaN();
            }
            palette_.add_row(y);
        }
        palette_.choose();
    }
    void expect_roughly(const ColourPixel& truth, int x, int y) const {
        const std::array<float, 3> gains = model_.gains(at(x, y));
        for (const std::size_t k : {0U, 2U}) {
            EXPECT_NEAR(static_cast<double>(gains[k] / gains[1]), truth.gains[k] / truth.gains[1],
                        0.12)
                << x << ' ' << y;
        }
    }
};

TEST_F(LonePalette, KeepsSurfacesApartByTheirContrast) {
    const Scene scene;
    for (int n = 0; n < 12; ++n) {
        put_alone(scene);
        palette_.learn();
    }
    put_alone(scene);
    expect_roughly(kSkin, 150, 130);
    expect_roughly(kShirt, 60, 200);
    expect_roughly(kWall, 300, 220);
}

TEST_F(LonePalette, SkinThatIsNotInViewStaysSkin) {
    for (int n = 0; n < 60; ++n) {
        put_alone({2000.0});
        palette_.learn();
    }
    for (int n = 0; n < 4; ++n) {
        put_alone({});
        palette_.learn();
    }
    expect_roughly(kSkin, 150, 130);
}

}  // namespace
}  // namespace xtrack
