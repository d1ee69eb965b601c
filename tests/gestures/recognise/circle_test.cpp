// SPDX-License-Identifier: Apache-2.0
#include <numbers>

#include <gmock/gmock.h>

#include "tests/gestures/recognise/play_fingers.hpp"

namespace xtrack::test {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Not;

struct Round {
    double turns = 1.0;      ///< positive is counterclockwise
    double radius_mm = 120;  ///< to the user's right, and
    double upward_mm = 120;  ///< upward: an ellipse where they differ
    double turn_ms = 1000;
    double noise_mm = 0.0;
    double pause_after = -1.0;  ///< turns; then a second of rest
};

/// Rests for a second, goes round, rests.
Vec3f on_the_way(const Round& r, double ms) {
    const double all_ms = std::abs(r.turns) * r.turn_ms;
    double gone_ms = ms - 1000;
    if (r.pause_after >= 0.0) {
        const double pause_ms = r.pause_after * r.turn_ms;
        gone_ms = gone_ms > pause_ms ? std::max(pause_ms, gone_ms - 1000) : gone_ms;
    }
    gone_ms = std::clamp(gone_ms, 0.0, all_ms);
    const double rad = 2.0 * std::numbers::pi * (r.turns > 0 ? 1.0 : -1.0) * gone_ms / r.turn_ms;
    return {static_cast<float>(r.radius_mm * std::cos(rad)),
            static_cast<float>(r.upward_mm * std::sin(rad)), 400.0F};
}

GestureSettings circles() {
    GestureSettings settings;
    settings.circle = true;
    settings.swipe = false;
    return settings;
}

std::vector<std::string> story_of(const Round& r, double fps = 60) {
    Stage stage(circles());
    Noise noise(5);
    play(stage, 2000 + std::abs(r.turns) * r.turn_ms + (r.pause_after >= 0 ? 1000 : 0), fps,
         [&](double ms) {
             Actor actor;
             return hand_of(
                 actor,
                 At{ms, on_the_way(r, ms) + Vec3f{noise(r.noise_mm), noise(r.noise_mm), 0.0F}},
                 noise);
         });
    return stage.story();
}

TEST(Circle, IsKnownAfterThreeQuartersOfATurn) {
    Stage stage(circles());
    Noise noise(5);
    const Round round{1.0};
    play(stage, 3000, 60, [&](double ms) {
        return hand_of(Actor{}, At{ms, on_the_way(round, ms)}, noise);
    });
    ASSERT_THAT(stage.story(), ElementsAre("circle_counterclockwise"));
    const GestureEvent* circle = stage.first(GestureType::circle, EventPhase::end);
    EXPECT_NEAR(static_cast<double>(circle->sensor.us()), 1.76e6, 0.05e6);
    EXPECT_NEAR(static_cast<double>(circle->onset.us()), 1.0e6, 0.1e6);
    EXPECT_NEAR(circle->value, 0.76F, 0.03F);
}

TEST(Circle, GoesTheWayTheUserSees) {
    EXPECT_THAT(story_of({1.0}), ElementsAre("circle_counterclockwise"));
    EXPECT_THAT(story_of({-1.0}), ElementsAre("circle_clockwise"));
}

TEST(Circle, EachFurtherTurnIsAnother) {
    EXPECT_THAT(story_of({-1.9}), ElementsAre("circle_clockwise"));
    EXPECT_THAT(story_of({-2.1}), ElementsAre("circle_clockwise", "circle_clockwise"));
    EXPECT_EQ(story_of({4.1}).size(), 4U);
}

TEST(Circle, AtAnyFrameRateSizeAndNoise) {
    for (const double fps : {20.0, 30.0, 60.0, 120.0}) {
        for (const double radius_mm : {60.0, 150.0, 350.0}) {
            EXPECT_THAT(story_of({-1.0, radius_mm, radius_mm, 1500, 2.0}, fps),
                        ElementsAre("circle_clockwise"))
                << fps << " " << radius_mm;
        }
    }
}

TEST(Circle, HalfATurnIsNone) { EXPECT_THAT(story_of({0.6}), Not(Contains("circle_clockwise"))); }

TEST(Circle, TooSmallOrTooFlatIsNone) {
    EXPECT_THAT(story_of({2.0, 25, 25}), IsEmpty());
    for (const std::string& event : story_of({2.0, 200, 50})) {
        EXPECT_THAT(event, Not(::testing::StartsWith("circle"))) << "an ellipse";
    }
}

TEST(Circle, APauseEndsIt) {
    EXPECT_THAT(story_of({1.2, 120, 120, 1500, 0.0, 0.6}), IsEmpty());
    // After the first it takes three quarters of a turn anew.
    EXPECT_THAT(story_of({1.7, 120, 120, 1500, 0.0, 0.8}),
                ElementsAre("circle_counterclockwise", "circle_counterclockwise"));
}

TEST(Circle, ItsStrokesAreNoSwipes) {
    // 900 mm/s: fast enough for swipes, in every turn. Before it is a circle nobody can tell.
    GestureSettings settings = circles();
    settings.swipe = true;
    Stage stage(settings);
    Noise noise(5);
    play(stage, 6000, 60, [&](double ms) {
        return hand_of(Actor{}, At{ms, on_the_way({-4.1, 150, 150, 1050}, ms)}, noise);
    });
    std::vector<std::string> story = stage.story();
    story.erase(story.begin(), std::ranges::find(story, "circle_clockwise"));
    EXPECT_THAT(story, ElementsAre("circle_clockwise", "circle_clockwise", "circle_clockwise",
                                   "circle_clockwise"));
}

TEST(Circle, WavesAndSwipesAreNone) {
    GestureSettings settings = circles();
    settings.wave = true;
    Stage stage(settings);
    Actor actor{{{0, Vec3f{0, 0, 400}}, {1000, Vec3f{0, 0, 400}}}};
    for (int i = 0; i < 10; ++i) {
        actor.moments.push_back(
            {1250.0 + 250 * i,
             Vec3f{i % 2 == 0 ? 120.0F : 0.0F, 10.0F * static_cast<float>(i % 3), 400.0F}});
    }
    stage.play(actor, 60);
    EXPECT_THAT(stage.story(), Contains("wave"));
    for (const std::string& event : stage.story()) {
        EXPECT_THAT(event, Not(::testing::StartsWith("circle")));
    }
}

TEST(Circle, AFingerThatPointsDrawsASmallOne) {
    // The palm stays; the index tip goes round 50 mm.
    Stage stage(circles());
    Noise noise(5);
    play(stage, 3200, 60, [&](double ms) {
        Hand hand = hand_of(pointing(ms), Posture{}, noise);
        const Vec3f way = on_the_way({-1.0, 50, 50}, ms);
        hand.joint(Joint::index_tip).position_mm += Vec3f{way.x(), way.y(), 0.0F};
        hand.fingertip(Finger::index).position_mm = hand.joint(Joint::index_tip).position_mm;
        hand.finger_extension[static_cast<std::size_t>(Finger::index)] = 1.0F;
        return hand;
    });
    EXPECT_THAT(stage.story(), ElementsAre("circle_clockwise"));
}

}  // namespace
}  // namespace xtrack::test
