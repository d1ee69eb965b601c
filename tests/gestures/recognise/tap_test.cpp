// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "tests/gestures/recognise/play_fingers.hpp"

namespace xtrack::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

GestureSettings taps() {
    GestureSettings settings;
    settings.tap = true;
    settings.grab = true;
    settings.swipe = false;
    return settings;
}

std::vector<Bent> tapping(double bent_deg = 130, double bends_ms = 120, double bent_ms = 100) {
    const double down = 1000 + bends_ms;
    const double up = down + bent_ms;
    return {pointing(0),
            pointing(1000),
            pointing(down, bent_deg),
            pointing(up, bent_deg),
            pointing(up + 150, 10),
            pointing(up + 600)};
}

std::vector<std::string> story_of(const std::vector<Bent>& moments, double fps = 60) {
    Stage stage(taps());
    play(stage, moments, fps);
    return stage.story();
}

TEST(Tap, IsKnownWhenTheFingerStraightensAgain) {
    Stage stage(taps());
    play(stage, tapping(), 60);
    EXPECT_THAT(stage.story(), ElementsAre("tap"));
    const GestureEvent* tap = stage.first(GestureType::tap, EventPhase::end);
    ASSERT_NE(tap, nullptr);
    EXPECT_NEAR(static_cast<double>(tap->onset.us()), 1.0e6, 0.06e6);
    EXPECT_NEAR(static_cast<double>(tap->sensor.us()), 1.3e6, 0.06e6);
    EXPECT_GT(tap->value, 400.0F) << "deg/s";
}

TEST(Tap, AtAnyFrameRate) {
    for (const double fps : {20.0, 30.0, 60.0, 120.0}) {
        EXPECT_THAT(story_of(tapping(), fps), ElementsAre("tap")) << fps;
    }
}

TEST(Tap, SurvivesNoiseOfTheJoints) {
    Stage stage(taps());
    play(stage, tapping(), 60, {}, 1.5);
    EXPECT_THAT(stage.story(), ElementsAre("tap"));
}

TEST(Tap, LittleOrSlowIsNone) {
    EXPECT_THAT(story_of(tapping(50)), IsEmpty());  // 42 degrees in the two inner joints, less 8
    EXPECT_THAT(story_of(tapping(130, 1200)), IsEmpty());
}

TEST(Tap, AFingerThatStaysBentIsNone) {
    EXPECT_THAT(story_of(tapping(130, 120, 2000)), IsEmpty());
    // Nor one that never straightens.
    std::vector<Bent> moments = tapping(130, 120, 3000);
    moments.resize(4);
    EXPECT_THAT(story_of(moments), IsEmpty());
}

/// An open hand whose index bends by 130 degrees in `bends_ms`, stays and straightens; the middle
/// finger goes along by `along_deg`.
Stage open_tap(double bends_ms, double stays_ms, double along_deg) {
    const double down = 1000 + bends_ms;
    std::vector<Bent> moments{open_hand(0),
                              open_hand(1000),
                              open_hand(down),
                              open_hand(down + stays_ms),
                              open_hand(down + stays_ms + 130),
                              open_hand(down + stays_ms + 700)};
    for (const std::size_t i : {2U, 3U}) {
        moments[i].deg[0] = 130;
        moments[i].deg[1] += along_deg;
    }
    Stage stage(taps());
    play(stage, moments, 60);
    return stage;
}

TEST(Tap, AnOpenHandTapsWithItsIndexAlone) {
    EXPECT_THAT(open_tap(120, 60, 0).story(), ElementsAre("tap"));
}

TEST(Tap, FingersOfAnOpenHandFidget) {
    const Stage slow = open_tap(500, 60, 0);
    EXPECT_THAT(slow.story(), IsEmpty());
    EXPECT_TRUE(slow.explained("tap", "slow for an open hand"));
    const Stage together = open_tap(120, 60, 50);
    EXPECT_THAT(together.story(), IsEmpty());
    EXPECT_TRUE(together.explained("tap", "another finger of an open hand moves"));
    const Stage mistaken = open_tap(60, 0, 0);
    EXPECT_THAT(mistaken.story(), IsEmpty());
    EXPECT_TRUE(mistaken.explained("tap", "too short for a finger"));
}

TEST(Tap, FingersThatGoAlongMakeSomethingElse) {
    std::vector<Bent> closes = tapping();
    for (std::size_t i : {0UL, 1UL, 4UL, 5UL}) {
        closes[i].deg = {10, 180, 180, 180};
    }
    closes[2].deg = closes[3].deg = {130, 255, 255, 255};
    Stage stage(taps());
    play(stage, closes, 60);
    EXPECT_THAT(stage.story(), IsEmpty());
    EXPECT_TRUE(stage.explained("tap", "another finger bends with it"));
}

TEST(Tap, APalmThatMovesAwayDrawsALetter) {
    std::vector<Bent> moments = tapping(130, 120, 300);
    for (std::size_t i = 3; i < moments.size(); ++i) {
        moments[i].palm_mm.y() -= 160.0F;
    }
    Stage stage(taps());
    play(stage, moments, 60);
    EXPECT_THAT(stage.story(), IsEmpty());
    EXPECT_TRUE(stage.explained("tap", "the palm moves"));
}

/// As a depth camera shows a pointing hand: one tip, above the palm, that leans to the screen.
Hand seen(double lean_deg, bool tip_known) {
    Hand hand;
    hand.id = 1;
    hand.confidence = 1.0F;
    hand.palm_mm = Vec3f{0.0F, 0.0F, 400.0F};
    hand.palm_radius_mm = 40.0F;
    hand.extended_fingers = 1;
    hand.finger_extension = {0.0F, 1.0F, 0.0F, 0.0F, 0.0F};
    TrackedPoint& tip = hand.fingertip(Finger::index);
    tip.valid = tip_known;
    const auto rad = static_cast<float>(lean_deg / 57.29578);
    tip.position_mm = hand.palm_mm + 90.0F * Vec3f{0.0F, std::cos(rad), -std::sin(rad)};
    return hand;
}

double lean_at(double ms) {
    return ms < 1000   ? 5.0
           : ms < 1100 ? 5.0 + 0.5 * (ms - 1000)
           : ms < 1400 ? 55.0
           : ms < 1500 ? 55.0 - 0.5 * (ms - 1400)
                       : 5.0;
}

TEST(Tap, OfACamerasHandLeansToTheScreen) {
    for (const double fps : {30.0, 60.0}) {
        Stage stage(taps());
        play(stage, 2000, fps, [](double ms) { return seen(lean_at(ms), true); });
        EXPECT_THAT(stage.story(), ElementsAre("tap")) << fps;
    }
}

TEST(Tap, ATipTakenForAnotherForAMomentIsNone) {
    Stage stage(taps());
    play(stage, 2000, 30, [](double ms) {
        return seen(ms > 1000 && ms < 1060 ? 60.0 : 5.0, ms < 1500 || ms > 1600);
    });
    EXPECT_THAT(stage.story(), IsEmpty());
}

}  // namespace
}  // namespace xtrack::test
