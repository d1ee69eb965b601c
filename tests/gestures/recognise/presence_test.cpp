// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "tests/gestures/recognise/play_hand.hpp"

namespace xtrack::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

Vec3f at(float x, float y = 0.0F) { return {x, y, 400.0F}; }

std::vector<std::string> hands_of(const Stage& stage) {
    std::vector<std::string> lines;
    for (const GestureEvent& e : stage.events) {
        if (e.type == GestureType::hand) {
            lines.push_back(std::to_string(e.hand_id) + " " + to_string(e.phase));
            EXPECT_EQ(e.gesture_id, -1);
        }
    }
    return lines;
}

TEST(Presence, AHandComesAndGoes) {
    Stage stage;
    stage.play(Actor{{{0, at(0), 70, false},
                      {200, at(0)},
                      {1000, at(0)},
                      {1001, at(0), 70, false},
                      {2000, at(0), 70, false}}},
               60);
    EXPECT_THAT(hands_of(stage), ElementsAre("1 begin", "1 end"));
    EXPECT_NEAR(static_cast<double>(stage.events[0].sensor.us()), 300e3, 20e3);  // valid for 100 ms
    EXPECT_NEAR(static_cast<double>(stage.events[1].sensor.us()), 1300e3, 30e3);  // gone for 300 ms
}

TEST(Presence, AGlimpseIsNoHand) {
    Stage stage;
    stage.play(Actor{{{0, at(0), 70, false},
                      {200, at(0)},
                      {260, at(0), 70, false},
                      {800, at(0), 70, false}}},
               60);
    EXPECT_THAT(hands_of(stage), IsEmpty());
}

TEST(Presence, AShortLossIsNoGoing) {
    Stage stage;
    stage.play(Actor{{{0, at(0)}, {1000, at(0), 70, false}, {1200, at(20)}, {2000, at(20)}}}, 60);
    EXPECT_THAT(hands_of(stage), ElementsAre("1 begin"));
}

TEST(Presence, AnUncertainHandIsNotSeen) {
    Stage stage;
    Actor actor{{{0, at(0)}, {800, at(0)}, {1100, at(-300)}, {2000, at(-300)}}};
    actor.confidence = 0.59F;
    stage.play(actor, 60);
    EXPECT_THAT(stage.events, IsEmpty());
}

TEST(Presence, NothingHappensWhileTheHandEnters) {
    // Seen at 400 ms, strokes until 700 ms: still in the lock-out.
    Stage stage;
    stage.play(Actor{{{0, at(250), 70, false}, {400, at(250)}, {690, at(-100)}, {1500, at(-100)}}},
               60);
    EXPECT_THAT(stage.story(), IsEmpty());
    EXPECT_THAT(hands_of(stage), ElementsAre("1 begin"));
}

TEST(Presence, AHandInViewFromTheStartMayActAtOnce) {
    Stage stage;
    stage.play(Actor{{{0, at(150)}, {120, at(150)}, {420, at(-150)}, {1200, at(-150)}}}, 60);
    EXPECT_THAT(stage.story(), ElementsAre("swipe_left"));
}

TEST(Presence, AHeldConditionBeginsWhenTheLockOutEnds) {
    // Comes in open at 400 ms, closes at once; the lock-out ends at 700 ms.
    Stage stage;
    stage.play(
        Actor{{{0, at(0), 70, false}, {400, at(0), 70}, {500, at(0), 12}, {1200, at(0), 12}}}, 60);
    ASSERT_THAT(stage.story(), ElementsAre("pinch begin"));
    EXPECT_NEAR(
        static_cast<double>(stage.first(GestureType::pinch, EventPhase::begin)->sensor.us()), 700e3,
        20e3);
}

TEST(Presence, NothingHappensAtTheBorder) {
    Stage stage;
    stage.play(Actor{{{0, at(150)},
                      {800, at(150), 70, true, true},
                      {1100, at(-150), 70, true, true},
                      {1800, at(-150), 70, true, true}}},
               60);
    EXPECT_THAT(stage.story(), IsEmpty());
}

TEST(Presence, WalkingOutOfViewIsNoGesture) {
    // tracky-mouse clicked while its user left: fast to the side, cut by the border, gone.
    Stage stage;
    stage.play(Actor{{{0, at(0)},
                      {800, at(0)},
                      {850, at(40), 40, true, true},
                      {1000, at(300), 12, true, true},
                      {1050, at(350), 12, false},
                      {2000, at(350), 12, false}}},
               60);
    EXPECT_THAT(stage.story(), IsEmpty());
    EXPECT_THAT(hands_of(stage), ElementsAre("1 begin", "1 end"));
}

TEST(Presence, AStrokeAcrossALossIsNone) {
    Stage stage;
    stage.play(Actor{{{0, at(200)},
                      {800, at(200), 70, false},
                      {950, at(-100)},
                      {1000, at(-100)},
                      {1800, at(-100)}}},
               60);
    EXPECT_THAT(stage.story(), IsEmpty());
}

TEST(Presence, TwoHandsDoNotMix) {
    Actor left{{{0, at(-200)}, {800, at(-200)}, {1100, at(-450)}, {2000, at(-450)}}};
    left.id = 4;
    left.chirality = Chirality::left;
    Actor right{{{0, at(200), 75}, {900, at(200), 75}, {1050, at(200), 12}, {2000, at(200), 12}}};
    right.id = 9;
    Stage stage;
    stage.play({left, right}, 60);
    EXPECT_THAT(stage.story(), ElementsAre("swipe_left", "pinch begin"));
    EXPECT_EQ(stage.first(GestureType::swipe, EventPhase::end)->hand_id, 4);
    EXPECT_EQ(stage.first(GestureType::swipe, EventPhase::end)->hand, Chirality::left);
    EXPECT_EQ(stage.first(GestureType::pinch, EventPhase::begin)->hand_id, 9);
    EXPECT_NE(stage.first(GestureType::swipe, EventPhase::end)->gesture_id,
              stage.first(GestureType::pinch, EventPhase::begin)->gesture_id);
}

TEST(Presence, OneHandLostLeavesTheOther) {
    Actor stays{
        {{0, at(-200), 75}, {800, at(-200), 75}, {950, at(-200), 12}, {2500, at(-200), 12}}};
    Actor goes{{{0, at(200), 75},
                {800, at(200), 75},
                {950, at(200), 12},
                {1500, at(200), 12, false},
                {2500, at(200), 12, false}}};
    goes.id = 2;
    Stage stage;
    stage.play({stays, goes}, 60);
    EXPECT_THAT(stage.story(), ElementsAre("pinch begin", "pinch begin", "pinch cancel lost"));
    EXPECT_EQ(stage.first(GestureType::pinch, EventPhase::cancel)->hand_id, 2);
}

TEST(Presence, ManyIdsInARowLeakNothing) {
    // A tracker that renames its hand every frame: slots are few, and nothing may be stuck.
    Stage stage;
    Noise noise(3);
    for (int i = 0; i < 200; ++i) {
        Actor actor{{{0, at(0), 12}}};
        actor.id = i;
        HandFrame frame;
        frame.stamp = Stamp::from_us(16'667LL * i);
        frame.coordinates = CoordinateFrame::interaction;
        frame.count = 1;
        frame.hands[0] = hand_of(actor, actor.moments[0], noise);
        stage.keep(stage.recogniser.push(frame));
    }
    EXPECT_THAT(stage.events, IsEmpty());
}

TEST(Presence, AJumpOnTheWayInBeginsTheEntryAnew) {
    // An elbow is followed for 200 ms; then the hand comes into view, and goes on upward.
    Stage stage;
    stage.play(Actor{{{0, {0, 0, 400}, 70, false}, {100, {0, 0, 400}, 70, false}}}, 30);
    Actor actor{{{133, {-200, -210, 450}},
                 {337, {-200, -205, 450}},
                 {362, {0, -200, 450}},
                 {662, {0, 50, 400}},
                 {1500, {0, 50, 400}}}};
    stage.play(actor, 30);
    EXPECT_THAT(stage.story(), ::testing::IsEmpty());
}

}  // namespace
}  // namespace xtrack::test
