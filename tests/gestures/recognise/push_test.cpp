// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "tests/gestures/recognise/play_hand.hpp"

namespace xtrack::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

Vec3f at(float x, float y, float z) { return {x, y, z}; }

std::vector<std::string> story_of(const Actor& actor, double fps = 60) {
    Stage stage;
    stage.play(actor, fps);
    return stage.story();
}

TEST(Push, GoesTowardTheScreen) {
    const Actor actor{
        {{0, at(0, 0, 500)}, {800, at(0, 0, 500)}, {1200, at(0, 0, 280)}, {2000, at(0, 0, 280)}}};
    EXPECT_THAT(story_of(actor), ElementsAre("push"));
}

TEST(Push, AwayFromItIsNone) {
    const Actor actor{
        {{0, at(0, 0, 300)}, {800, at(0, 0, 300)}, {1200, at(0, 0, 520)}, {2000, at(0, 0, 520)}}};
    EXPECT_THAT(story_of(actor), IsEmpty());
}

TEST(Push, SlowOrSlantingIsNone) {
    const Actor slow{
        {{0, at(0, 0, 500)}, {800, at(0, 0, 500)}, {2200, at(0, 0, 280)}, {3000, at(0, 0, 280)}}};
    EXPECT_THAT(story_of(slow), IsEmpty());
    const Actor slanting{{{0, at(0, 0, 500)},
                          {800, at(0, 0, 500)},
                          {1200, at(130, 130, 300)},
                          {2000, at(130, 130, 300)}}};
    EXPECT_THAT(story_of(slanting), ::testing::Not(::testing::Contains("push")));
}

TEST(Push, AHandThatIsRaisedAndReachesOutDoesNotPush) {
    const Actor actor{{{0, at(0, -300, 600)},
                       {800, at(0, -300, 600)},
                       {1050, at(0, -20, 560)},
                       {1350, at(0, 0, 380)},
                       {2000, at(0, 0, 380)}}};
    Stage stage;
    stage.play(actor, 60);
    EXPECT_THAT(stage.story(), ::testing::Not(::testing::Contains("push")));
}

TEST(Push, TwoPushesNeedAPause) {
    const Actor hasty{{{0, at(0, 0, 500)},
                       {800, at(0, 0, 500)},
                       {1150, at(0, 0, 300)},
                       {1450, at(0, 0, 500)},
                       {1800, at(0, 0, 300)},
                       {2600, at(0, 0, 300)}}};
    EXPECT_THAT(story_of(hasty), ElementsAre("push"));
    const Actor calm{{{0, at(0, 0, 500)},
                      {800, at(0, 0, 500)},
                      {1150, at(0, 0, 300)},
                      {1700, at(0, 0, 500)},
                      {2400, at(0, 0, 500)},
                      {2750, at(0, 0, 300)},
                      {3500, at(0, 0, 300)}}};
    EXPECT_THAT(story_of(calm), ElementsAre("push", "push"));
}

TEST(Push, ThePalmFacesTheScreen) {
    Actor actor{
        {{0, at(0, 0, 500)}, {800, at(0, 0, 500)}, {1200, at(0, 0, 280)}, {2000, at(0, 0, 280)}}};
    actor.held = Held::palm_screen;
    EXPECT_THAT(story_of(actor), ElementsAre("push"));
    actor.held = Held::palm_down;
    EXPECT_THAT(story_of(actor), IsEmpty());
}

}  // namespace
}  // namespace xtrack::test
