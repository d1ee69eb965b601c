// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "tests/gestures/recognise/play_hand.hpp"

namespace xtrack::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

Vec3f at(float x, float y = 0.0F, float z = 400.0F) { return {x, y, z}; }

Actor swipe(float grab) {
    Actor actor{{{0, at(150)}, {1500, at(150)}, {1850, at(-150)}, {3000, at(-150)}}};
    actor.grab = grab;
    return actor;
}

GestureSettings swipes() {
    GestureSettings s;
    s.push = s.pinch = s.grab = false;
    s.swipe_grab = 1.0;  // a fist would not swipe anyway
    return s;
}

TEST(Silence, AFistSaysNothing) {
    Stage stage(swipes());
    stage.play(swipe(0.9F), 60);
    EXPECT_THAT(stage.story(), IsEmpty());
    EXPECT_TRUE(std::ranges::any_of(stage.trace, [](const RecogniserTrace& line) {
        return line.machine == std::string{"silence"} && line.to == std::string{"silent"};
    }));
}

TEST(Silence, AHalfClosedHandSpeaks) {
    Stage stage(swipes());
    stage.play(swipe(0.7F), 60);
    EXPECT_THAT(stage.story(), ElementsAre("swipe_left"));
}

TEST(Silence, IsOffWhereAFistMeansSomething) {
    GestureSettings s = swipes();
    s.fist = true;
    Stage stage(s);
    stage.play(swipe(0.9F), 60);
    EXPECT_THAT(stage.story(), ::testing::Contains("swipe_left"));
}

TEST(Silence, OpensAgain) {
    Stage stage(swipes());
    Actor fist{{{0, at(0)}, {1500, at(0)}}};
    fist.grab = 0.9F;
    stage.play(fist, 60);
    Actor open{{{1517, at(0)}, {2200, at(0)}, {2550, at(300)}, {3000, at(300)}}};
    stage.play(open, 60);
    EXPECT_THAT(stage.story(), ElementsAre("swipe_right"));
}

TEST(Silence, DoesNotCutWhatIsActive) {
    GestureSettings s;
    s.swipe = s.push = s.grab = false;
    Stage stage(s);
    Actor pinching{{{0, at(0), 75}, {800, at(0), 75}, {950, at(0), 12}, {1200, at(0), 12}}};
    stage.play(pinching, 60);
    Actor closed{{{1217, at(0), 12}, {3000, at(0), 12}, {3200, at(0), 75}, {3500, at(0), 75}}};
    closed.grab = 0.9F;  // a pinch with curled fingers looks like a fist
    stage.play(closed, 60);
    EXPECT_THAT(stage.story(), ElementsAre("pinch begin", "pinch end"));
}

}  // namespace
}  // namespace xtrack::test
