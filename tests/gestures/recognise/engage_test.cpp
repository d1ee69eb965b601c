// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "tests/gestures/recognise/play_hand.hpp"

namespace xtrack::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

Vec3f at(float x, float y = 0.0F, float z = 400.0F) { return {x, y, z}; }

const Vec3f kHangsRight = Vec3f{0.3F, -0.8F, 0.4F}.normalized();
const Vec3f kHangsLeft = Vec3f{-0.3F, -0.8F, 0.4F}.normalized();

GestureSettings sessions() {
    GestureSettings s;
    s.push = s.pinch = false;
    s.engage = true;
    return s;
}

/// Waits until `start_ms`, swipes left, rests.
Actor swiper(double start_ms, float x = 150.0F) {
    return {{{0, at(x)},
             {start_ms, at(x)},
             {start_ms + 350, at(x - 300)},
             {start_ms + 1500, at(x - 300)}}};
}

TEST(Engage, AHandThatIsStillInTheZoneTakesTheSession) {
    Stage stage(sessions());
    stage.play(swiper(1000), 60);
    EXPECT_THAT(stage.story(), ElementsAre("engage begin", "swipe_left"));
    const GestureEvent* begin = stage.first(GestureType::engage, EventPhase::begin);
    EXPECT_NEAR(to_seconds(begin->sensor - begin->onset), 0.3, 0.03);
    EXPECT_EQ(stage.recogniser.session_owner(), 1);
}

TEST(Engage, OutsideTheZoneNothingIsHeard) {
    Stage stage(sessions());
    Actor far = swiper(1000);
    for (At& m : far.moments) {
        m.palm_mm.z() = 1200.0F;
    }
    stage.play(far, 60);
    EXPECT_THAT(stage.story(), IsEmpty());
    EXPECT_EQ(stage.recogniser.session_owner(), 0);
}

TEST(Engage, LeavingTheZoneEndsIt) {
    GestureSettings s = sessions();
    s.swipe = false;  // dropping the hand is one
    Stage stage(s);
    stage.play(Actor{{{0, at(0)}, {1000, at(0)}, {2000, at(0, -600)}, {3000, at(0, -600)}}}, 60);
    EXPECT_THAT(stage.story(), ElementsAre("engage begin", "engage end"));
    EXPECT_EQ(stage.recogniser.session_owner(), 0);
}

TEST(Engage, IdlenessTimesOutAndAHandThatJustRestsDoesNotComeBack) {
    Stage stage(sessions());
    stage.play(Actor{{{0, at(0)}, {40'000, at(0)}}}, 30);
    EXPECT_THAT(stage.story(), ElementsAre("engage begin", "engage cancel timeout"));
}

TEST(Engage, AfterItsTimeoutAHandThatMovesMayComeBack) {
    Stage stage(sessions());
    stage.play(Actor{{{0, at(0)}, {17'000, at(0)}, {17'300, at(120)}, {19'000, at(120)}}}, 30);
    EXPECT_THAT(stage.story(),
                ElementsAre("engage begin", "engage cancel timeout", "engage begin"));
}

TEST(Engage, OthersAreBystanders) {
    Stage stage(sessions());
    Actor owner{{{0, at(-200)}, {6000, at(-200)}}};
    owner.forearm = kHangsLeft;
    Actor other = swiper(3000, 350.0F);
    other.id = 2;
    other.moments.front().ms = 0;
    other.moments.insert(other.moments.begin(), {0, at(350), 70, false});
    other.moments[1].ms = 1500;
    other.forearm = Vec3f{0.6F, 0.7F, 0.4F}.normalized();
    stage.play({owner, other}, 60);
    EXPECT_THAT(stage.story(), ElementsAre("engage begin"));
    EXPECT_EQ(stage.recogniser.session_owner(), 1);
}

TEST(Engage, ABystandersRestOfBeforeDoesNotCount) {
    GestureSettings s = sessions();
    s.swipe = s.pull = false;
    s.engage_by_wave = s.engage_by_raise = false;
    Actor owner{
        {{0, at(-150)}, {2500, at(-150)}, {2900, at(-150, 0, 1300)}, {6000, at(-150, 0, 1300)}}};
    // Comes to rest beside the owner just before that has the session; to and fro when it ends, and
    // slow only where it turns, which it does just then.
    Actor other{{{0, at(450)}, {150, at(200)}, {1400, at(200)}}};
    for (int i = 1; i <= 11; ++i) {
        other.moments.push_back({1400.0 + 400.0 * i, at(i % 2 == 1 ? 450.0F : 200.0F)});
    }
    other.id = 2;
    Stage stage(s);
    stage.play({owner, other}, 60);
    EXPECT_THAT(stage.story(), ElementsAre("engage begin", "engage end"));
    EXPECT_EQ(stage.events.back().hand_id, 1);
}

TEST(Engage, ASecondHandOfTheSameBodyJoins) {
    Stage stage(sessions());
    Actor owner{{{0, at(-200)}, {6000, at(-200)}}};
    owner.chirality = Chirality::left;
    owner.forearm = kHangsLeft;
    Actor second = swiper(3000, 250.0F);
    second.id = 2;
    second.moments.insert(second.moments.begin(), {0, at(250), 70, false});
    second.moments[1].ms = 1500;
    second.forearm = kHangsRight;
    stage.play({owner, second}, 60);
    EXPECT_THAT(stage.story(), ElementsAre("engage begin", "swipe_left"));
}

TEST(Engage, WhenTheOwnerIsLostTheSessionIsOver) {
    Stage stage(sessions());
    stage.play(
        Actor{{{0, at(0)}, {1000, at(0)}, {1001, at(0), 70, false}, {2000, at(0), 70, false}}}, 60);
    EXPECT_THAT(stage.story(), ElementsAre("engage begin", "engage cancel lost"));
}

TEST(Engage, AnOwnerThatComesBackKeepsIt) {
    Stage stage(sessions());
    stage.play(Actor{{{0, at(0)},
                      {1000, at(0)},
                      {1001, at(0), 70, false},
                      {1200, at(0), 70, false},
                      {1201, at(0)},
                      {2000, at(0)},
                      {2300, at(-300)},
                      {3000, at(-300)}}},
               60);
    EXPECT_THAT(stage.story(), ElementsAre("engage begin", "swipe_left"));
}

TEST(Engage, OfAnOwnerThatWasLostIsKeptForIt) {
    Stage stage(sessions());
    Actor owner{{{0, at(-200)}, {1500, at(-200)}, {1501, at(-200), 70, false}, {6000, at(-200)}}};
    owner.moments.back().seen = false;
    Actor waits{{{0, at(250), 70, false}, {1000, at(250)}, {6000, at(250)}}};
    waits.id = 2;
    Actor back{{{0, at(-180), 70, false}, {2500, at(-180)}, {6000, at(-180)}}};
    back.id = 3;
    stage.play({owner, waits, back}, 60);
    EXPECT_THAT(stage.story(), ElementsAre("engage begin", "engage cancel lost", "engage begin"));
    EXPECT_EQ(stage.recogniser.session_owner(), 3);
}

TEST(Engage, OfAnOwnerThatStaysAwayIsFreeAfterTwoSeconds) {
    Stage stage(sessions());
    Actor owner{{{0, at(-200)}, {1500, at(-200)}, {1501, at(-200), 70, false}, {6000, at(-200)}}};
    owner.moments.back().seen = false;
    Actor waits{{{0, at(250), 70, false}, {1000, at(250)}, {6000, at(250)}}};
    waits.id = 2;
    stage.play({owner, waits}, 60);
    EXPECT_EQ(stage.recogniser.session_owner(), 2);
    const GestureEvent& begin = stage.events.back();
    EXPECT_EQ(begin.type, GestureType::engage);
    EXPECT_NEAR(to_seconds(begin.sensor - Stamp{}), 3.8, 0.1);  // it was gone at 1.8
}

TEST(Engage, AWaveTakesTheSessionWithoutBeingOne) {
    GestureSettings s = sessions();
    s.engage_by_stillness = false;
    Stage stage(s);
    Actor actor{{{0, at(0)}, {800, at(0)}}};
    for (int i = 0; i < 6; ++i) {
        actor.moments.push_back({1050.0 + 250.0 * i, at(i % 2 == 0 ? 90.0F : -40.0F)});
    }
    actor.moments.push_back({3500, at(0)});
    stage.play(actor, 60);
    ASSERT_THAT(stage.story(), ::testing::Not(IsEmpty()));
    EXPECT_EQ(stage.story().front(), "engage begin");
}

TEST(Engage, ARaiseThatBeganBeforeTheSessionIsNone) {
    GestureSettings s = sessions();
    s.swipe = s.pull = false;
    s.raise = true;
    s.zone_bottom_mm = -100.0;
    s.engage_ms = 100.0;  // before a raise is known
    const Actor actor{
        {{0, at(0, -200)}, {1000, at(0, -200)}, {1500, at(0, 20)}, {3000, at(0, 20)}}};
    Stage stage(s);
    stage.play(actor, 60);
    EXPECT_THAT(stage.story(), ElementsAre("engage begin"));
    s.engage = false;
    Stage without(s);
    without.play(actor, 60);
    EXPECT_THAT(without.story(), ElementsAre("raise"));
}

TEST(Engage, WhatIsActiveEndsWithTheSession) {
    GestureSettings s = sessions();
    s.pinch = true;
    s.swipe = false;
    Stage stage(s);
    stage.play(Actor{{{0, at(0), 75},
                      {800, at(0), 75},
                      {950, at(0), 12},
                      {1500, at(0), 12},
                      {3500, at(0, -500), 12},
                      {4500, at(0, -500), 12}}},
               60);
    EXPECT_THAT(stage.story(), ElementsAre("engage begin", "pinch begin", "engage end",
                                           "pinch cancel disengaged"));
}

TEST(Pause, CancelsAndSilences) {
    Stage stage;
    stage.play(Actor{{{0, at(0), 75}, {800, at(0), 75}, {950, at(0), 12}, {1500, at(0), 12}}}, 60);
    stage.keep(stage.recogniser.pause(true));
    EXPECT_THAT(stage.story(), ElementsAre("pinch begin", "pinch cancel disengaged"));
    stage.play(
        Actor{{{1517, at(0), 12}, {2000, at(0), 75}, {2300, at(-300), 75}, {3000, at(-300), 75}}},
        60);
    EXPECT_EQ(stage.story().size(), 2U);
    stage.keep(stage.recogniser.pause(false));
    stage.play(
        Actor{{{3017, at(-300), 75}, {3800, at(-300), 75}, {4100, at(0), 75}, {4800, at(0), 75}}},
        60);
    EXPECT_THAT(stage.story(),
                ElementsAre("pinch begin", "pinch cancel disengaged", "swipe_right"));
}

}  // namespace
}  // namespace xtrack::test
