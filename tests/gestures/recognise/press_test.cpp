// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "tests/gestures/recognise/play_hand.hpp"

namespace xtrack::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

Vec3f at(float x, float y = 0.0F, float z = 400.0F) { return {x, y, z}; }

GestureSettings pressing() {
    GestureSettings s;
    s.swipe = s.push = s.pinch = false;
    s.press = true;
    return s;
}

class PressRate : public ::testing::TestWithParam<double> {};

TEST_P(PressRate, APokeIsOneClick) {
    for (const double noise_mm : {0.0, 2.0}) {
        Stage stage(pressing());
        Actor actor{{{0, at(0)},
                     {1000, at(0)},
                     {1250, at(0, 0, 340)},
                     {1550, at(0, 0, 340)},
                     {1800, at(0, 0, 400)},
                     {2600, at(0, 0, 400)}}};
        actor.noise_mm = noise_mm;
        stage.play(actor, GetParam());
        EXPECT_THAT(stage.story(), ElementsAre("press begin", "press end"))
            << noise_mm << " mm at " << GetParam();
        const GestureEvent* down = stage.first(GestureType::press, EventPhase::begin);
        ASSERT_NE(down, nullptr);
        EXPECT_LE(down->sensor, Stamp::from_us(1'300'000));
        const GestureEvent* up = stage.first(GestureType::press, EventPhase::end);
        EXPECT_GE(up->sensor, Stamp::from_us(1'550'000)) << "it stayed, and chattered";
    }
}

INSTANTIATE_TEST_SUITE_P(Rates, PressRate, ::testing::Values(30.0, 60.0, 120.0));

TEST(Press, TheSlowerTheLongerTheWay) {
    const auto way_mm = [](double mmps) {
        Stage stage(pressing());
        const auto ms = 200.0 / mmps * 1e3;
        // Even speed: many short moves of minimum jerk.
        Actor actor{{{0, at(0, 0, 500)}}};
        for (int i = 0; i <= 100; ++i) {
            actor.moments.push_back(
                {500 + ms * i / 100.0, at(0, 0, 500.0F - 2.0F * static_cast<float>(i))});
        }
        stage.play(actor, 120);
        const GestureEvent* down = stage.first(GestureType::press, EventPhase::begin);
        return down == nullptr ? 1e9 : 500.0 - static_cast<double>(down->position_mm.z());
    };
    EXPECT_EQ(way_mm(100.0), 1e9) << "below the least speed";
    const double slow_mm = way_mm(200.0);
    const double fast_mm = way_mm(600.0);
    EXPECT_LT(slow_mm, 80.0);
    // 8 mm, after the velocity is known.
    EXPECT_LT(fast_mm, slow_mm);
}

TEST(Press, ASidewaysMovementIsNone) {
    Stage stage(pressing());
    stage.play(
        Actor{{{0, at(-100)}, {600, at(-100)}, {1000, at(100, 0, 360)}, {1500, at(100, 0, 360)}}},
        60);
    EXPECT_THAT(stage.story(), IsEmpty());
    EXPECT_TRUE(stage.explained("press", "off the normal"));
}

TEST(Press, ASlantedOneIsOneClick) {
    // 18 degrees off the normal, and still deeper after it is down.
    Stage stage(pressing());
    stage.play(Actor{{{0, at(0)},
                      {1000, at(0)},
                      {1450, at(58, 0, 220)},
                      {1750, at(58, 0, 220)},
                      {3000, at(0)},
                      {3800, at(0)}}},
               60);
    ASSERT_THAT(stage.story(), ElementsAre("press begin", "press end"));
    EXPECT_GE(stage.first(GestureType::press, EventPhase::end)->sensor, Stamp::from_us(1'750'000))
        << "it let up while it went on";
    // A steeper one is none.
    Stage aside(pressing());
    aside.play(Actor{{{0, at(0)}, {1000, at(0)}, {1450, at(90, 0, 220)}, {1750, at(90, 0, 220)}}},
               60);
    EXPECT_THAT(aside.story(), IsEmpty());
}

TEST(Press, SlidingAsideLetsUpEvenWhereItCreepsDeeper) {
    Stage stage(pressing());
    stage.play(Actor{{{0, at(0)},
                      {1000, at(0)},
                      {1300, at(0, 0, 300)},
                      {2100, at(200, 0, 295)},
                      {3800, at(200, 0, 295)}}},
               60);
    ASSERT_THAT(stage.story(), ElementsAre("press begin", "press end"));
    // A tenth of 50 mm aside.
    EXPECT_LE(stage.first(GestureType::press, EventPhase::end)->sensor, Stamp::from_us(1'700'000));
}

TEST(Press, ComesUpByItself) {
    Stage stage(pressing());
    stage.play(Actor{{{0, at(0)}, {600, at(0)}, {800, at(0, 0, 340)}, {4000, at(0, 0, 340)}}}, 60);
    ASSERT_THAT(stage.story(), ElementsAre("press begin", "press end"));
    const GestureEvent* down = stage.first(GestureType::press, EventPhase::begin);
    const GestureEvent* up = stage.first(GestureType::press, EventPhase::end);
    EXPECT_NEAR(to_seconds(up->sensor - down->sensor), 1.5, 0.03);
}

TEST(Press, ForceIsToldBeforeItIsDown) {
    Stage stage(pressing());
    stage.play(Actor{{{0, at(0)}, {600, at(0)}, {900, at(0, 0, 360)}, {910, at(0, 0, 360)}}}, 60);
    EXPECT_THAT(stage.story(), IsEmpty());
    EXPECT_GT(stage.recogniser.progress(1, GestureType::press), 0.1);
    EXPECT_LT(stage.recogniser.progress(1, GestureType::press), 1.0);
    EXPECT_EQ(stage.recogniser.progress(7, GestureType::press), 0.0);
}

TEST(Press, LossCancels) {
    Stage stage(pressing());
    stage.play(Actor{{{0, at(0)},
                      {600, at(0)},
                      {800, at(0, 0, 340)},
                      {900, at(0, 0, 340)},
                      {901, at(0, 0, 340), 70, false},
                      {1500, at(0, 0, 340), 70, false}}},
               60);
    EXPECT_THAT(stage.story(), ElementsAre("press begin", "press cancel lost"));
}

TEST(Press, SilencesThePushThatItIs) {
    GestureSettings both = pressing();
    both.push = true;
    Stage stage(both);
    stage.play(Actor{{{0, at(0)}, {1000, at(0)}, {1400, at(0, 0, 180)}, {3000, at(0, 0, 180)}}},
               60);
    EXPECT_THAT(stage.story(), ElementsAre("press begin", "press end"));
}

}  // namespace
}  // namespace xtrack::test
