// SPDX-License-Identifier: Apache-2.0
//
// Hands as a depth camera shows them: no joints, fingertips that come and go, a border.
#include <algorithm>
#include <functional>

#include <gmock/gmock.h>

#include "tests/gestures/recognise/play_hand.hpp"

namespace xtrack::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr double kFps = 60.0;
using Change = std::function<void(int frame, double ms, Hand& hand)>;

/// Plays an actor after `change` has had its way with every hand.
void play(Stage& stage, const Actor& actor, const Change& change,
          Duration span = Duration::zero()) {
    Noise noise(3);
    const double to_ms = actor.moments.back().ms;
    for (int i = 0; i * 1000.0 / kFps <= to_ms; ++i) {
        const double ms = i * 1000.0 / kFps;
        const At at = actor.where(ms);
        HandFrame frame;
        frame.stamp = Stamp{static_cast<std::int64_t>(ms * 1e6)};
        frame.span = span;
        frame.coordinates = CoordinateFrame::interaction;
        if (at.seen) {
            frame.hands[0] = hand_of(actor, at, noise);
            frame.count = 1;
            change(i, ms, frame.hands[0]);
        }
        stage.keep(stage.recogniser.push(frame));
    }
}

/// Fingers stretched upward; the middle one reaches 100 mm over the palm's true place.
void stretch_up(Hand& hand, const Vec3f& true_palm_mm) {
    for (const Finger f : {Finger::index, Finger::middle, Finger::ring, Finger::little}) {
        const auto k = static_cast<std::size_t>(f);
        hand.fingertips[k].valid = true;
        hand.fingertips[k].position_mm =
            true_palm_mm +
            Vec3f{20.0F * (static_cast<float>(k) - 2.0F), k == 2 ? 100.0F : 85.0F, 0};
        hand.finger_extension[k] = 1.0F;
    }
}

Vec3f at(float x, float y) { return {x, y, 400.0F}; }

TEST(CameraHand, AFingerThatIsNotFoundIsNotFolded) {
    Stage stage;
    // A hand that points would have to go 150 mm; this one loses fingers in the stroke.
    const Actor actor{{{0, at(70, 0)}, {800, at(70, 0)}, {1100, at(-70, 0)}, {1700, at(-70, 0)}}};
    play(stage, actor, [](int, double ms, Hand& hand) {
        const float others = ms < 800.0 ? 1.0F : 0.0F;
        hand.finger_extension = {0.0F, 1.0F, others, others, others};
    });
    EXPECT_THAT(stage.story(), ElementsAre("swipe_left"));
}

TEST(CameraHand, AFistThatIsCarriedDoesNotSwipe) {
    const Actor actor{{{0, at(70, 0)}, {800, at(70, 0)}, {1100, at(-70, 0)}, {1700, at(-70, 0)}}};
    const auto with_extension = [&](float extension, double least) {
        GestureSettings settings;
        settings.swipe_open = least;
        Stage stage(settings);
        play(stage, actor, [&](int, double, Hand& hand) {
            hand.finger_extension = {0.0F, extension, extension, extension, extension};
        });
        EXPECT_EQ(stage.explained("swipe", "the hand is closed"), stage.story().empty());
        return stage.story();
    };
    EXPECT_THAT(with_extension(0.3F, 0.4), IsEmpty());
    EXPECT_THAT(with_extension(0.5F, 0.4), ElementsAre("swipe_left"));
    EXPECT_THAT(with_extension(0.3F, 0.0), ElementsAre("swipe_left"));
}

TEST(CameraHand, TheWayInFromTheBorderIsNoSwipe) {
    Actor actor{{{0, at(-260, 0)}, {600, at(-260, 0)}, {1000, at(20, 0)}, {1500, at(20, 0)}}};
    const Change border = [](int, double ms, Hand& hand) { hand.touches_border = ms < 730; };
    Stage stage;
    play(stage, actor, border);
    EXPECT_THAT(stage.story(), IsEmpty());
    EXPECT_TRUE(stage.explained("swipe", "on its way in"));

    actor.moments.push_back({1900, at(-230, 0)});
    actor.moments.push_back({2300, at(-230, 0)});
    Stage then;
    play(then, actor, border);
    EXPECT_THAT(then.story(), ElementsAre("swipe_left"));
}

TEST(CameraHand, AWayInThatTurnsIsOver) {
    // Up from the border, then left without a rest.
    const Actor actor{{{0, at(100, -200)},
                       {400, at(100, -200)},
                       {700, at(80, -40)},
                       {1080, at(-190, -30)},
                       {1600, at(-190, -30)}}};
    Stage stage;
    play(stage, actor, [](int, double ms, Hand& hand) { hand.touches_border = ms < 540; });
    EXPECT_THAT(stage.story(), ElementsAre("swipe_left"));
}

TEST(CameraHand, LeavingDownwardIsNoSwipe) {
    Stage stage;
    // The palm is last seen in the middle of the movement, at its fastest.
    Actor actor{{{0, at(0, 0)}, {800, at(0, 0)}, {2000, at(0, -480)}, {2500, at(0, -480)}}};
    play(stage, actor, [](int, double ms, Hand& hand) {
        stretch_up(hand, hand.palm_mm);
        hand.confidence = ms < 1420 ? 1.0F : 0.0F;
    });
    EXPECT_THAT(stage.story(), IsEmpty());
    EXPECT_TRUE(stage.explained("swipe", "may leave the view yet"));
}

TEST(CameraHand, ABorderThatEatsThePalmDoesNotStopTheHand) {
    Stage stage;
    const Actor actor{{{0, at(0, 0)}, {800, at(0, 0)}, {2000, at(0, -480)}, {2500, at(0, -480)}}};
    play(stage, actor, [](int, double ms, Hand& hand) {
        stretch_up(hand, hand.palm_mm);
        // From here on the circle in what is left of the hand stays where it is.
        hand.palm_mm.y() = std::max(hand.palm_mm.y(), -220.0F);
        hand.confidence = ms < 1560 ? 1.0F : 0.0F;
    });
    EXPECT_THAT(stage.story(), IsEmpty());
}

TEST(CameraHand, AStrokeDownThatStopsInViewIsASwipe) {
    Stage stage;
    const Actor actor{
        {{0, at(0, 100)}, {800, at(0, 100)}, {1250, at(0, -130)}, {1800, at(0, -130)}}};
    play(stage, actor, [](int, double, Hand& hand) { stretch_up(hand, hand.palm_mm); });
    EXPECT_THAT(stage.story(), ElementsAre("swipe_down"));
    const GestureEvent* begin = stage.first(GestureType::swipe, EventPhase::begin);
    ASSERT_NE(begin, nullptr);
    EXPECT_LT(begin->sensor.us(), 1'300'000);  // within 50 ms of the stroke's end
}

/// Open at 75 mm, closed from 950 to 1500 ms, open again.
const Actor kPinching{{{0, at(0, 0), 75},
                       {700, at(0, 0), 75},
                       {950, at(0, 0), 10},
                       {1500, at(0, 0), 10},
                       {1700, at(0, 0), 75},
                       {2200, at(0, 0), 75}}};

TEST(CameraHand, FingertipsMistakenForOthersDoNotOpenAPinch) {
    Stage stage;
    play(stage, kPinching, [](int frame, double, Hand& hand) {
        hand.palm_radius_mm = 42.0F;  // a span of 155 mm
        if (frame % 5 == 0) {
            hand.pinch_aperture_mm = 187.0F;  // farther than a hand spans
        } else if (frame % 9 == 0) {
            hand.pinch_aperture_mm += 90.0F;  // faster than a finger moves
        }
    });
    EXPECT_THAT(stage.story(), ElementsAre("pinch begin", "pinch end"));
}

TEST(CameraHand, APinchOutlivesFingertipsThatMergeForAMoment) {
    Stage stage;
    play(stage, kPinching, [](int, double ms, Hand& hand) {
        if (ms > 1100 && ms < 1350) {
            hand.pinch_aperture_mm = -1.0F;
        }
    });
    EXPECT_THAT(stage.story(), ElementsAre("pinch begin", "pinch end"));
}

TEST(CameraHand, FingersThatSeemToMeetInAStrokeDoNotPinch) {
    // A stroke of 300 mm in 450 ms that stops; the tips seem to meet half-way and stay together.
    for (const bool in_stroke : {true, false}) {
        const Actor actor{{{0, at(0, 0), 75},
                           {1200, at(0, 0), 75},
                           {1650, at(0, -300), 75},
                           {3000, at(0, -300), 75}}};
        GestureSettings settings;
        settings.swipe = false;
        Stage stage(settings);
        play(stage, actor, [in_stroke](int, double ms, Hand& hand) {
            const double met_ms = in_stroke ? 1480.0 : 2100.0;
            const double closing_mm =
                75.0 - std::clamp((ms - met_ms + 50.0) / 50.0, 0.0, 1.0) * 67.0;
            hand.pinch_aperture_mm = static_cast<float>(closing_mm);
        });
        if (in_stroke) {
            EXPECT_THAT(stage.story(), IsEmpty());
            EXPECT_TRUE(stage.explained("pinch", "the palm moved too fast to see fingers"));
        } else {
            EXPECT_THAT(stage.story(), ElementsAre("pinch begin"));
        }
    }
}

TEST(CameraHand, WhatBlursFingersIsTheWayOfThePalmWhileItsDepthIsMeasured) {
    // 120 mm/s: 8 mm in five images at 60 Hz, 20 mm in three patterns of two images each at 30 Hz.
    const Actor actor{
        {{0, at(0, 0), 75}, {800, at(0, 0), 75}, {2300, at(-96, 0), 75}, {3500, at(-96, 0), 75}}};
    const auto closes = [](int, double ms, Hand& hand) {
        hand.pinch_aperture_mm =
            static_cast<float>(75.0 - std::clamp((ms - 1400) / 200, 0.0, 1.0) * 67);
    };
    for (const bool webcam : {false, true}) {
        Stage stage;
        play(stage, actor, closes, std::chrono::milliseconds{webcam ? 167 : 67});
        if (webcam) {
            EXPECT_THAT(stage.story(), IsEmpty());
            EXPECT_TRUE(stage.explained("pinch", "the palm moves too fast to see fingers"));
        } else {
            EXPECT_THAT(stage.story(), ElementsAre("pinch begin"));
        }
    }
}

TEST(CameraHand, TipsThatComeAndGoAreNoPinch) {
    Stage stage;
    const Actor actor{{{0, at(0, 0), 100}, {2500, at(0, 0), 100}}};
    play(stage, actor, [](int frame, double ms, Hand& hand) {
        const bool closed = ms > 1500 || frame % 2 == 0;
        hand.pinch_aperture_mm = closed ? 8.0F : 100.0F;
    });
    EXPECT_THAT(stage.story(), IsEmpty());
}

TEST(CameraHand, AFistOfWhichAFingerIsFoundForAMomentIsHeld) {
    const auto story_of = [](double wavers_ms) {
        GestureSettings settings;
        settings.swipe = settings.push = settings.pinch = settings.grab = false;
        settings.fist = true;
        Stage stage(settings);
        const Actor actor{{{0, at(0, 0)}, {1500, at(0, 0)}}};
        play(stage, actor, [&](int, double ms, Hand& hand) {
            const bool found = ms >= 800.0 && ms < 800.0 + wavers_ms;
            const bool shown = ms >= 500.0 && ms < 1150.0;
            hand.finger_extension = {0.0F, found || !shown ? 1.0F : 0.0F, 0.0F, 0.0F, 0.0F};
        });
        return stage.story();
    };
    EXPECT_THAT(story_of(0.0), ElementsAre("fist begin", "fist end"));
    EXPECT_THAT(story_of(60.0), ElementsAre("fist begin", "fist end"));
    EXPECT_THAT(story_of(200.0), IsEmpty());
}

TEST(CameraHand, APointingHandThatBendsItsIndexDoesNotGrab) {
    // Opens into a pointing hand, half a fist, which is a whole one while its index is bent.
    const auto story_of = [](float index) {
        GestureSettings settings;
        settings.grab = true;
        Stage stage(settings);
        const Actor actor{{{0, at(0, 0)}, {2000, at(0, 0)}}};
        play(stage, actor, [&](int, double ms, Hand& hand) {
            const bool open = ms < 800.0;
            const bool bent = ms >= 1300.0 && ms < 1600.0;
            const float others = open ? 1.0F : 0.0F;
            hand.finger_extension = {0.0F,
                                     open   ? 1.0F
                                     : bent ? 0.0F
                                            : index,
                                     others, others, others};
            hand.grab_value = open ? 0.0F : bent ? 0.95F : 0.6F;
            hand.extended_fingers = open ? 4 : 1;
        });
        return stage.story();
    };
    EXPECT_THAT(story_of(1.0F), IsEmpty());
    // A fist that closes in two steps has its index with the others.
    EXPECT_THAT(story_of(0.2F), ElementsAre("grab begin", "grab end"));
}

TEST(CameraHand, OneFingerThatMergesDoesNotSpoilAPinchAFistDoes) {
    for (const bool fist : {false, true}) {
        Stage stage;
        play(stage, kPinching, [fist](int, double ms, Hand& hand) {
            const float now = ms > 900 && ms < 1600 ? 0.0F : 1.0F;
            const float others = fist ? now : 1.0F;
            hand.finger_extension = {1.0F, 1.0F, others, others, now};
        });
        if (fist) {
            EXPECT_THAT(stage.story(), IsEmpty());
            EXPECT_TRUE(stage.explained("pinch", "another finger folds with it"));
        } else {
            EXPECT_THAT(stage.story(), ElementsAre("pinch begin", "pinch end"));
        }
    }
}

}  // namespace
}  // namespace xtrack::test
