// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "tests/gestures/recognise/play_fingers.hpp"

namespace xtrack::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

GestureSettings grabs() {
    GestureSettings settings;
    settings.grab = true;
    settings.tap = true;
    return settings;
}

std::vector<Bent> grabbing(double closing_ms = 300) {
    return {open_hand(0),
            open_hand(800),
            fist(800 + closing_ms),
            fist(1700 + closing_ms),
            open_hand(2000 + closing_ms),
            open_hand(2500 + closing_ms)};
}

std::vector<std::string> story_of(const std::vector<Bent>& moments, double fps = 60,
                                  const Posture& posture = {}) {
    Stage stage(grabs());
    play(stage, moments, fps, posture);
    return stage.story();
}

TEST(Grab, BeginsUpdatesAndEnds) {
    Stage stage(grabs());
    play(stage, grabbing(), 60);
    EXPECT_THAT(stage.story(), ElementsAre("grab begin", "grab end"));
    const GestureEvent* begin = stage.first(GestureType::grab, EventPhase::begin);
    const GestureEvent* update = stage.first(GestureType::grab, EventPhase::update);
    const GestureEvent* end = stage.first(GestureType::grab, EventPhase::end);
    ASSERT_NE(begin, nullptr);
    ASSERT_NE(update, nullptr);
    EXPECT_EQ(begin->gesture_id, update->gesture_id);
    EXPECT_EQ(begin->gesture_id, end->gesture_id);
    EXPECT_GE(begin->value, 0.8F);
    EXPECT_LE(end->value, 0.65F);
    EXPECT_LT(begin->onset, begin->sensor);
    // Closed at about 1000 ms, held for 100.
    EXPECT_NEAR(static_cast<double>(begin->sensor.us()), 1.1e6, 0.06e6);
}

TEST(Grab, AtAnyFrameRateAndSize) {
    for (const double fps : {15.0, 20.0, 30.0, 60.0, 120.0}) {
        for (const float size : {0.65F, 1.0F, 1.2F}) {
            Posture posture;
            posture.size = size;
            EXPECT_THAT(story_of(grabbing(), fps, posture), ElementsAre("grab begin", "grab end"))
                << fps << " " << size;
        }
    }
}

TEST(Grab, SurvivesNoiseOfTheJoints) {
    Stage stage(grabs());
    play(stage, grabbing(), 60, {}, 2.0);
    EXPECT_THAT(stage.story(), ElementsAre("grab begin", "grab end"));
}

TEST(Grab, AHandThatEntersAsAFistDoesNot) {
    EXPECT_THAT(story_of({fist(0), fist(2500)}), IsEmpty());
    // Nor one that opens: a comparison backwards would begin there.
    EXPECT_THAT(story_of({fist(0), fist(1000), open_hand(1300), open_hand(2500)}), IsEmpty());
    // Once it has been open it may.
    EXPECT_THAT(
        story_of({fist(0), fist(1000), open_hand(1300), open_hand(2000), fist(2300), fist(3000)}),
        ElementsAre("grab begin"));
}

TEST(Grab, ClosingSlowlyIsNone) { EXPECT_THAT(story_of(grabbing(3500)), IsEmpty()); }

TEST(Grab, HalfClosedIsNone) {
    EXPECT_THAT(story_of({open_hand(0), open_hand(800), Bent{1100, {140, 140, 140, 140}, 0.0},
                          Bent{2500, {140, 140, 140, 140}, 0.0}}),
                IsEmpty());
}

TEST(Grab, HysteresisKeepsItThroughNoise) {
    std::vector<Bent> moments{open_hand(0), open_hand(800), fist(1100)};
    for (int i = 0; i < 8; ++i) {
        moments.push_back({1300.0 + 200 * i, {150, 150, 150, 150}, 0.0});  // strength 0.71
        moments.push_back(fist(1400.0 + 200 * i));
    }
    moments.push_back(open_hand(3200));
    moments.push_back(open_hand(3500));
    EXPECT_THAT(story_of(moments), ElementsAre("grab begin", "grab end"));
}

TEST(Grab, AThumbThatStandsOffIsNone) {
    Bent thumb_up = fist(1100);
    thumb_up.thumb = 1.0;
    Bent later = thumb_up;
    later.ms = 2500;
    Stage stage(grabs());
    play(stage, {open_hand(0), open_hand(800), thumb_up, later}, 60);
    EXPECT_THAT(stage.story(), IsEmpty());
    EXPECT_TRUE(stage.explained("grab", "the thumb stands off"));
}

TEST(Grab, APointingHandThatBendsItsIndexDoesNot) {
    Stage stage(grabs());
    play(stage,
         {open_hand(0), open_hand(800), pointing(1000), pointing(1150), fist(1300), fist(2600)},
         60);
    EXPECT_THAT(stage.story(), IsEmpty());
    EXPECT_TRUE(stage.explained("grab", "the hand points"));
}

TEST(Grab, NotWhileThePalmMovesFast) {
    GestureSettings settings = grabs();
    settings.swipe = false;
    Stage stage(settings);
    Noise noise(11);
    play(stage, 2500, 60, [&](double ms) {
        Bent bent = between(grabbing(), ms);
        bent.palm_mm.x() += static_cast<float>(0.4 * ms);
        return hand_of(bent, Posture{}, noise);
    });
    EXPECT_THAT(stage.story(), IsEmpty());
    EXPECT_TRUE(stage.explained("grab", "the palm moves"));
}

TEST(Grab, LosesItsHandAndIsCancelledByTheClock) {
    std::vector<Bent> moments = grabbing();
    moments.resize(4);
    Stage stage(grabs());
    play(stage, moments, 60);
    ASSERT_THAT(stage.story(), ElementsAre("grab begin"));
    const std::int64_t last_us = stage.events.back().sensor.us();
    stage.keep(stage.recogniser.advance(Stamp::from_us(last_us + 100'000)));
    EXPECT_THAT(stage.story(), ElementsAre("grab begin"));
    stage.keep(stage.recogniser.advance(Stamp::from_us(last_us + 120'000)));
    EXPECT_THAT(stage.story(), ElementsAre("grab begin", "grab cancel lost"));
}

TEST(Grab, TheEndOfTheStreamEndsIt) {
    std::vector<Bent> moments = grabbing();
    moments.resize(4);
    Stage stage(grabs());
    play(stage, moments, 60);
    stage.keep(stage.recogniser.finish());
    EXPECT_THAT(stage.story(), ElementsAre("grab begin", "grab end"));
}

TEST(Grab, HoldsTheHand) {
    // What moves now is dragged.
    std::vector<Bent> moments = grabbing();
    moments[3].ms = 2000;
    moments.resize(4);
    moments.push_back(moments[3]);
    moments[4].ms = 2400;
    moments[4].palm_mm.x() += 300.0F;
    Stage stage(grabs());
    play(stage, moments, 60);
    EXPECT_THAT(stage.story(), ElementsAre("grab begin"));
}

}  // namespace
}  // namespace xtrack::test
