// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "tests/gestures/recognise/play_hand.hpp"

namespace xtrack::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

Vec3f at(float x, float y = 0.0F, float z = 400.0F) { return {x, y, z}; }

GestureSettings dwelling() {
    GestureSettings s;
    s.swipe = s.push = s.pinch = false;
    s.dwell = true;
    return s;
}

class DwellRate : public ::testing::TestWithParam<double> {};

TEST_P(DwellRate, AHandThatStaysFillsAndEndsOnce) {
    Stage stage(dwelling());
    Actor actor{{{0, at(100)}, {600, at(0)}, {3600, at(0)}}};
    actor.noise_mm = 2.0;
    stage.play(actor, GetParam());
    ASSERT_THAT(stage.story(), ElementsAre("dwell begin", "dwell end"));
    const GestureEvent* begin = stage.first(GestureType::dwell, EventPhase::begin);
    const GestureEvent* end = stage.first(GestureType::dwell, EventPhase::end);
    EXPECT_NEAR(to_seconds(end->sensor - begin->sensor), 0.6, 0.07);
    // Not before it has been still for half a second.
    EXPECT_GE(begin->sensor, Stamp::from_us(950'000));
    EXPECT_LE(begin->sensor, Stamp::from_us(1'700'000));
    EXPECT_FLOAT_EQ(end->progress, 1.0F);
}

INSTANTIATE_TEST_SUITE_P(Rates, DwellRate, ::testing::Values(20.0, 30.0, 60.0, 120.0));

TEST(Dwell, LeavingCancels) {
    Stage stage(dwelling());
    stage.play(Actor{{{0, at(0)}, {900, at(0)}, {1200, at(40)}, {1300, at(40)}}}, 60);
    EXPECT_THAT(stage.story(), ElementsAre("dwell begin", "dwell cancel superseded"));
    EXPECT_TRUE(stage.explained("dwell", "it left"));
}

TEST(Dwell, TheSamePlaceIsSpentUntilItIsLeft) {
    Stage stage(dwelling());
    stage.play(Actor{{{0, at(0)},
                      {2000, at(0)},
                      {2300, at(15)},  // inside the 20 mm
                      {4000, at(15)},
                      {4300, at(60)},
                      {6000, at(60)}}},
               60);
    EXPECT_THAT(stage.story(), ElementsAre("dwell begin", "dwell end", "dwell begin", "dwell end"));
}

TEST(Dwell, TheWayToTheScreenDoesNotCount) {
    Stage stage(dwelling());
    stage.play(Actor{{{0, at(0)}, {2500, at(0, 0, 330)}}}, 60);
    EXPECT_THAT(stage.story(), ElementsAre("dwell begin", "dwell end"));
}

TEST(Dwell, LossCancels) {
    Stage stage(dwelling());
    stage.play(Actor{{{0, at(0)}, {900, at(0)}, {901, at(0), 70, false}, {1500, at(0), 70, false}}},
               60);
    EXPECT_THAT(stage.story(), ElementsAre("dwell begin", "dwell cancel lost"));
}

TEST(Dwell, IsOffUnlessAskedFor) {
    Stage stage;
    stage.play(Actor{{{0, at(0)}, {3000, at(0)}}}, 60);
    EXPECT_THAT(stage.story(), IsEmpty());
}

}  // namespace
}  // namespace xtrack::test
