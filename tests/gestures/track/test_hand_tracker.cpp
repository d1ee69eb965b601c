// SPDX-License-Identifier: Apache-2.0
#include <limits>

#include <gtest/gtest.h>

#include <xtrack/hand_tracker.hpp>

#include "tests/gestures/track/synthetic_hand.hpp"

namespace xtrack {
namespace {

using test::Scene;
using test::SyntheticHand;

HandTracker make_tracker(const Scene& scene, const TrackerSettings& settings = {}) {
    Result<HandTracker> tracker =
        HandTracker::create(scene.rig, scene.depth.depth.size(), settings);
    EXPECT_TRUE(tracker.ok());
    return std::move(tracker.value());
}

/// Draws one hand at a time and tracks it.
struct Stage {
    Scene scene;
    HandTracker tracker = make_tracker(scene);

    const HandFrame& show(std::int64_t t_us, std::initializer_list<SyntheticHand> hands) {
        scene.clear();
        for (const SyntheticHand& hand : hands) {
            hand.draw(scene);
        }
        scene.depth.stamp = Stamp::from_us(t_us);
        return tracker.track(scene.depth);
    }
};

SyntheticHand at(float x, float y, float z) {
    SyntheticHand hand;
    hand.palm_mm = {x, y, z};
    return hand;
}

TEST(HandTracker, OpenHandIsMeasured) {
    Stage stage;
    const SyntheticHand truth = at(20.0F, 10.0F, 600.0F);
    const HandFrame& frame = stage.show(0, {truth});
    ASSERT_EQ(frame.count, 1U);
    const Hand& hand = frame.hands[0];
    EXPECT_EQ(frame.coordinates, CoordinateFrame::camera);
    EXPECT_LT((hand.palm_mm - truth.palm_mm).norm(), 10.0F);
    EXPECT_NEAR(hand.palm_radius_mm, SyntheticHand::kPalmRadiusMm, 6.0F);
    EXPECT_LT(hand.palm_normal.z(), -0.9F) << "toward the camera";
    EXPECT_GE(hand.confidence, 0.6F);
    EXPECT_FALSE(hand.touches_border);
    EXPECT_EQ(hand.extended_fingers, 5);
    for (std::size_t f = 0; f < kFingerCount; ++f) {
        ASSERT_TRUE(hand.fingertips[f].valid) << f;
        EXPECT_LT((hand.fingertips[f].position_mm - truth.tip(static_cast<Finger>(f))).norm(),
                  10.0F)
            << f;
        EXPECT_GT(hand.finger_extension[f], 0.5F) << f;
    }
    EXPECT_LT(hand.grab_value, 0.2F);
    const float aperture = (truth.tip(Finger::thumb) - truth.tip(Finger::index)).norm();
    // From pad to pad: each pad is 11 mm below its tip, on the side of the other.
    EXPECT_LT(hand.pinch_aperture_mm, aperture);
    EXPECT_GT(hand.pinch_aperture_mm, aperture - 2.0F * 11.0F - 3.0F);
    EXPECT_EQ(hand.pinch_value, 0.0F);
}

TEST(HandTracker, NoiseAndHolesAreBorne) {
    Scene scene;
    HandTracker tracker = make_tracker(scene);
    const SyntheticHand truth = at(-30.0F, 0.0F, 700.0F);
    for (int k = 0; k < 5; ++k) {
        scene.clear();
        scene.wall(1600.0F);
        scene.person(0.0F, 1000.0F);
        truth.draw(scene);
        scene.noise(2.0, 0.2, static_cast<unsigned>(k));
        scene.depth.stamp = Stamp::from_us(k * 33333);
        const HandFrame& frame = tracker.track(scene.depth);
        ASSERT_EQ(frame.count, 1U) << k;
        EXPECT_EQ(frame.hands[0].id, 1);
        EXPECT_LT((frame.hands[0].palm_mm - truth.palm_mm).norm(), 12.0F);
        EXPECT_EQ(frame.hands[0].extended_fingers, 5);
    }
}

TEST(HandTracker, SmallImagesAndOtherUnits) {
    Scene scene({320, 240}, 300.0);
    scene.depth.depth_unit_mm = 1.0;
    HandTracker tracker = make_tracker(scene);
    const SyntheticHand truth = at(0.0F, 0.0F, 550.0F);
    truth.draw(scene);
    const HandFrame& frame = tracker.track(scene.depth);
    ASSERT_EQ(frame.count, 1U);
    EXPECT_LT((frame.hands[0].palm_mm - truth.palm_mm).norm(), 10.0F);
    EXPECT_EQ(frame.hands[0].extended_fingers, 5);
}

TEST(HandTracker, FistIsGrab) {
    Stage stage;
    SyntheticHand fist = at(0.0F, 0.0F, 600.0F);
    fist.extended.fill(false);
    const HandFrame& frame = stage.show(0, {fist});
    ASSERT_EQ(frame.count, 1U);
    EXPECT_EQ(frame.hands[0].extended_fingers, 0);
    EXPECT_GT(frame.hands[0].grab_value, 0.8F);
}

TEST(HandTracker, FingersAreCounted) {
    Stage stage;
    SyntheticHand two = at(0.0F, 0.0F, 600.0F);
    two.extended = {false, true, true, false, false};
    const Hand victory = stage.show(0, {two}).hands[0];
    EXPECT_EQ(victory.extended_fingers, 2);
    EXPECT_TRUE(victory.fingertip(Finger::index).valid || victory.fingertip(Finger::middle).valid);
    EXPECT_FALSE(victory.fingertip(Finger::little).valid);
}

TEST(HandTracker, PinchClosesInThreeDimensions) {
    Stage stage;
    SyntheticHand hand = at(0.0F, 0.0F, 500.0F);
    hand.pinching = true;
    const HandFrame& frame = stage.show(0, {hand});
    ASSERT_EQ(frame.count, 1U);
    EXPECT_GE(frame.hands[0].pinch_aperture_mm, 0.0F);
    EXPECT_LT(frame.hands[0].pinch_aperture_mm, 20.0F);
    EXPECT_GT(frame.hands[0].pinch_value, 0.85F);
}

TEST(HandTracker, ChiralityFollowsTheThumb) {
    for (const bool right : {true, false}) {
        Stage stage;
        SyntheticHand truth = at(0.0F, 0.0F, 600.0F);
        truth.thumb_to_the_right = right;
        float first = 0.0F;
        for (int k = 0; k < 30; ++k) {
            const Hand& hand = stage.show(k * 16667, {truth}).hands[0];
            if (k == 0) {
                first = hand.chirality_confidence;
                EXPECT_LT(first, 0.8F) << "one frame is not enough to be sure";
            }
            if (k == 29) {
                EXPECT_EQ(hand.chirality, right ? Chirality::right : Chirality::left);
                EXPECT_GT(hand.chirality_confidence, first);
                EXPECT_LE(hand.chirality_confidence, 0.95F);
            }
        }
    }
}

TEST(HandTracker, IdSurvivesAShortAbsence) {
    Stage stage;
    const SyntheticHand hand = at(0.0F, 0.0F, 600.0F);
    EXPECT_EQ(stage.show(0, {hand}).hands[0].id, 1);
    for (int k = 1; k < 5; ++k) {
        EXPECT_EQ(stage.show(k * 50'000, {}).count, 0U);
    }
    const HandFrame& back = stage.show(250'000, {at(20.0F, 0.0F, 600.0F)});
    ASSERT_EQ(back.count, 1U);
    EXPECT_EQ(back.hands[0].id, 1);
}

TEST(HandTracker, IdIsNewAfterALongAbsence) {
    Stage stage;
    const SyntheticHand hand = at(0.0F, 0.0F, 600.0F);
    EXPECT_EQ(stage.show(0, {hand}).hands[0].id, 1);
    for (int k = 1; k < 7; ++k) {
        stage.show(k * 50'000, {});
    }
    const HandFrame& back = stage.show(350'000, {hand});
    ASSERT_EQ(back.count, 1U);
    EXPECT_EQ(back.hands[0].id, 2);
}

TEST(HandTracker, IdIsNewElsewhere) {
    Stage stage;
    EXPECT_EQ(stage.show(0, {at(-120.0F, 0.0F, 600.0F)}).hands[0].id, 1);
    stage.show(33'333, {});
    EXPECT_EQ(stage.show(100'000, {at(100.0F, 0.0F, 600.0F)}).hands[0].id, 2);
}

TEST(HandTracker, BorderIsTheHandsNotTheArms) {
    Stage stage;
    const HandFrame& low = stage.show(0, {at(0.0F, 100.0F, 600.0F)});
    ASSERT_EQ(low.count, 1U);
    EXPECT_FALSE(low.hands[0].touches_border) << "only the forearm is cut";
    const HandFrame& side = stage.show(33'333, {at(265.0F, 30.0F, 600.0F)});
    ASSERT_EQ(side.count, 1U);
    EXPECT_TRUE(side.hands[0].touches_border);
}

TEST(HandTracker, TwoHandsKeepTheirIds) {
    Stage stage;
    for (int k = 0; k < 28; ++k) {
        const auto s = static_cast<float>(k) * 2.0F;
        SyntheticHand left = at(-150.0F + s, -30.0F + 0.5F * s, 600.0F);
        left.thumb_to_the_right = true;
        SyntheticHand right = at(150.0F - s, 30.0F - 0.5F * s, 620.0F);
        right.thumb_to_the_right = false;
        const HandFrame& frame = stage.show(k * 16'667, {left, right});
        ASSERT_EQ(frame.count, 2U) << k;
        for (const Hand& hand : frame.all()) {
            const bool is_left = (hand.palm_mm - left.palm_mm).norm() < 20.0F;
            const bool is_right = (hand.palm_mm - right.palm_mm).norm() < 20.0F;
            ASSERT_NE(is_left, is_right) << k;
            static int left_id = 0;
            if (k == 0 && is_left) {
                left_id = hand.id;
            }
            if (k > 0) {
                EXPECT_EQ(is_left, hand.id == left_id) << k;
            }
        }
    }
}

TEST(HandTracker, EmptyScenesHoldNoHand) {
    Scene scene;
    HandTracker tracker = make_tracker(scene);
    std::int64_t t = 0;
    const auto hands = [&] {
        scene.depth.stamp = Stamp::from_us(t += 33'333);
        return tracker.track(scene.depth).count;
    };
    EXPECT_EQ(hands(), 0U) << "no depth at all";
    EXPECT_EQ(tracker.status(), TrackStatus::ok);
    scene.wall(900.0F);
    EXPECT_EQ(hands(), 0U) << "wall";
    scene.clear();
    scene.person(0.0F, 800.0F);
    EXPECT_EQ(hands(), 0U) << "person";
    scene.wall(1400.0F);
    scene.noise(2.0, 0.1, 1);
    EXPECT_EQ(hands(), 0U) << "person before a wall";
    scene.clear();
    scene.ball({0.0F, 0.0F, 700.0F}, 95.0F);
    EXPECT_EQ(hands(), 0U) << "head";
}

TEST(HandTracker, VelocityIsTheLineFits) {
    for (const int fps : {15, 30, 60, 120}) {
        Stage stage;
        const Vec3f velocity(600.0F, 0.0F, -200.0F);
        Vec3f measured = Vec3f::Zero();
        for (int k = 0; k * 1000 / fps <= 300; ++k) {
            const float t = static_cast<float>(k) / static_cast<float>(fps);
            const Vec3f p = Vec3f(-90.0F, 0.0F, 650.0F) + t * velocity;
            const HandFrame& frame = stage.show(k * 1'000'000LL / fps, {at(p.x(), p.y(), p.z())});
            ASSERT_EQ(frame.count, 1U) << fps;
            measured = frame.hands[0].palm_velocity_mmps;
        }
        EXPECT_LT((measured - velocity).norm(), 40.0F) << fps << " fps: " << measured.transpose();
    }
}

TEST(HandTracker, StampsMustNotDecrease) {
    Stage stage;
    const SyntheticHand hand = at(0.0F, 0.0F, 600.0F);
    stage.show(100'000, {hand});
    EXPECT_EQ(stage.tracker.status(), TrackStatus::ok);
    const HandFrame& same = stage.show(100'000, {});
    EXPECT_EQ(stage.tracker.status(), TrackStatus::repeated_stamp);
    EXPECT_EQ(same.count, 1U) << "skipped: the hands of before";
    const HandFrame& earlier = stage.show(50'000, {});
    EXPECT_EQ(stage.tracker.status(), TrackStatus::decreasing_stamp);
    EXPECT_EQ(earlier.count, 1U);
    EXPECT_EQ(earlier.stamp.us(), 100'000);
    EXPECT_EQ(stage.show(120'000, {hand}).hands[0].id, 1);
    stage.tracker.reset();
    EXPECT_EQ(stage.show(0, {hand}).hands[0].id, 2) << "after reset() time may begin anew";
}

TEST(HandTracker, WrongInputIsRefused) {
    Scene scene;
    HandTracker tracker = make_tracker(scene);
    DepthFrame other;
    other.depth.resize(320, 240);
    tracker.track(other);
    EXPECT_EQ(tracker.status(), TrackStatus::wrong_size);
    scene.depth.metric = false;
    tracker.track(scene.depth);
    EXPECT_EQ(tracker.status(), TrackStatus::not_metric);

    EXPECT_FALSE(HandTracker::create(scene.rig, {10, 10}).ok());
    EXPECT_FALSE(HandTracker::create(Rig{}, {640, 480}).ok());
    TrackerSettings settings;
    settings.max_hands = static_cast<int>(kMaxHands) + 1;
    EXPECT_FALSE(HandTracker::create(scene.rig, {640, 480}, settings).ok());
}

TEST(HandTracker, RefusesNumbersThatAreNone) {
    const Scene scene;
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    using S = TrackerSettings;
    for (double S::*number :
         {&S::near_mm, &S::far_mm, &S::palm_radius_min_mm, &S::palm_radius_max_mm,
          &S::hand_length_max_mm, &S::hand_area_min_mm2, &S::ahead_of_body_mm,
          &S::background_margin_mm, &S::reacquire_distance_mm, &S::tip_prominence_mm}) {
        TrackerSettings settings;
        settings.*number = kNan;
        const auto made = HandTracker::create(scene.rig, {640, 480}, settings);
        ASSERT_FALSE(made.ok());
        EXPECT_NE(made.error().message.find("NaN"), std::string::npos) << made.error().message;
    }
    Rig rig = scene.rig;
    rig.camera.matrix(0, 2) = kNan;
    const auto made = HandTracker::create(rig, {640, 480});
    ASSERT_FALSE(made.ok());
    EXPECT_NE(made.error().message.find("camera_matrix"), std::string::npos);
    rig = scene.rig;
    rig.camera.size = {};  // that of the depth images
    EXPECT_TRUE(HandTracker::create(rig, {640, 480}).ok());
}

TEST(HandTracker, RestingHandIsNotLearnt) {
    // Coarse frames, 5 a second: 20 s in a hundred frames. The hand is there from the first one.
    Scene scene({160, 120}, 150.0);
    HandTracker tracker = make_tracker(scene);
    const SyntheticHand hand = at(0.0F, 0.0F, 450.0F);
    scene.wall(900.0F);
    hand.draw(scene);
    for (int k = 0; k < 100; ++k) {
        scene.depth.stamp = Stamp::from_us(k * 200'000);
        const HandFrame& frame = tracker.track(scene.depth);
        ASSERT_EQ(frame.count, 1U) << k;
        ASSERT_EQ(frame.hands[0].id, 1) << k;
    }
}

}  // namespace
}  // namespace xtrack
