// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "tests/gestures/recognise/play_hand.hpp"

namespace xtrack::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

Vec3f at(float x, float y, float z = 400.0F) { return {x, y, z}; }

Stage shown(const Actor& actor, double fps = 60, bool swipe = false) {
    GestureSettings settings;
    settings.swipe = swipe;
    settings.raise = true;
    Stage stage(settings);
    stage.play(actor, fps);
    return stage;
}

Actor raising(float rise_mm, double rise_ms = 600, double still_ms = 800) {
    return {{{0, at(0, -100)},
             {800, at(0, -100)},
             {800 + rise_ms, at(0, rise_mm - 100)},
             {800 + rise_ms + still_ms, at(0, rise_mm - 100)}}};
}

TEST(Raise, GoesUpAndIsStill) {
    for (const double fps : {15.0, 30.0, 60.0, 120.0}) {
        const Stage stage = shown(raising(220), fps);
        ASSERT_THAT(stage.story(), ElementsAre("raise")) << fps;
        const GestureEvent* raise = stage.first(GestureType::raise, EventPhase::end);
        EXPECT_NEAR(raise->value, 220.0F, 10.0F);
        EXPECT_NEAR(static_cast<double>(raise->sensor.us()), 1.57e6, 0.12e6);
    }
}

TEST(Raise, ShortSlowOrDownwardIsNone) {
    EXPECT_THAT(shown(raising(120)).story(), IsEmpty());
    EXPECT_THAT(shown(raising(200, 2500)).story(), IsEmpty());
    EXPECT_THAT(shown(raising(-220)).story(), IsEmpty());
}

TEST(Raise, NotWithoutRest) {
    // It comes down at once.
    EXPECT_THAT(shown({{{0, at(0, -100)},
                        {800, at(0, -100)},
                        {1300, at(0, 120)},
                        {1350, at(0, 120)},
                        {1850, at(0, -100)},
                        {2600, at(0, -100)}}})
                    .story(),
                IsEmpty());
}

TEST(Raise, SlantingIsNone) {
    const Stage stage =
        shown({{{0, at(0, -100)}, {800, at(0, -100)}, {1400, at(150, 100)}, {2200, at(150, 100)}}});
    EXPECT_THAT(stage.story(), IsEmpty());
    EXPECT_TRUE(stage.explained("raise", "goes aside"));
}

TEST(Raise, IsSentOnce) {
    EXPECT_THAT(shown(raising(220, 600, 3000)).story(), ElementsAre("raise"));
    // A hand that then stirs does not raise again.
    EXPECT_THAT(shown({{{0, at(0, -100)},
                        {800, at(0, -100)},
                        {1300, at(0, 120)},
                        {1700, at(0, 120)},
                        {1800, at(20, 120)},
                        {2600, at(20, 120)}}})
                    .story(),
                ElementsAre("raise"));
}

TEST(Raise, AHandThatIsNotHeldUpFlatIsOnItsWayElsewhere) {
    Actor actor = raising(220);
    actor.held = Held::palm_screen;
    EXPECT_THAT(shown(actor).story(), ElementsAre("raise"));
    for (const Held held : {Held::palm_down, Held::pointing_down}) {
        actor.held = held;
        const Stage stage = shown(actor);
        EXPECT_THAT(stage.story(), IsEmpty());
        EXPECT_TRUE(stage.explained("raise", "it is not held up flat"));
    }
}

TEST(Raise, AStrokeUpIsASwipe) {
    EXPECT_THAT(shown(raising(220, 350), 60, true).story(), ElementsAre("swipe_up"));
}

TEST(Raise, IsOffUnlessAskedFor) {
    Stage stage;
    stage.play(raising(220), 60);
    EXPECT_EQ(stage.first(GestureType::raise, EventPhase::end), nullptr);
}

}  // namespace
}  // namespace xtrack::test
