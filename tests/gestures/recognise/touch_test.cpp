// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "tests/gestures/recognise/play_hand.hpp"

namespace xtrack::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

Vec3f at(float x, float y = 0.0F, float z = 400.0F) { return {x, y, z}; }

GestureSettings touching() {
    GestureSettings s;
    s.swipe = s.push = s.pinch = false;
    s.touch = true;
    return s;
}

TEST(Touch, InAndOut) {
    Stage stage(touching());
    Actor actor{{{0, at(0, 0, 200)},
                 {500, at(0, 0, 200)},
                 {1500, at(0, 0, 40)},
                 {2000, at(0, 0, 40)},
                 {3000, at(0, 0, 200)}}};
    actor.noise_mm = 2.0;
    stage.play(actor, 60);
    EXPECT_THAT(stage.story(), ElementsAre("touch begin", "touch end"));
    EXPECT_LT(stage.first(GestureType::touch, EventPhase::begin)->value, 50.0F);
    EXPECT_GT(stage.first(GestureType::touch, EventPhase::end)->value, 60.0F);
}

TEST(Touch, AHandThatAppearsInsideTouchesNothing) {
    Stage stage(touching());
    stage.play(Actor{{{0, at(0, 0, 30)}, {1000, at(0, 0, 30)}}}, 60);
    EXPECT_THAT(stage.story(), IsEmpty());
    EXPECT_TRUE(stage.explained("touch", "it was not seen outside"));
}

TEST(Touch, AtTheEdgeItDoesNotChatter) {
    Stage stage(touching());
    Actor actor{
        {{0, at(0, 0, 120)}, {500, at(0, 0, 120)}, {1500, at(0, 0, 50)}, {9000, at(0, 0, 50)}}};
    actor.noise_mm = 3.0;
    stage.play(actor, 60);
    EXPECT_THAT(stage.story(), ElementsAre("touch begin"));
}

TEST(Touch, ProgressGrowsOnTheWay) {
    Stage stage(touching());
    stage.play(Actor{{{0, at(0, 0, 200)}, {500, at(0, 0, 200)}, {1000, at(0, 0, 100)}}}, 60);
    EXPECT_NEAR(stage.recogniser.progress(1, GestureType::touch), 0.5, 0.02);
}

TEST(Touch, LossCancels) {
    Stage stage(touching());
    stage.play(Actor{{{0, at(0, 0, 200)},
                      {500, at(0, 0, 200)},
                      {1000, at(0, 0, 30)},
                      {1100, at(0, 0, 30)},
                      {1101, at(0, 0, 30), 70, false},
                      {1700, at(0, 0, 30), 70, false}}},
               60);
    EXPECT_THAT(stage.story(), ElementsAre("touch begin", "touch cancel lost"));
}

}  // namespace
}  // namespace xtrack::test
