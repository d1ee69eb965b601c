// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "tests/gestures/recognise/play_hand.hpp"

namespace xtrack::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

Vec3f at(float x, float y = 0.0F, float z = 400.0F) { return {x, y, z}; }

GestureSettings both() {
    GestureSettings s;
    s.swipe = s.push = s.pinch = false;
    s.two_hand_zoom = s.two_hand_rotate = true;
    return s;
}

/// Pinches at 1 s, moves from `from` to `to`, opens at 3.5 s.
Actor hand(int id, Chirality side, const Vec3f& from, const Vec3f& to) {
    Actor actor{{{0, from, 75},
                 {800, from, 75},
                 {950, from, 12},
                 {1500, from, 12},
                 {3000, to, 12},
                 {3300, to, 12},
                 {3500, to, 75},
                 {4000, to, 75}}};
    actor.id = id;
    actor.chirality = side;
    return actor;
}

TEST(TwoHands, ApartIsZoomByTheRatioOfDistances) {
    Stage stage(both());
    stage.play(
        {hand(1, Chirality::left, at(-100), at(-200)), hand(2, Chirality::right, at(100), at(200))},
        60);
    ASSERT_THAT(stage.story(), ElementsAre("two_hand_zoom begin", "two_hand_zoom end"));
    const GestureEvent* end = stage.first(GestureType::two_hand_zoom, EventPhase::end);
    EXPECT_NEAR(end->value, 2.0F, 0.05F);
    EXPECT_EQ(end->hand_id, 1);
    EXPECT_EQ(end->other_hand_id, 2);
    EXPECT_NEAR(end->position_mm.x(), 0.0F, 2.0F);
}

TEST(TwoHands, TurningIsClockwiseAsTheUserSees) {
    Stage stage(both());
    // The right hand goes down, the left one up: clockwise. The distance stays.
    const float c = 100.0F * std::cos(0.7F);
    const float s = 100.0F * std::sin(0.7F);
    Actor left = hand(1, Chirality::left, at(-100), at(-c, s));
    Actor right = hand(2, Chirality::right, at(100), at(c, -s));
    // On the circle, not on its chord, along which they would come nearer.
    const float h = 100.0F * std::cos(0.35F);
    const float k = 100.0F * std::sin(0.35F);
    left.moments.insert(left.moments.begin() + 4, {2250, at(-h, k), 12});
    right.moments.insert(right.moments.begin() + 4, {2250, at(h, -k), 12});
    stage.play({left, right}, 60);
    ASSERT_THAT(stage.story(), ElementsAre("two_hand_rotate begin", "two_hand_rotate end"));
    EXPECT_NEAR(stage.first(GestureType::two_hand_rotate, EventPhase::end)->value, 0.7F * 57.2958F,
                2.0F);
}

TEST(TwoHands, OneHandAloneIsNothing) {
    Stage stage(both());
    stage.play(hand(1, Chirality::left, at(-100), at(-300)), 60);
    EXPECT_THAT(stage.story(), IsEmpty());
}

TEST(TwoHands, TwoRightHandsAreTwoPeople) {
    Stage stage(both());
    stage.play({hand(1, Chirality::right, at(-100), at(-200)),
                hand(2, Chirality::right, at(100), at(200))},
               60);
    EXPECT_THAT(stage.story(), IsEmpty());
}

TEST(TwoHands, TakeTheHandsFromTheirPinches) {
    GestureSettings s = both();
    s.pinch = s.drag = true;
    Stage stage(s);
    stage.play(
        {hand(1, Chirality::left, at(-100), at(-200)), hand(2, Chirality::right, at(100), at(200))},
        60);
    EXPECT_THAT(stage.story(),
                ElementsAre("pinch begin", "pinch begin", "pinch cancel superseded",
                            "pinch cancel superseded", "two_hand_zoom begin", "two_hand_zoom end"));
}

TEST(TwoHands, LossOfEitherCancels) {
    Stage stage(both());
    Actor left = hand(1, Chirality::left, at(-100), at(-200));
    left.moments = {{0, at(-100), 75},          {800, at(-100), 75},  {950, at(-100), 12},
                    {1500, at(-100), 12},       {2500, at(-200), 12}, {2501, at(-200), 12, false},
                    {4000, at(-200), 12, false}};
    stage.play({left, hand(2, Chirality::right, at(100), at(200))}, 60);
    EXPECT_THAT(stage.story(), ElementsAre("two_hand_zoom begin", "two_hand_zoom cancel lost"));
    const GestureEvent* gone = stage.first(GestureType::two_hand_zoom, EventPhase::cancel);
    ASSERT_NE(gone, nullptr);
    EXPECT_LE(gone->sensor, Stamp::from_us(2'650'000));
}

TEST(TwoHands, WhoseForearmsAreFarApartAreTwoPeople) {
    Stage stage(both());
    Actor left = hand(1, Chirality::left, at(-100), at(-200));
    left.forearm = Vec3f{-0.5F, -0.8F, 0.3F}.normalized();
    Actor right = hand(2, Chirality::right, at(100), at(200));
    right.forearm = Vec3f{0.3F, 0.9F, 0.3F}.normalized();  // from above: over a shoulder
    stage.play({left, right}, 60);
    EXPECT_THAT(stage.story(), IsEmpty());
}

}  // namespace
}  // namespace xtrack::test
