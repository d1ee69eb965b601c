// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "tests/gestures/recognise/play_hand.hpp"

namespace xtrack::test {
namespace {

using ::testing::ElementsAre;

Vec3f at(float x, float y = 0.0F, float z = 400.0F) { return {x, y, z}; }

GestureSettings dragging() {
    GestureSettings s;
    s.swipe = s.push = false;
    s.drag = true;
    return s;
}

/// Pinches at 1 s and then does what `rest` says.
Actor pinching(const std::vector<At>& rest) {
    Actor actor{{{0, at(0), 75}, {800, at(0), 75}, {950, at(0), 12}, {1300, at(0), 12}}};
    actor.moments.insert(actor.moments.end(), rest.begin(), rest.end());
    return actor;
}

TEST(Drag, APinchThatMovesBecomesADrag) {
    Stage stage(dragging());
    stage.play(
        pinching(
            {{2300, at(150), 12}, {2600, at(150), 12}, {2800, at(150), 75}, {3200, at(150), 75}}),
        60);
    EXPECT_THAT(stage.story(),
                ElementsAre("pinch begin", "pinch cancel superseded", "drag begin", "drag end"));
    const GestureEvent* end = stage.first(GestureType::drag, EventPhase::end);
    EXPECT_NEAR(end->value, 150.0F, 3.0F);
    EXPECT_GE(end->sensor, Stamp::from_us(2'600'000)) << "it ends when the fingers open";
}

TEST(Drag, APinchThatStaysIsAPinch) {
    Stage stage(dragging());
    stage.play(pinching({{2300, at(20), 12}, {2500, at(20), 75}, {3000, at(20), 75}}), 60);
    EXPECT_THAT(stage.story(), ElementsAre("pinch begin", "pinch end"));
}

TEST(Drag, OfFiveSecondsSurvives) {
    Stage stage(dragging());
    Actor actor = pinching(
        {{1800, at(100), 12}, {6800, at(100), 12}, {7000, at(100), 75}, {7300, at(100), 75}});
    actor.noise_mm = 2.0;
    stage.play(actor, 60);
    EXPECT_THAT(stage.story(),
                ElementsAre("pinch begin", "pinch cancel superseded", "drag begin", "drag end"));
}

TEST(Drag, FingersThatAreLostCancel) {
    Stage stage(dragging());
    stage.play(
        pinching({{2000, at(100), 12}, {2001, at(100), 12, false}, {2600, at(100), 12, false}}),
        60);
    EXPECT_THAT(stage.story(), ElementsAre("pinch begin", "pinch cancel superseded", "drag begin",
                                           "drag cancel lost"));
}

TEST(Drag, TheBorderCancels) {
    Stage stage(dragging());
    stage.play(pinching({{2000, at(100), 12},
                         {2001, at(100), 12, true, true},
                         {2600, at(100), 12, true, true}}),
               60);
    EXPECT_THAT(stage.story(), ElementsAre("pinch begin", "pinch cancel superseded", "drag begin",
                                           "drag cancel edge"));
}

TEST(Drag, NeedsSomethingToGoOnFrom) {
    GestureSettings alone = dragging();
    alone.pinch = alone.grab = false;
    const auto refused = validate(alone);
    ASSERT_FALSE(refused);
    EXPECT_THAT(refused.error().message, ::testing::HasSubstr("drag is on; switch pinch"));
}

TEST(Drag, SwitchedOffWhileItRunsIsCancelled) {
    Stage stage(dragging());
    stage.play(pinching({{2000, at(100), 12}}), 60);
    GestureSettings without = dragging();
    without.drag = false;
    stage.keep(*stage.recogniser.set_settings(without));
    EXPECT_THAT(stage.story(), ElementsAre("pinch begin", "pinch cancel superseded", "drag begin",
                                           "drag cancel disengaged"));
}

}  // namespace
}  // namespace xtrack::test
