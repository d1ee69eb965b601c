// SPDX-License-Identifier: Apache-2.0
#include <xtrack/paper_decoder.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <xtrack/method.hpp>
#include <xtrack/sim.hpp>

#include "tests/core/pipeline/paper_scene.hpp"
#include "tests/core/pipeline/step_scene.hpp"

namespace xtrack {
namespace {

using test::depth_at;
using test::fringes;
using test::make;
using test::plain;
using test::show;
using test::wide_fringes;
using test::with_depth;
using testing::HasSubstr;

// Where the plate of the scenes below is, and a place on the wall beside it.
constexpr int kPlateU = 165, kPlateV = 120, kWallU = 60, kWallV = 120;

/// Of a wall 900 mm and a plate `plate_mm` away, projector px.
double disparity_px(double plate_mm) { return 1000.0 * 150.0 * (1.0 / plate_mm - 1.0 / 900.0); }

TEST(PaperDecoder, WithoutARigHeightsAreRelative) {
    auto decoder = make();
    test::StepScene empty;
    empty.plate_mm = 0.0;
    ASSERT_EQ(show(decoder, empty, 0), DecodeState::depth_ready);
    ASSERT_TRUE(decoder.learn_background());
    EXPECT_FALSE(decoder.depth().metric);
    EXPECT_NEAR(depth_at(decoder, kWallU, kWallV), PaperDecoder::kBackground_mm, 2.0);

    // The plate is four whole fringes and more before the wall, and joins it nowhere: the shadow
    // beside it says so.
    for (const double plate_mm : {600.0, 700.0, 800.0}) {
        test::StepScene scene;
        scene.plate_mm = plate_mm;
        decoder.reset();
        ASSERT_EQ(show(decoder, scene, 1), DecodeState::depth_ready);
        EXPECT_NEAR(depth_at(decoder, kWallU, kWallV), PaperDecoder::kBackground_mm, 2.0);
        EXPECT_NEAR(PaperDecoder::kBackground_mm - depth_at(decoder, kPlateU, kPlateV),
                    PaperDecoder::kMmPerProjectorPx * disparity_px(plate_mm), 3.0)
            << plate_mm;
    }
}

TEST(PaperDecoder, APlaneStandsInForABackgroundThatWasNotLearnt) {
    auto decoder = make();
    const test::StepScene scene;  // with the plate from the start
    ASSERT_EQ(show(decoder, scene, 0), DecodeState::depth_ready);
    EXPECT_NEAR(depth_at(decoder, kWallU, kWallV), PaperDecoder::kBackground_mm, 2.0);
    EXPECT_NEAR(PaperDecoder::kBackground_mm - depth_at(decoder, kPlateU, kPlateV),
                PaperDecoder::kMmPerProjectorPx * disparity_px(600.0), 3.0);
}

TEST(PaperDecoder, APlateKeepsItsOrderWhileItComesNearer) {
    auto decoder = make();
    test::StepScene scene;
    scene.plate_mm = 0.0;
    ASSERT_EQ(show(decoder, scene, 0), DecodeState::depth_ready);
    ASSERT_TRUE(decoder.learn_background());
    decoder.reset();
    // Nothing but the rim is lit beside the plate, so that no shadow tells where it is.
    int number = 3;
    for (scene.plate_mm = 860.0; scene.plate_mm >= 600.0; scene.plate_mm -= 2.0, ++number) {
        auto plate = scene.frame(fringes(), number % 3, number);
        for (int v = 0; v < 240; ++v) {
            for (int u = 24; u < 320; ++u) {
                plate->pixels.at(u, v) = scene.depth_mm(u, v) > scene.plate_mm
                                             ? std::uint8_t{0}
                                             : plate->pixels.at(u, v);
            }
        }
        const DecodeState state = decoder.push(plate).state;
        if (state == DecodeState::depth_ready) {
            // Three images of three places: the depth is that of the middle one, and rippled.
            EXPECT_NEAR(PaperDecoder::kBackground_mm - depth_at(decoder, kPlateU, kPlateV),
                        PaperDecoder::kMmPerProjectorPx * disparity_px(scene.plate_mm + 2.0), 4.0)
                << scene.plate_mm;
        }
    }
    EXPECT_GT(number, 120);
}

TEST(PaperDecoder, WithARigDepthIsMetric) {
    const Rig rig = test::StepScene::rig();
    auto decoder = make(plain(), &rig);
    const test::StepScene scene;
    ASSERT_EQ(show(decoder, scene, 0), DecodeState::depth_ready);
    EXPECT_TRUE(decoder.depth().metric);
    EXPECT_NEAR(depth_at(decoder, kWallU, kWallV), 900.0, 3.0);
    EXPECT_NEAR(depth_at(decoder, kPlateU, kPlateV), 600.0, 3.0);
    // The volume has room for the wall a fringe nearer, so that all of it is a guess.
    ASSERT_GE(decoder.components().size(), 2U);
    const auto plate = decoder.component().at(kPlateU, kPlateV);
    ASSERT_NE(plate, decoder.component().at(kWallU, kWallV));
    EXPECT_TRUE(decoder.components()[0].ambiguous);
    EXPECT_TRUE(decoder.components()[plate - 1U].ambiguous);
}

TEST(PaperDecoder, AVolumeOfOneFringeLeavesNothingOpen) {
    Rig rig = test::StepScene::rig();
    rig.working_volume = WorkingVolume{580.0, 640.0};  // 24 of 32 px
    auto decoder = make(plain(), &rig);
    test::StepScene scene;
    scene.plate_left_mm = scene.plate_top_mm = -200.0;
    scene.plate_right_mm = scene.plate_bottom_mm = 200.0;
    ASSERT_EQ(show(decoder, scene, 0), DecodeState::depth_ready);
    EXPECT_NEAR(depth_at(decoder, kPlateU, kPlateV), 600.0, 3.0);
    EXPECT_FALSE(decoder.components()[0].ambiguous);
    EXPECT_EQ(depth_at(decoder, 10, 10), 0.0) << "the wall is outside the volume";
}

TEST(PaperDecoder, WhatNothingOrdersIsMarked) {
    const Rig rig = test::StepScene::rig();
    auto decoder = make(plain(), &rig);
    test::StepScene scene;
    scene.wall_mm = 5000.0;  // its light is lost in the noise
    scene.plate_left_mm = scene.plate_top_mm = -40.0;
    scene.plate_right_mm = scene.plate_bottom_mm = 40.0;
    auto lit = [&](int pattern, int number) {
        auto frame = scene.frame(fringes(), pattern, number);
        for (int v = 0; v < 240; ++v) {
            for (int u = 0; u < 320; ++u) {
                frame->pixels.at(u, v) =
                    scene.depth_mm(u, v) > 1000.0 ? std::uint8_t{10} : frame->pixels.at(u, v);
            }
        }
        return frame;
    };
    for (int n = 0; n < 3; ++n) {
        decoder.push(lit(n, n));
    }
    ASSERT_EQ(decoder.components().size(), 1U);
    EXPECT_TRUE(decoder.components()[0].ambiguous);
    const double z_mm = depth_at(decoder, kPlateU, kPlateV);
    EXPECT_GE(z_mm, 400.0);
    EXPECT_LE(z_mm, 1000.0);
}

TEST(PaperDecoder, PointsAreTheDepthAlongTheRays) {
    const Rig rig = test::StepScene::rig();
    auto decoder = make(plain(), &rig);
    const test::StepScene scene;
    ASSERT_EQ(show(decoder, scene, 0), DecodeState::depth_ready);
    const auto points = decoder.points_mm();
    ASSERT_EQ(points.size(), (Size{3 * 320, 240}));
    int checked = 0;
    for (int v = 0; v < 240; v += 7) {
        for (int u = 0; u < 320; u += 3) {
            const float* point = points.row(v) + 3 * u;
            const double z = depth_at(decoder, u, v);
            if (z == 0.0) {
                EXPECT_TRUE(std::isnan(point[2]));
                continue;
            }
            EXPECT_NEAR(point[2], z, 1e-3);
            EXPECT_NEAR(point[0], (u - 159.5) / 300.0 * z, 1e-3);
            EXPECT_NEAR(point[1], (v - 119.5) / 300.0 * z, 1e-3);
            ++checked;
        }
    }
    EXPECT_GT(checked, 2000);
    DecodeSettings settings = plain();
    settings.keep_maps = false;
    ASSERT_TRUE(decoder.set_settings(settings));
    EXPECT_TRUE(decoder.points_mm().empty());
}

// A wall that is darker than the plate before it.
DecodeState show_on_a_dark_wall(PaperDecoder& decoder, const test::StepScene& scene, int number) {
    test::StepScene dark = scene;
    dark.contrast_grey = 90.0;
    DecodeState state = DecodeState::need_more;
    for (int n = 0; n < 3; ++n) {
        const auto frame = dark.frame(fringes(), n, 3 * number + n);
        const auto bright = scene.frame(fringes(), n, 3 * number + n);
        for (int v = 0; v < 240; ++v) {
            for (int u = 0; u < 320; ++u) {
                if (scene.depth_mm(u, v) == scene.plate_mm) {
                    frame->pixels.at(u, v) = bright->pixels.at(u, v);
                }
            }
        }
        state = decoder.push(frame).state;
    }
    return state;
}

TEST(PaperDecoder, AThingWhosePhaseGoesOnIsKeptApartFromWhatStandsStill) {
    const Rig rig = test::StepScene::rig();
    test::StepScene scene;
    for (const bool follow : {false, true}) {
        DecodeSettings settings = plain();
        settings.motion = follow ? MotionHandling::follow : MotionHandling::off;
        auto decoder = make(settings, &rig);
        scene.plate_mm = 0.0;
        for (int n = 0; n < 10; ++n) {
            show_on_a_dark_wall(decoder, scene, n);
        }
        const double wall_mm = depth_at(decoder, kWallU, kWallV);
        EXPECT_NEAR(wall_mm, 900.0, 3.0);
        // Two whole fringes before the wall: no step of the phase tells them apart.
        scene.plate_mm = 1.0 / (1.0 / 900.0 + 64.0 / 150000.0);
        ASSERT_EQ(show_on_a_dark_wall(decoder, scene, 10), DecodeState::depth_ready);
        const bool apart =
            decoder.component().at(kPlateU, kPlateV) != decoder.component().at(kWallU, kWallV);
        EXPECT_EQ(apart, follow);
        EXPECT_NEAR(depth_at(decoder, kWallU, kWallV), 900.0, 3.0);
        if (follow) {
            EXPECT_NEAR(depth_at(decoder, kPlateU, kPlateV), scene.plate_mm, 3.0);
            EXPECT_EQ(decoder.component().at(kWallU, kWallV), PaperDecoder::kStill);
        }
    }
}

// A body that stands 50 px before the wall, to the image's right border, where no shadow of it is
// seen: one fringe is 64, so that it might as well be 14 px behind. A hand comes, whose shadow is.
// @param mirrored less phase is nearer
DecodeState show_body_and_hand(PaperDecoder& decoder, int number, bool with_hand, bool mirrored) {
    test::StepScene body;
    body.plate_mm = 1.0 / (1.0 / 900.0 + 50.0 / 150000.0);
    body.plate_left_mm = 0.0;
    body.plate_right_mm = 2000.0;
    body.plate_top_mm = -150.0;
    body.plate_bottom_mm = 2000.0;
    test::StepScene hand;
    hand.plate_mm = 610.0;
    hand.plate_left_mm = -220.0;
    hand.plate_right_mm = -120.0;
    DecodeState state = DecodeState::need_more;
    for (int n = 0; n < 3; ++n) {
        const auto frame = body.frame(wide_fringes(), n, 3 * number + n);
        const auto before = hand.frame(wide_fringes(), n, 3 * number + n);
        for (int v = 0; with_hand && v < 240; ++v) {
            for (int u = 0; u < 320; ++u) {
                if (hand.depth_mm(u, v) == hand.plate_mm || hand.shaded(u, v)) {
                    frame->pixels.at(u, v) = before->pixels.at(u, v);
                }
            }
        }
        frame->pattern = mirrored ? (3 - n) % 3 : n;
        state = decoder.push(frame).state;
    }
    return state;
}

TEST(PaperDecoder, AShadowSaysWhichWayIsNearer) {
    for (const bool mirrored : {false, true}) {
        DecodeSettings settings = plain();
        settings.motion = MotionHandling::mask;
        auto decoder = make(settings, nullptr, wide_fringes());
        for (int n = 0; n < 10; ++n) {
            ASSERT_EQ(show_body_and_hand(decoder, n, false, mirrored), DecodeState::depth_ready);
        }
        for (int n = 10; n < 16; ++n) {
            show_body_and_hand(decoder, n, true, mirrored);
        }
        // Hand, body and wall, in px of the projector before the wall.
        const auto height_px = [&](int u, int v) {
            return (PaperDecoder::kBackground_mm - depth_at(decoder, u, v)) /
                   PaperDecoder::kMmPerProjectorPx;
        };
        EXPECT_NEAR(height_px(75, 120), disparity_px(610.0), 3.0) << mirrored;
        EXPECT_NEAR(height_px(240, 150), 50.0, 3.0) << mirrored;
        EXPECT_NEAR(height_px(20, 20), 0.0, 3.0) << mirrored;
        // And it stays so without the hand, however often an image is decoded.
        show_body_and_hand(decoder, 16, false, mirrored);
        for (int n = 0; n < 30; ++n) {
            ASSERT_EQ(decoder.decode_again().state, DecodeState::depth_ready);
        }
        EXPECT_NEAR(height_px(240, 150), 50.0, 3.0) << mirrored;
    }
}

TEST(PaperDecoder, AnImageThatIsRejectedSpoilsNoDecodeOfTheOneBefore) {
    auto settings = *SimSettings::preset("webcam-30");
    settings.camera.colour = true;
    settings.patterns = *method_sequence(Method::rgb_static, settings.rig, Axis::y);
    const auto rig = *SimulatedRig::create(settings);
    auto decoder = PaperDecoder::create(settings.patterns, rig->rig().camera.size);
    ASSERT_TRUE(decoder) << decoder.error().message;
    const auto item = rig->next(std::chrono::seconds(1));
    ASSERT_EQ(decoder->push(item.frame).state, DecodeState::depth_ready);
    const int before = with_depth(*decoder);
    EXPECT_GT(before, 100000);
    auto grey = std::make_shared<Frame>(*item.frame);
    grey->format = PixelFormat::grey8;
    grey->pixels.resize(rig->rig().camera.size.width, rig->rig().camera.size.height);
    grey->stamp = item.frame->stamp + std::chrono::milliseconds(33);
    EXPECT_EQ(decoder->push(grey).state, DecodeState::rejected);
    ASSERT_EQ(decoder->decode_again().state, DecodeState::depth_ready);
    EXPECT_EQ(with_depth(*decoder), before);
    ASSERT_TRUE(decoder->learn_background());
}

TEST(PaperDecoder, TakesAnyPeriodAndPassesOverOtherPatterns) {
    PatternSequence dual = dual_sequence(Axis::x, {1280, 768}, 512.0, 64.0);
    auto decoder = make(plain(), nullptr, dual);
    EXPECT_EQ(decoder.frames_needed(), 3);
    const test::StepScene scene;
    EXPECT_EQ(show(decoder, scene, 0, dual), DecodeState::depth_ready);
    EXPECT_EQ(decoder.phase().period_px, 64.0);
    EXPECT_EQ(decoder.push(scene.frame(dual, 0, 6)).state, DecodeState::need_more);

    const PatternSequence four = n_step_sequence(Axis::x, {1280, 768}, 32.0, 4);
    auto of_four = make(plain(), nullptr, four);
    EXPECT_EQ(show(of_four, scene, 0, four), DecodeState::depth_ready);
    EXPECT_NEAR(PaperDecoder::kBackground_mm - depth_at(of_four, kPlateU, kPlateV),
                PaperDecoder::kMmPerProjectorPx * disparity_px(600.0), 3.0);
}

TEST(PaperDecoder, RowsThatSawTwoPatternsAreOfTheImageBefore) {
    auto decoder = make();
    const test::StepScene scene;
    for (int n = 0; n < 3; ++n) {
        auto frame = scene.frame(fringes(), n, n);
        frame->clean_row_begin = n == 1 ? 40 : 0;
        decoder.push(frame);
    }
    EXPECT_EQ(depth_at(decoder, kWallU, 20), 0.0);
    EXPECT_NEAR(depth_at(decoder, kWallU, kWallV), PaperDecoder::kBackground_mm, 2.0);
}

TEST(PaperDecoder, SaysWhatItCannotDo) {
    const auto error_of = [](const PatternSequence& patterns, const Rig* rig = nullptr) {
        const auto made = PaperDecoder::create(patterns, test::StepScene::kCamera, {}, rig);
        return made ? std::string() : made.error().message;
    };
    PatternSequence gray = gray_code_sequence(Axis::x, {1280, 768}, 32.0);
    std::erase_if(gray.patterns, [](const Pattern& p) { return p.kind == PatternKind::sine; });
    EXPECT_THAT(error_of(gray), HasSubstr("no sines"));
    PatternSequence ramp = gray_code_sequence(Axis::x, {1280, 768}, 32.0);
    ramp.patterns.resize(3);
    ramp.patterns[2] = {};
    ramp.patterns[2].kind = PatternKind::ramp;
    ramp.patterns[2].period_px = 1280.0;
    EXPECT_THAT(error_of(ramp), HasSubstr("ramps jump"));
    Rig rig = test::StepScene::rig();
    rig.projector->size = {800, 600};
    EXPECT_THAT(error_of(fringes(), &rig), HasSubstr("projector_size"));
    rig = test::StepScene::rig();
    rig.camera.size = {640, 480};
    EXPECT_THAT(error_of(fringes(), &rig), HasSubstr("camera_size"));
}

}  // namespace
}  // namespace xtrack
