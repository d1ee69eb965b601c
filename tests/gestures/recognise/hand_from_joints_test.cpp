// SPDX-License-Identifier: Apache-2.0
#include "gestures/track/hand_from_joints.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "tests/gestures/recognise/play_hand.hpp"

namespace xtrack::test {
namespace {

const Vec3f kUp{0.0F, 1.0F, 0.0F};
const Vec3f kToScreen{0.0F, 0.0F, -1.0F};

Hand shown(bool only_index = false) {
    Hand hand;
    hand.id = 1;
    hand.chirality = Chirality::right;
    hand.confidence = 1.0F;
    hand.palm_mm = Vec3f{10.0F, 20.0F, 300.0F};
    add_joints(hand, kUp, kToScreen, only_index);
    return hand;
}

TEST(HandFromJoints, ReadsAFlatHand) {
    Hand hand = shown();
    ASSERT_TRUE(complete_from_joints(hand));
    EXPECT_EQ(hand.palm_mm, (Vec3f{10.0F, 20.0F, 300.0F}));
    EXPECT_LT((hand.palm_normal - kToScreen).norm(), 1e-3F);
    // Right hand, fingers up, palm to the screen: the thumb is on the user's left.
    EXPECT_LT(hand.fingertip(Finger::thumb).position_mm.x(), 10.0F);
    for (const Finger f : {Finger::index, Finger::middle, Finger::ring, Finger::little}) {
        EXPECT_FLOAT_EQ(hand.finger_extension[static_cast<std::size_t>(f)], 1.0F);
        EXPECT_TRUE(hand.fingertip(f).valid);
    }
    EXPECT_EQ(hand.extended_fingers, 5);
    EXPECT_FLOAT_EQ(hand.grab_value, 0.0F);
    EXPECT_NEAR(hand.palm_radius_mm, 40.2F, 0.5F);  // knuckles span 60 mm
    EXPECT_NEAR(hand_length_mm(hand), 75.0F / 0.43F, 0.5F);
    EXPECT_NEAR(hand.pinch_aperture_mm, std::hypot(15.0F, 50.0F), 0.1F);
    EXPECT_NEAR(hand.pinch_value, (60.0F - std::hypot(15.0F, 50.0F)) / 45.0F, 0.01F);
}

TEST(HandFromJoints, ReadsAPointingHand) {
    Hand hand = shown(true);
    ASSERT_TRUE(complete_from_joints(hand));
    EXPECT_FLOAT_EQ(hand.finger_extension[static_cast<std::size_t>(Finger::index)], 1.0F);
    EXPECT_LT(hand.finger_extension[static_cast<std::size_t>(Finger::middle)], 0.2F);
    EXPECT_EQ(hand.extended_fingers, 2);  // thumb and index
    EXPECT_NEAR(hand.grab_value, 0.75F, 0.01F);
}

TEST(HandFromJoints, ALeftHandIsAMirroredOne) {
    Hand hand = shown();
    hand.chirality = Chirality::left;
    ASSERT_TRUE(complete_from_joints(hand));
    EXPECT_LT((hand.palm_normal + kToScreen).norm(), 1e-3F);
}

TEST(HandFromJoints, ToleratesMissingJoints) {
    Hand hand = shown();
    // As some headsets deliver it: no wrist, no metacarpals, a fingertip lost.
    hand.joint(Joint::wrist).valid = false;
    hand.joint(Joint::index_tip).valid = false;
    ASSERT_TRUE(complete_from_joints(hand));
    EXPECT_LT((hand.palm_normal - kToScreen).norm(), 1e-3F);
    EXPECT_FALSE(hand.fingertip(Finger::index).valid);
    EXPECT_EQ(hand.pinch_aperture_mm, -1.0F);
    EXPECT_EQ(hand.pinch_value, 0.0F);
    EXPECT_FLOAT_EQ(hand.finger_extension[static_cast<std::size_t>(Finger::index)], 1.0F)
        << "three joints still say it";

    Hand bare;
    bare.confidence = 1.0F;
    EXPECT_FALSE(complete_from_joints(bare));
    EXPECT_EQ(bare.confidence, 0.0F);

    Hand broken = shown();
    broken.joint(Joint::little_proximal).position_mm.x() = std::numeric_limits<float>::quiet_NaN();
    ASSERT_TRUE(complete_from_joints(broken));
    EXPECT_EQ(broken.palm_normal, Vec3f::Zero());
    EXPECT_TRUE(broken.palm_mm.allFinite());
}

TEST(HandFromJoints, FitsTheVelocityOverRealTime) {
    for (const double fps : {15.0, 30.0, 60.0, 120.0}) {
        HandFromJoints reader;
        Vec3f velocity = Vec3f::Zero();
        for (int i = 0; i < 20; ++i) {
            HandFrame frame;
            frame.count = 1;
            frame.stamp = Stamp{static_cast<std::int64_t>(1e9 * i / fps)};
            frame.hands[0].id = 5;
            frame.hands[0].palm_mm = Vec3f{static_cast<float>(300.0 * i / fps), 0.0F,
                                           static_cast<float>(-90.0 * i / fps)};
            add_joints(frame.hands[0], kUp, kToScreen, false);
            reader.complete(frame);
            velocity = frame.hands[0].palm_velocity_mmps;
        }
        EXPECT_NEAR(velocity.x(), 300.0F, 1.0F) << fps;
        EXPECT_NEAR(velocity.z(), -90.0F, 1.0F) << fps;
    }
}

TEST(HandFromJoints, ARepeatedStampKeepsTheVelocity) {
    HandFromJoints reader;
    HandFrame frame;
    frame.count = 1;
    frame.hands[0] = shown();
    for (int i = 0; i < 3; ++i) {
        frame.stamp = Stamp::from_us(33'000LL * std::min(i, 1));
        frame.hands[0].palm_mm = Vec3f{static_cast<float>(10 * i), 0.0F, 300.0F};
        add_joints(frame.hands[0], kUp, kToScreen, false);
        reader.complete(frame);
    }
    EXPECT_NEAR(frame.hands[0].palm_velocity_mmps.x(), 10.0F / 0.033F, 1.0F);
}

}  // namespace
}  // namespace xtrack::test
