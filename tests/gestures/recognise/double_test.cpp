// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "tests/gestures/recognise/play_fingers.hpp"

namespace xtrack::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// Pinches that begin so long after one another.
Actor pinches(int count, double apart_ms) {
    const Vec3f rest{0.0F, 0.0F, 400.0F};
    Actor actor{{{0, rest, 75}, {900, rest, 75}}};
    for (int i = 0; i < count; ++i) {
        const double begin_ms = 900 + apart_ms * i;
        actor.moments.push_back({begin_ms + 60, rest, 10});
        actor.moments.push_back({begin_ms + 200, rest, 10});
        actor.moments.push_back({begin_ms + 280, rest, 75});
    }
    actor.moments.push_back({actor.moments.back().ms + 800, rest, 75});
    return actor;
}

std::vector<std::string> doubles_of(const Actor& actor, bool single) {
    GestureSettings settings;
    settings.pinch = single;
    settings.double_pinch = true;
    Stage stage(settings);
    stage.play(actor, 60);
    return stage.story();
}

TEST(DoublePinch, IsTwoPinchesShortlyAfterEachOther) {
    EXPECT_THAT(
        doubles_of(pinches(2, 400), true),
        ElementsAre("pinch begin", "pinch end", "pinch begin", "double_pinch", "pinch end"));
}

TEST(DoublePinch, NeedsNoPinchesToBeAskedFor) {
    EXPECT_THAT(doubles_of(pinches(2, 400), false), ElementsAre("double_pinch"));
}

TEST(DoublePinch, OneAloneAndTwoFarApartAreNone) {
    EXPECT_THAT(doubles_of(pinches(1, 400), false), IsEmpty());
    EXPECT_THAT(doubles_of(pinches(2, 700), false), IsEmpty());
}

TEST(DoublePinch, ThreeAreOneAndAHalf) {
    EXPECT_THAT(doubles_of(pinches(3, 400), false), ElementsAre("double_pinch"));
    EXPECT_THAT(doubles_of(pinches(4, 400), false), ElementsAre("double_pinch", "double_pinch"));
}

TEST(DoublePinch, IsOffUnlessAskedFor) {
    Stage stage;
    stage.play(pinches(2, 400), 60);
    EXPECT_EQ(stage.first(GestureType::double_pinch, EventPhase::end), nullptr);
}

TEST(DoubleTap, IsTwoTapsShortlyAfterEachOther) {
    GestureSettings settings;
    settings.tap = false;
    settings.double_tap = true;
    Stage stage(settings);
    std::vector<Bent> moments{pointing(0), pointing(1000)};
    for (int i = 0; i < 2; ++i) {
        const double begin_ms = 1000 + 400.0 * i;
        moments.push_back(pointing(begin_ms + 100, 140));
        moments.push_back(pointing(begin_ms + 160, 140));
        moments.push_back(pointing(begin_ms + 260));
        moments.push_back(pointing(begin_ms + 400));
    }
    play(stage, moments, 60);
    EXPECT_THAT(stage.story(), ElementsAre("double_tap"));
}

}  // namespace
}  // namespace xtrack::test
