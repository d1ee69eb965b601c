// SPDX-License-Identifier: Apache-2.0
// What is taken for a hand where there are bodies, elbows and heads, too.
#include <cmath>

#include <gtest/gtest.h>

#include <xtrack/hand_tracker.hpp>

#include "tests/gestures/track/synthetic_hand.hpp"

namespace xtrack {
namespace {

using test::Scene;
using test::SyntheticHand;

Result<HandTracker> tracker_of(const Scene& scene) {
    return HandTracker::create(scene.rig, scene.depth.depth.size(), {});
}

/// A user whose chest is at 700 mm, one hand raised beside it, its palm so much before the chest.
Scene raised_beside_the_body(float ahead_mm, bool open) {
    Scene scene;
    scene.person(120.0F, 700.0F);
    SyntheticHand hand;
    hand.palm_mm = {-190.0F, 0.0F, 700.0F - ahead_mm};
    hand.extended.fill(open);
    hand.draw(scene);
    return scene;
}

TEST(HandChoice, AnOpenHandBesideItsBodyNeedNotBeBeforeIt) {
    const Scene scene = raised_beside_the_body(10.0F, true);
    auto tracker = tracker_of(scene);
    ASSERT_TRUE(tracker.ok());
    const HandFrame& frame = tracker->track(scene.depth);
    ASSERT_EQ(frame.count, 1U);
    EXPECT_LT((frame.hands[0].palm_mm - Vec3f(-190.0F, 0.0F, 690.0F)).norm(), 25.0F);
    EXPECT_EQ(frame.hands[0].extended_fingers, 5);
}

TEST(HandChoice, WhatShowsNoFingersMustBeBeforeTheBody) {
    const Scene scene = raised_beside_the_body(-70.0F, false);
    auto tracker = tracker_of(scene);
    ASSERT_TRUE(tracker.ok());
    EXPECT_EQ(tracker->track(scene.depth).count, 0U);
}

/// An arm across the image: elbow at one end and nearest to the camera, hand at the other.
TEST(HandChoice, AnElbowIsNoHandThoughItIsNearer) {
    Scene scene;
    const Vec3f elbow(-130.0F, 90.0F, 560.0F);
    const Vec3f wrist(40.0F, -30.0F, 600.0F);
    scene.capsule(elbow + Vec3f(-40.0F, 60.0F, 260.0F), elbow, 48.0F, 46.0F);
    scene.capsule(elbow, wrist, 46.0F, 28.0F);
    const Vec3f along = (wrist - elbow).normalized();
    const Vec3f palm = wrist + 55.0F * along;
    scene.capsule(wrist, palm + 15.0F * along, 28.0F, 34.0F);
    // One finger is straight, the others are in the fist.
    scene.capsule(palm + 30.0F * along, palm + 110.0F * along, 8.5F, 8.5F);
    auto tracker = tracker_of(scene);
    ASSERT_TRUE(tracker.ok());
    const HandFrame& frame = tracker->track(scene.depth);
    ASSERT_EQ(frame.count, 1U);
    const Vec3f off = frame.hands[0].palm_mm - palm;
    EXPECT_LT(off.head<2>().norm(), 35.0F) << frame.hands[0].palm_mm.transpose();
}

/// A head whose hair gives no depth is as thin as a limb, and nearer than the chest.
TEST(HandChoice, AFaceCutByHairIsNoHand) {
    Scene scene;
    scene.person(0.0F, 900.0F);
    scene.ball({0.0F, -190.0F, 890.0F}, 90.0F);
    for (int y = 0; y < 480; ++y) {
        for (int x = 0; x < 640; ++x) {
            // What is left of the head: 100 mm of it across, and its lower part.
            const float x_mm = (static_cast<float>(x) - 319.5F) / 600.0F * 800.0F;
            const float y_mm = (static_cast<float>(y) - 239.5F) / 600.0F * 800.0F;
            if (y_mm < -115.0F && (std::abs(x_mm) > 50.0F || y_mm < -250.0F)) {
                scene.depth.depth.at(x, y) = 0;
            }
        }
    }
    auto tracker = tracker_of(scene);
    ASSERT_TRUE(tracker.ok());
    EXPECT_EQ(tracker->track(scene.depth).count, 0U);
}

/// What lies far behind a hand that is followed never becomes one, however much it looks like it.
TEST(HandChoice, NothingFarBehindAFollowedHandIsTheSecond) {
    Scene scene;
    auto tracker = tracker_of(scene);
    ASSERT_TRUE(tracker.ok());
    SyntheticHand near;
    near.palm_mm = {-100.0F, 0.0F, 500.0F};
    near.extended.fill(false);
    SyntheticHand far;
    far.palm_mm = {160.0F, 0.0F, 760.0F};
    for (int k = 0; k < 10; ++k) {
        scene.clear();
        near.draw(scene);
        if (k > 0) {
            far.draw(scene);
        }
        scene.depth.stamp = Stamp::from_us(k * 33333);
        const HandFrame& frame = tracker->track(scene.depth);
        ASSERT_EQ(frame.count, 1U) << k;
        EXPECT_EQ(frame.hands[0].id, 1) << k;
        EXPECT_LT((frame.hands[0].palm_mm - near.palm_mm).norm(), 25.0F) << k;
    }
}

/// Pixels at the rim of a finger may mix its depth with that of what lies behind.
TEST(HandChoice, FingersWithMixedDepthBesideThemAreFingers) {
    Scene scene;
    SyntheticHand hand;
    hand.draw(scene);
    const DepthFrame clean = scene.depth;
    for (int y = 0; y < 480; ++y) {
        for (int x = 0; x < 640; ++x) {
            // To the right of the hand a ramp of 30 mm, 6 pixels wide, as time-of-flight cameras
            // smear it.
            for (int k = 1; k <= 6 && clean.depth.at(x, y) == 0; ++k) {
                const int from = x - k;
                if (from >= 0 && clean.depth.at(from, y) != 0) {
                    scene.depth.depth.at(x, y) =
                        static_cast<std::uint16_t>(clean.depth.at(from, y) + k * 50);
                    break;
                }
            }
        }
    }
    auto tracker = tracker_of(scene);
    ASSERT_TRUE(tracker.ok());
    const HandFrame& frame = tracker->track(scene.depth);
    ASSERT_EQ(frame.count, 1U);
    // With widths in three dimensions one was left.
    EXPECT_GE(frame.hands[0].extended_fingers, 4);
}

/// A flat hand, fingers together, is nearly as wide everywhere: its palm stays where it was.
TEST(HandChoice, ThePalmOfAFlatHandDoesNotJump) {
    Scene scene;
    auto tracker = tracker_of(scene);
    ASSERT_TRUE(tracker.ok());
    Vec3f first = Vec3f::Zero();
    Vec3f before = Vec3f::Zero();
    for (int k = 0; k < 40; ++k) {
        scene.clear();
        const Vec3f palm(-150.0F + 8.0F * static_cast<float>(k), 20.0F, 600.0F);
        for (const float side : {-26.0F, -9.0F, 9.0F, 26.0F}) {
            scene.capsule(palm + Vec3f(side, 40.0F, 12.0F), palm + Vec3f(side, -95.0F, 12.0F),
                          14.0F, 12.0F);
        }
        scene.capsule(palm + Vec3f(0.0F, 55.0F, 20.0F), palm + Vec3f(0.0F, 240.0F, 120.0F), 27.0F,
                      34.0F);
        scene.noise(2.0, 0.05, static_cast<unsigned>(k));
        scene.depth.stamp = Stamp::from_us(k * 33333);
        const HandFrame& frame = tracker->track(scene.depth);
        ASSERT_EQ(frame.count, 1U) << k;
        EXPECT_EQ(frame.hands[0].id, 1) << k;
        const Vec3f off = frame.hands[0].palm_mm - palm;
        if (k == 0) {
            first = before = off;
        }
        EXPECT_LT((off - before).norm(), 35.0F) << k;
        // This hand is as wide all along, and its palm may be found anywhere on it.
        EXPECT_LT((off - first).norm(), 70.0F) << k;
        before = off;
    }
}

}  // namespace
}  // namespace xtrack
