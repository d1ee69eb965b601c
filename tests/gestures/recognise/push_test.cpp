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
    GestureSettings settings;
    settings.pull = false;
    Stage stage(settings);
    stage.play(actor, 60);
    EXPECT_THAT(stage.story(), IsEmpty());
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

std::vector<std::string> pulls_and_pushes(const Actor& actor, double fps = 60) {
    GestureSettings settings;
    settings.pull = true;
    Stage stage(settings);
    stage.play(actor, fps);
    return stage.story();
}

TEST(Pull, GoesAwayFromTheScreen) {
    const Actor actor{
        {{0, at(0, 0, 300)}, {800, at(0, 0, 300)}, {1200, at(0, 0, 520)}, {2000, at(0, 0, 520)}}};
    for (const double fps : {15.0, 30.0, 60.0, 120.0}) {
        EXPECT_THAT(pulls_and_pushes(actor, fps), ElementsAre("pull")) << fps;
    }
}

TEST(Pull, NeedNotShowThePalm) {
    Actor actor{
        {{0, at(0, 0, 300)}, {800, at(0, 0, 300)}, {1200, at(0, 0, 520)}, {2000, at(0, 0, 520)}}};
    actor.held = Held::palm_down;
    EXPECT_THAT(pulls_and_pushes(actor), ElementsAre("pull"));
}

TEST(Pull, AHandThatDrawsBackToRestDoesNotPull) {
    GestureSettings settings;
    settings.pull = true;
    Stage stage(settings);
    stage.play(Actor{{{0, at(0, 0, 300)},
                      {800, at(0, 0, 300)},
                      {1050, at(0, 0, 412)},
                      {2000, at(0, 0, 412)}}},
               60);
    EXPECT_THAT(stage.story(), IsEmpty());
    EXPECT_TRUE(stage.explained("push", "short"));
}

TEST(Pull, IsNotTheWayBackOfAPush) {
    const Actor actor{{{0, at(0, 0, 500)},
                       {800, at(0, 0, 500)},
                       {1200, at(0, 0, 280)},
                       {1300, at(0, 0, 280)},
                       {1700, at(0, 0, 500)},
                       {2600, at(0, 0, 500)}}};
    EXPECT_THAT(pulls_and_pushes(actor), ElementsAre("push"));
}

TEST(Pull, ItsOwnWayBackIsNoPush) {
    const Actor actor{{{0, at(0, 0, 280)},
                       {800, at(0, 0, 280)},
                       {1200, at(0, 0, 500)},
                       {1300, at(0, 0, 500)},
                       {1700, at(0, 0, 280)},
                       {2600, at(0, 0, 280)}}};
    EXPECT_THAT(pulls_and_pushes(actor), ElementsAre("pull"));
}

TEST(Pull, AWayBackAfterAPauseIsNoPush) {
    // Still for longer than push_stable_ms, then as fast as the pull was.
    const Actor actor{{{0, at(0, 0, 280)},
                       {800, at(0, 0, 280)},
                       {1200, at(0, 0, 500)},
                       {1900, at(0, 0, 500)},
                       {2300, at(0, 0, 280)},
                       {3200, at(0, 0, 280)}}};
    EXPECT_THAT(pulls_and_pushes(actor), ElementsAre("pull"));
    GestureSettings forgetful;
    forgetful.push_return_memory_ms = 0.0;
    Stage stage(forgetful);
    stage.play(actor, 60);
    EXPECT_THAT(stage.story(), ElementsAre("pull", "push"));
    // It is forgotten in time.
    const Actor later{{{0, at(0, 0, 280)},
                       {800, at(0, 0, 280)},
                       {1200, at(0, 0, 500)},
                       {3000, at(0, 0, 500)},
                       {3400, at(0, 0, 280)},
                       {4200, at(0, 0, 280)}}};
    EXPECT_THAT(pulls_and_pushes(later), ElementsAre("pull", "push"));
}

TEST(Pull, AWindUpDoesNotBlockThePush) {
    const Actor actor{{{0, at(0, 0, 400)},
                       {800, at(0, 0, 400)},
                       {1250, at(0, 0, 570)},
                       {1550, at(0, 0, 250)},
                       {2600, at(0, 0, 250)}}};
    // The wind-up is as long as a pull, and one by itself.
    EXPECT_THAT(pulls_and_pushes(actor), ElementsAre("pull", "push"));
}

}  // namespace
}  // namespace xtrack::test
