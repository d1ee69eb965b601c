// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "tests/gestures/recognise/play_hand.hpp"

namespace xtrack::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

const Vec3f kRest{0.0F, 0.0F, 400.0F};

At fingers(double ms, double aperture_mm) { return {ms, kRest, aperture_mm}; }

Actor pinching(double closed_mm = 12.0, double closed_ms = 600.0) {
    return {{fingers(0, 75), fingers(800, 75), fingers(950, closed_mm),
             fingers(950 + closed_ms, closed_mm), fingers(1150 + closed_ms, 75),
             fingers(1700 + closed_ms, 75)}};
}

std::vector<std::string> story_of(const Actor& actor, double fps = 60) {
    Stage stage;
    stage.play(actor, fps);
    return stage.story();
}

TEST(Pinch, BeginsUpdatesAndEnds) {
    Stage stage;
    stage.play(pinching(), 60);
    EXPECT_THAT(stage.story(), ElementsAre("pinch begin", "pinch end"));
    const GestureEvent* begin = stage.first(GestureType::pinch, EventPhase::begin);
    const GestureEvent* update = stage.first(GestureType::pinch, EventPhase::update);
    const GestureEvent* end = stage.first(GestureType::pinch, EventPhase::end);
    ASSERT_NE(update, nullptr);
    EXPECT_EQ(begin->gesture_id, update->gesture_id);
    EXPECT_EQ(begin->gesture_id, end->gesture_id);
    EXPECT_FLOAT_EQ(update->value, 1.0F);
    EXPECT_LT(begin->onset, begin->sensor);
    // Closed at about 930 ms, held for 110, of which half an image is not seen.
    EXPECT_NEAR(static_cast<double>(begin->sensor.us()), 1.01e6, 0.06e6);
    // Between the fingertips: 40 mm left of the palm, 46 mm above.
    EXPECT_NEAR(begin->position_mm.x(), -40.0F, 0.1F);
    EXPECT_NEAR(begin->position_mm.y(), 46.0F, 2.0F);
}

TEST(Pinch, IsAsLongAtAnyRate) {
    // Under 20 mm for about 80 ms, which no moment of looking makes 110; then for 300.
    for (const double fps : {15.0, 20.0, 30.0, 60.0, 120.0}) {
        for (double shift_ms = 0.0; shift_ms < 70.0; shift_ms += 10.0) {
            const auto touch = [&](double closed_ms) {
                const double from = 900 + shift_ms;
                return Actor{{fingers(0, 75), fingers(from - 100, 75), fingers(from, 14),
                              fingers(from + closed_ms, 14), fingers(from + 100 + closed_ms, 75),
                              fingers(2000, 75)}};
            };
            EXPECT_THAT(story_of(touch(40), fps), IsEmpty()) << fps << " " << shift_ms;
            EXPECT_THAT(story_of(touch(260), fps), ElementsAre("pinch begin", "pinch end"))
                << fps << " " << shift_ms;
        }
    }
}

struct Depth {
    double closed_mm;
    double closed_ms;
    bool pinches;
};

class PinchTable : public ::testing::TestWithParam<Depth> {};

TEST_P(PinchTable, CloseEnoughAndLongEnough) {
    const Depth& d = GetParam();
    const std::vector<std::string> story = story_of(pinching(d.closed_mm, d.closed_ms));
    if (d.pinches) {
        EXPECT_THAT(story, ElementsAre("pinch begin", "pinch end"));
    } else {
        EXPECT_THAT(story, IsEmpty());
    }
}

INSTANTIATE_TEST_SUITE_P(Table, PinchTable,
                         ::testing::Values(Depth{5, 400, true}, Depth{18, 400, true},
                                           Depth{23, 400, false}, Depth{35, 400, false},
                                           Depth{12, 100, true}));

TEST(Pinch, NeedsAnApproach) {
    // Closed from the first frame on, and a hand that was never quite open.
    EXPECT_THAT(story_of({{fingers(0, 12), fingers(2000, 12)}}), IsEmpty());
    EXPECT_THAT(story_of({{fingers(0, 35), fingers(800, 35), fingers(950, 12), fingers(2000, 12)}}),
                IsEmpty());
    // Open, but long before: 45 to 35 mm in a moment, then a slow closing.
    const Actor slow{{fingers(0, 45), fingers(600, 45), fingers(700, 32), fingers(1500, 32),
                      fingers(1650, 12), fingers(2400, 12)}};
    EXPECT_THAT(story_of(slow), IsEmpty());
}

TEST(Pinch, HysteresisKeepsItThroughNoise) {
    // Wavers between 14 and 27 mm: one pinch.
    Actor actor{{fingers(0, 75), fingers(800, 75), fingers(950, 14)}};
    for (int i = 0; i < 10; ++i) {
        actor.moments.push_back(fingers(1100 + 200 * i, 27));
        actor.moments.push_back(fingers(1200 + 200 * i, 14));
    }
    actor.moments.push_back(fingers(3300, 75));
    actor.moments.push_back(fingers(3600, 75));
    EXPECT_THAT(story_of(actor), ElementsAre("pinch begin", "pinch end"));
}

TEST(Pinch, NotWhileThePalmMovesFast) {
    Actor actor{{{0, kRest, 75}, {800, kRest, 75}}};
    // Back and forth at 300 mm/s and more while closed for 300 ms.
    actor.moments.push_back({950, kRest + Vec3f{60.0F, 30.0F, 0.0F}, 12});
    actor.moments.push_back({1100, kRest + Vec3f{120.0F, 60.0F, 0.0F}, 12});
    actor.moments.push_back({1250, kRest + Vec3f{180.0F, 90.0F, 0.0F}, 75});
    actor.moments.push_back({2000, kRest + Vec3f{180.0F, 90.0F, 0.0F}, 75});
    GestureSettings settings;
    settings.swipe = false;
    Stage stage(settings);
    stage.play(actor, 60);
    EXPECT_THAT(stage.story(), IsEmpty());
}

TEST(Pinch, LosesItsHandAndIsCancelledByTheClock) {
    // No frame comes any more: advance() alone must notice, within 120 ms.
    Stage stage;
    Actor actor{{fingers(0, 75), fingers(800, 75), fingers(950, 12), fingers(1500, 12)}};
    stage.play(actor, 60);
    ASSERT_THAT(stage.story(), ElementsAre("pinch begin"));
    const std::int64_t last_us = stage.events.back().sensor.us();
    for (int i = 1; i <= 5; ++i) {
        stage.keep(stage.recogniser.advance(Stamp::from_us(last_us + 20'000 * i)));
    }
    EXPECT_THAT(stage.story(), ElementsAre("pinch begin")) << "frozen for 120 ms";
    stage.keep(stage.recogniser.advance(Stamp::from_us(last_us + 120'000)));
    EXPECT_THAT(stage.story(), ElementsAre("pinch begin", "pinch cancel lost"));
    EXPECT_EQ(stage.events.back().emit.us(), last_us + 120'000);
    EXPECT_EQ(stage.events.back().sensor.us(), last_us);
}

TEST(Pinch, CannotStick) {
    // UltraLeap's detector kept a pinch for ever when its hand went. Frames go on without it.
    Actor actor{{fingers(0, 75), fingers(800, 75), fingers(950, 12), fingers(1500, 12)}};
    actor.moments.push_back({1501, kRest, 12, false});
    actor.moments.push_back({3000, kRest, 12, false});
    EXPECT_THAT(story_of(actor), ElementsAre("pinch begin", "pinch cancel lost"));
}

TEST(Pinch, SurvivesAShortLoss) {
    Actor actor{{fingers(0, 75), fingers(800, 75), fingers(950, 12), fingers(1500, 12)}};
    actor.moments.push_back({1501, kRest, 12, false});
    actor.moments.push_back(fingers(1580, 12));
    actor.moments.push_back(fingers(2000, 12));
    actor.moments.push_back(fingers(2150, 75));
    actor.moments.push_back(fingers(2500, 75));
    EXPECT_THAT(story_of(actor), ElementsAre("pinch begin", "pinch end"));
}

TEST(Pinch, AFingertipThatIsLostIsALoss) {
    Stage stage;
    Actor actor = pinching(12.0, 400.0);
    stage.play(Actor{{actor.moments.begin(), actor.moments.begin() + 4}}, 60);
    ASSERT_THAT(stage.story(), ElementsAre("pinch begin"));
    Noise noise(1);
    for (int i = 1; i <= 25; ++i) {
        HandFrame frame;
        frame.stamp = Stamp::from_us(1'350'000 + 17'000 * i);
        frame.coordinates = CoordinateFrame::interaction;
        frame.count = 1;
        frame.hands[0] = hand_of(actor, actor.where(1350), noise);
        frame.hands[0].pinch_aperture_mm = -1.0F;
        stage.keep(stage.recogniser.push(frame));
    }
    EXPECT_THAT(stage.story(), ElementsAre("pinch begin", "pinch cancel lost"));
}

TEST(Pinch, IsCancelledAtTheBorder) {
    Actor actor{{fingers(0, 75), fingers(800, 75), fingers(950, 12), fingers(1500, 12)}};
    actor.moments.push_back({1501, kRest, 12, true, true});
    actor.moments.push_back({2000, kRest, 12, true, true});
    EXPECT_THAT(story_of(actor), ElementsAre("pinch begin", "pinch cancel edge"));
}

TEST(Pinch, EndsWithTheStream) {
    Stage stage;
    stage.play(Actor{{fingers(0, 75), fingers(800, 75), fingers(950, 12), fingers(1500, 12)}}, 60);
    stage.keep(stage.recogniser.finish());
    EXPECT_THAT(stage.story(), ElementsAre("pinch begin", "pinch end"));
    EXPECT_EQ(stage.events.back().type, GestureType::hand);
    EXPECT_EQ(stage.events.back().phase, EventPhase::end);
}

TEST(Pinch, IsCancelledWhenTheStreamIsStopped) {
    Stage stage;
    stage.play(Actor{{fingers(0, 75), fingers(800, 75), fingers(950, 12), fingers(1500, 12)}}, 60);
    stage.keep(stage.recogniser.abandon(CancelReason::disengaged));
    EXPECT_THAT(stage.story(), ElementsAre("pinch begin", "pinch cancel disengaged"));
}

TEST(Pinch, TakesTheHandFromTheSwipe) {
    // A stroke with closed fingers drags; it does not swipe.
    Actor actor{{fingers(0, 75), fingers(800, 75), fingers(950, 12), fingers(1300, 12)}};
    actor.moments.push_back({1650, kRest + Vec3f{250.0F, 0.0F, 0.0F}, 12});
    actor.moments.push_back({2200, kRest + Vec3f{250.0F, 0.0F, 0.0F}, 12});
    EXPECT_THAT(story_of(actor), ElementsAre("pinch begin"));
}

TEST(Pinch, TwoInHalfASecond) {
    const Actor actor{{fingers(0, 75), fingers(800, 75), fingers(900, 12), fingers(1000, 12),
                       fingers(1100, 60), fingers(1150, 60), fingers(1250, 12), fingers(1400, 12),
                       fingers(1500, 75), fingers(1900, 75)}};
    EXPECT_THAT(story_of(actor),
                ElementsAre("pinch begin", "pinch end", "pinch begin", "pinch end"));
}

// What else the hand does, from its joints: positions as seen from the index knuckle.
struct Closing {
    Vec3f thumb_open, thumb_closed;
    Vec3f index_open, index_closed;
    bool others_fold = false;
    bool others_straight = true;
    Vec3f middle_tip{-20.0F, 0.0F, -75.0F};
    Vec3f middle_tip_closed{-20.0F, 0.0F, -75.0F};
};

std::vector<std::string> story_of(const Closing& closing) {
    Stage stage;
    for (int i = 0; i <= 120; ++i) {
        const double ms = 1000.0 * i / 60.0;
        const auto s = static_cast<float>(std::clamp((ms - 800.0) / 150.0, 0.0, 1.0));
        HandFrame frame;
        frame.stamp = Stamp{static_cast<std::int64_t>(ms * 1e6)};
        frame.coordinates = CoordinateFrame::interaction;
        frame.count = 1;
        Hand& hand = frame.hands[0];
        hand.id = 1;
        hand.confidence = 1.0F;
        hand.palm_mm = kRest;
        hand.articulated = true;
        put(hand, Joint::index_proximal, kRest);
        const auto between = [s](const Vec3f& a, const Vec3f& b) { return Vec3f(a + s * (b - a)); };
        hand.fingertip(Finger::thumb) = {kRest + between(closing.thumb_open, closing.thumb_closed),
                                         true};
        hand.fingertip(Finger::index) = {kRest + between(closing.index_open, closing.index_closed),
                                         true};
        hand.fingertip(Finger::middle) = {
            kRest + between(closing.middle_tip, closing.middle_tip_closed), true};
        hand.pinch_aperture_mm =
            (hand.fingertip(Finger::thumb).position_mm - hand.fingertip(Finger::index).position_mm)
                .norm();
        const float outer =
            closing.others_fold ? 0.9F - 0.6F * s : (closing.others_straight ? 0.9F : 0.2F);
        hand.finger_extension = {-1.0F, 0.9F, outer, outer, outer};
        stage.keep(stage.recogniser.push(frame));
    }
    return stage.story();
}

Closing real_pinch() {
    return {{-50.0F, -20.0F, -30.0F},
            {-30.0F, -25.0F, -45.0F},
            {0.0F, 0.0F, -75.0F},
            {-20.0F, -25.0F, -50.0F}};
}

TEST(Pinch, ThumbAndIndexMeet) { EXPECT_THAT(story_of(real_pinch()), ElementsAre("pinch begin")); }

TEST(Pinch, AFistIsNone) {
    Closing fist = real_pinch();
    fist.others_fold = true;
    EXPECT_THAT(story_of(fist), IsEmpty());
}

TEST(Pinch, ATapOfAPointingHandIsNone) {
    // The thumb rests on the folded middle finger; the index comes down on it.
    Closing tap = real_pinch();
    tap.others_straight = false;
    tap.thumb_open = tap.thumb_closed = Vec3f{-30.0F, -25.0F, -35.0F};
    tap.middle_tip = tap.middle_tip_closed = Vec3f{-30.0F, -35.0F, -25.0F};
    EXPECT_THAT(story_of(tap), IsEmpty());
}

TEST(Pinch, ABunchOfFingertipsIsNone) {
    Closing bunch = real_pinch();
    bunch.middle_tip_closed = bunch.index_closed + Vec3f{3.0F, 0.0F, -5.0F};
    EXPECT_THAT(story_of(bunch), IsEmpty());
}

TEST(Pinch, AThumbThatFoldsAlongAStillIndexIsNone) {
    Closing thumb = real_pinch();
    thumb.index_open = thumb.index_closed + Vec3f{2.0F, 0.0F, -3.0F};
    thumb.thumb_open = Vec3f{-80.0F, -20.0F, -10.0F};
    EXPECT_THAT(story_of(thumb), IsEmpty());
}

TEST(Pinch, IsSeenInTrueDepth) {
    // Tips that cover each other in the image but are 60 mm apart in depth. (a 2-D detector's bug)
    Closing apart = real_pinch();
    apart.index_closed = apart.thumb_closed + Vec3f{0.0F, 0.0F, -60.0F};
    EXPECT_THAT(story_of(apart), IsEmpty());
}

}  // namespace
}  // namespace xtrack::test
