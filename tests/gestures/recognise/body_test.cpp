// SPDX-License-Identifier: Apache-2.0
#include "gestures/recognise/body.hpp"

#include <chrono>
#include <cmath>

#include <gtest/gtest.h>

namespace xtrack::test {
namespace {

using recognise::Arm;
using recognise::HandSize;
using recognise::same_body;
using recognise::same_build;
using recognise::same_hand;
using recognise::SameBody;

const GestureSettings kSettings;

/// An adult's arm, whose elbow hangs below and behind the palm.
Arm arm(Chirality side, float x, float y = 0.0F, float z = 500.0F, float length_mm = 187.0F) {
    Arm l;
    l.palm_mm = {x, y, z};
    l.side = l.guess = side;
    l.length_mm = length_mm;
    l.forearm = Vec3f{side == Chirality::left ? -0.35F : 0.35F, -0.55F, 0.76F}.normalized();
    return l;
}

Arm left(float x, float y = 0.0F, float z = 500.0F, float length_mm = 187.0F) {
    return arm(Chirality::left, x, y, z, length_mm);
}
Arm right(float x, float y = 0.0F, float z = 500.0F, float length_mm = 187.0F) {
    return arm(Chirality::right, x, y, z, length_mm);
}

Arm without_arm(Arm l) {
    l.forearm.setZero();
    return l;
}

TEST(SameBody, HandsBeforeOneChestAre) {
    EXPECT_EQ(same_body(kSettings, left(-80), right(80)), SameBody::yes);
    EXPECT_EQ(same_body(kSettings, right(80), left(-80)), SameBody::yes);
    EXPECT_EQ(same_body(kSettings, left(-80), right(80, 80, 430)), SameBody::yes);
}

TEST(SameBody, TwiceTheSameSideIsNot) {
    EXPECT_EQ(same_body(kSettings, right(-80), right(80)), SameBody::same_side);
}

TEST(SameBody, ElbowsDoNotCrossAndPalmsDoNotBegin) {
    EXPECT_EQ(same_body(kSettings, left(200), right(-200)), SameBody::no);
    EXPECT_EQ(same_body(kSettings, left(50), right(-50)), SameBody::unsure);
}

TEST(SameBody, ElbowsOfTwoBodiesAreFarFromEachOther) {
    EXPECT_EQ(same_body(kSettings, left(-80), right(480)), SameBody::no);         // beside
    EXPECT_EQ(same_body(kSettings, left(-80), right(80, 320)), SameBody::no);     // above
    EXPECT_EQ(same_body(kSettings, left(-80), right(80, 0, 820)), SameBody::no);  // behind
    EXPECT_EQ(same_body(kSettings, left(-80), right(80, 220)), SameBody::unsure);
    EXPECT_EQ(same_body(kSettings, left(-80), right(80, 0, 720)), SameBody::unsure);
    EXPECT_EQ(same_body(kSettings, left(-80), right(360)), SameBody::unsure);
    EXPECT_EQ(same_body(kSettings, left(20), right(-20)), SameBody::unsure);  // hardly apart
}

TEST(SameBody, WhoHasJoinedMayStretch) {
    EXPECT_EQ(same_body(kSettings, left(-250), right(300)), SameBody::no);
    EXPECT_EQ(same_body(kSettings, left(-250), right(300), true), SameBody::unsure);
}

TEST(SameBody, LimitsGoWithTheBody) {
    // Elbows 530 mm apart: much for children, not for adults.
    EXPECT_EQ(same_body(kSettings, left(-150), right(150)), SameBody::yes);
    EXPECT_EQ(same_body(kSettings, left(-180, 0, 500, 140), right(180, 0, 500, 140)),
              SameBody::unsure);
}

TEST(SameBody, HandsOfOtherSizesAreNot) {
    EXPECT_EQ(same_body(kSettings, left(-80), right(80, 0, 500, 170)), SameBody::yes);
    EXPECT_EQ(same_body(kSettings, left(-80), right(80, 0, 500, 155)), SameBody::unsure);
    EXPECT_EQ(same_body(kSettings, left(-80), right(80, 0, 500, 140)), SameBody::no);
    // Bones are measured better than palms.
    Arm a = left(-80);
    Arm b = right(80, 0, 500, 170);
    a.bones = b.bones = true;
    EXPECT_EQ(same_body(kSettings, a, b), SameBody::unsure);
}

TEST(SameBody, WithoutArmsPalmsTellLess) {
    const Arm one = without_arm(left(-80));
    EXPECT_EQ(same_body(kSettings, one, without_arm(right(80))), SameBody::yes);
    EXPECT_EQ(same_body(kSettings, one, without_arm(right(80, 220))), SameBody::unsure);
    EXPECT_EQ(same_body(kSettings, one, without_arm(right(80, 0, 900))), SameBody::far);
    Arm unknown = without_arm(right(80));
    unknown.side = Chirality::unknown;
    EXPECT_EQ(same_body(kSettings, one, unknown), SameBody::unsure);
}

TEST(SameHand, IsOfOneSideOneSizeAndOnePlace) {
    const Arm was = right(80);
    EXPECT_TRUE(same_hand(kSettings, was, right(250)));
    EXPECT_FALSE(same_hand(kSettings, was, right(420)));
    EXPECT_FALSE(same_hand(kSettings, was, left(80)));
    EXPECT_FALSE(same_hand(kSettings, was, right(80, 0, 500, 140)));
    Arm guessed = right(80);
    guessed.side = Chirality::unknown;
    guessed.guess = Chirality::left;
    EXPECT_FALSE(same_build(was, guessed));
    // From above and behind: the palm is near, the elbow is not.
    Arm other_arm = right(80);
    other_arm.forearm = Vec3f{0.0F, 0.45F, 0.9F}.normalized();
    EXPECT_FALSE(same_hand(kSettings, was, other_arm));
}

Stamp at_ms(int ms) { return Stamp{} + std::chrono::milliseconds(ms); }

Hand palm(float radius_mm, float tilt_rad) {
    Hand hand;
    hand.palm_mm = {0.0F, 0.0F, 500.0F};
    hand.palm_radius_mm = radius_mm;
    hand.palm_normal = {std::sin(tilt_rad), 0.0F, -std::cos(tilt_rad)};
    return hand;
}

TEST(HandSize, ComesFromPalmsThatFaceTheCamera) {
    HandSize size;
    EXPECT_EQ(size.length_mm(), 0.0F);
    for (int i = 1; i <= 60; ++i) {
        size.add(palm(i % 2 == 0 ? 42.0F : 44.0F, 0.0F), at_ms(16 * i));
    }
    EXPECT_NEAR(size.length_mm(), 43.0F / 0.23F, 1.0F);
    // Edge on it shows nothing of its width; tilted by 40 degrees it shows a known part.
    for (int i = 61; i <= 120; ++i) {
        size.add(palm(16.0F, 1.3F), at_ms(16 * i));
        size.add(palm(43.0F * std::sqrt(std::cos(0.7F)), 0.7F), at_ms(16 * i + 8));
    }
    EXPECT_NEAR(size.length_mm(), 43.0F / 0.23F, 1.0F);
    size.forget();
    EXPECT_EQ(size.length_mm(), 0.0F);
}

TEST(HandSize, DoesNotDependOnTheFrameRate) {
    HandSize slow;
    HandSize fast;
    const auto radius = [](int ms) { return palm(ms < 1000 ? 40.0F : 44.0F, 0.0F); };
    for (int ms = 48; ms <= 1968; ms += 48) {
        slow.add(radius(ms), at_ms(ms));
    }
    for (int ms = 8; ms <= 1968; ms += 8) {
        fast.add(radius(ms), at_ms(ms));
    }
    EXPECT_NEAR(slow.length_mm(), fast.length_mm(), 2.0F);
}

}  // namespace
}  // namespace xtrack::test
