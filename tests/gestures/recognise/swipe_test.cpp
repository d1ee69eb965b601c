// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "tests/gestures/recognise/play_hand.hpp"

namespace xtrack::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr float kFar = 400.0F;

Vec3f at(float x, float y, float z = kFar) { return {x, y, z}; }

/// Rests, strokes by `way` in `ms`, rests.
Actor stroke(const Vec3f& way, double ms, Held held = Held::plain) {
    const Vec3f start = at(0, 0) - 0.5F * way;
    return {{{0, start}, {800, start}, {800 + ms, start + way}, {1800 + ms, start + way}}, held};
}

std::vector<std::string> story_of(const Actor& actor, double fps = 60) {
    Stage stage;
    stage.play(actor, fps);
    return stage.story();
}

TEST(Swipe, GoesFourWays) {
    EXPECT_THAT(story_of(stroke(at(-250, 0, 0), 400)), ElementsAre("swipe_left"));
    EXPECT_THAT(story_of(stroke(at(250, 0, 0), 400)), ElementsAre("swipe_right"));
    EXPECT_THAT(story_of(stroke(at(0, 250, 0), 400)), ElementsAre("swipe_up"));
    EXPECT_THAT(story_of(stroke(at(0, -250, 0), 400)), ElementsAre("swipe_down"));
}

TEST(Swipe, SaysWhenItBeganAndHowFast) {
    Stage stage;
    stage.play(stroke(at(-250, 0, 0), 400), 60);
    const GestureEvent* begin = stage.first(GestureType::swipe, EventPhase::begin);
    const GestureEvent* end = stage.first(GestureType::swipe, EventPhase::end);
    ASSERT_NE(begin, nullptr);
    ASSERT_NE(end, nullptr);
    EXPECT_EQ(begin->sensor, end->sensor);
    EXPECT_EQ(begin->gesture_id, end->gesture_id);
    EXPECT_EQ(begin->emit, begin->sensor);
    EXPECT_EQ(begin->hand, Chirality::right);
    // The hand moves from 800 ms on, and is at 100 mm (of 250) after some 180 ms.
    EXPECT_GE(begin->onset.us(), 790'000);
    EXPECT_LE(begin->onset.us(), 900'000);
    EXPECT_LE(begin->sensor.us(), 1'060'000);
    EXPECT_GT(begin->value, 400.0F);
    EXPECT_LT(begin->value, 1300.0F);
    EXPECT_LT(begin->velocity_mmps.x(), -300.0F);
}

struct Timing {
    float length_mm;
    double lasts_ms;
    bool swipes;
};

class SwipeTiming : public ::testing::TestWithParam<Timing> {};

TEST_P(SwipeTiming, ShortAndSlowOnesAreNone) {
    const Timing& t = GetParam();
    const std::vector<std::string> story = story_of(stroke(at(-t.length_mm, 0, 0), t.lasts_ms));
    if (t.swipes) {
        EXPECT_THAT(story, ElementsAre("swipe_left"));
    } else {
        EXPECT_THAT(story, IsEmpty());
    }
}

INSTANTIATE_TEST_SUITE_P(Table, SwipeTiming,
                         ::testing::Values(Timing{70, 150, false},    // short
                                           Timing{90, 200, false},    // just short
                                           Timing{150, 190, true},    // the shortest that is real
                                           Timing{200, 400, true},    //
                                           Timing{300, 600, true},    //
                                           Timing{200, 1300, false},  // 290 mm/s at its peak
                                           Timing{300, 2000, false}   // a drift
                                           ));

struct Slant {
    float degrees;
    bool swipes;
};

class SwipeSlant : public ::testing::TestWithParam<Slant> {};

TEST_P(SwipeSlant, DiagonalsAreNone) {
    const float rad = GetParam().degrees * 3.14159265F / 180.0F;
    const Vec3f way = at(250 * std::cos(rad), 250 * std::sin(rad), 0);
    const std::vector<std::string> story = story_of(stroke(way, 400));
    if (GetParam().swipes) {
        EXPECT_THAT(story, ElementsAre("swipe_right"));
    } else {
        EXPECT_THAT(story, IsEmpty());
    }
}

INSTANTIATE_TEST_SUITE_P(Table, SwipeSlant,
                         ::testing::Values(Slant{0, true}, Slant{20, true}, Slant{-20, true},
                                           Slant{35, false}, Slant{45, false}, Slant{-45, false},
                                           Slant{60, false}));

TEST(Swipe, TowardTheScreenIsNone) {
    EXPECT_THAT(story_of(stroke(at(-120, 0, -250), 500)),
                ::testing::Not(::testing::Contains("swipe_left")));
}

TEST(Swipe, ToTheFaceAndFromItIsNone) {
    // 31 degrees; a plain stroke by its length, its speed and its angle out of the plane (45).
    EXPECT_THAT(story_of(stroke(at(0, 250, 150), 400)), IsEmpty());
    EXPECT_THAT(story_of(stroke(at(0, -250, -150), 400)), IsEmpty());
    // The other two ways do not lead to a face, nor does this much of an arc about an elbow.
    EXPECT_THAT(story_of(stroke(at(0, 250, -150), 400)), ElementsAre("swipe_up"));
    EXPECT_THAT(story_of(stroke(at(0, -250, 150), 400)), ElementsAre("swipe_down"));
    EXPECT_THAT(story_of(stroke(at(0, 250, 90), 400)), ElementsAre("swipe_up"));
    EXPECT_THAT(story_of(stroke(at(-250, 0, 150), 400)), ElementsAre("swipe_left"));
}

TEST(Swipe, TheWayBackIsNoSwipe) {
    const Actor actor{{{0, at(150, 0)},
                       {800, at(150, 0)},
                       {1100, at(-150, 0)},
                       {1150, at(-150, 0)},
                       {1500, at(150, 0)},
                       {2500, at(150, 0)}}};
    Stage stage;
    stage.play(actor, 60);
    EXPECT_THAT(stage.story(), ElementsAre("swipe_left"));
    EXPECT_TRUE(stage.explained("swipe", "return stroke"));
}

TEST(Swipe, ASlowWayBackAfterAPauseIsNone) {
    const Actor actor{{{0, at(150, 0)},
                       {800, at(150, 0)},
                       {1050, at(-150, 0)},
                       {1650, at(-150, 0)},
                       {2250, at(150, 0)},
                       {3000, at(150, 0)}}};
    EXPECT_THAT(story_of(actor), ElementsAre("swipe_left"));
}

TEST(Swipe, TheOppositeSwipeAfterARestCounts) {
    const Actor actor{{{0, at(150, 0)},
                       {800, at(150, 0)},
                       {1100, at(-150, 0)},
                       {2800, at(-150, 0)},
                       {3100, at(150, 0)},
                       {4000, at(150, 0)}}};
    EXPECT_THAT(story_of(actor), ElementsAre("swipe_left", "swipe_right"));
}

TEST(Swipe, TwiceTheSameWay) {
    const Actor actor{{{0, at(150, 0)},
                       {800, at(150, 0)},
                       {1100, at(-150, 0)},
                       {1500, at(150, 0)},
                       {1800, at(-150, 0)},
                       {2500, at(-150, 0)}}};
    EXPECT_THAT(story_of(actor), ElementsAre("swipe_left", "swipe_left"));
}

TEST(Swipe, AWindUpDoesNotBlockWhatFollows) {
    // Back by 80 mm, then the swipe: the wind-up is too short to be one.
    const Actor brief{{{0, at(0, 0)},
                       {800, at(0, 0)},
                       {1000, at(-80, 0)},
                       {1350, at(250, 0)},
                       {2300, at(250, 0)}}};
    EXPECT_THAT(story_of(brief), ElementsAre("swipe_right"));
    // A long one is read as a swipe, but must not take the real one away.
    const Actor wide{{{0, at(0, 0)},
                      {800, at(0, 0)},
                      {1100, at(-130, 0)},
                      {1400, at(300, 0)},
                      {2300, at(300, 0)}}};
    EXPECT_THAT(story_of(wide), ::testing::Contains("swipe_right"));
}

TEST(Swipe, AVIsNone) {
    // Drawn with a pointing finger, sides 30 degrees from the vertical.
    Actor actor{{{0, at(0, 100)},
                 {800, at(0, 100)},
                 {1150, at(105, -80)},
                 {1500, at(210, 100)},
                 {2300, at(210, 100)}}};
    actor.held = Held::pointing_down;
    EXPECT_THAT(story_of(actor), IsEmpty());
}

TEST(Swipe, APointingFingerDrawsCircles) {
    Actor actor{{}, Held::pointing_down};
    for (int i = 0; i <= 60; ++i) {
        const float rad = 2.0F * 3.14159265F * static_cast<float>(i) / 30.0F;
        const double ms = i == 0 ? 0.0 : 800.0 + 40.0 * i;
        actor.moments.push_back({ms, at(110 * std::cos(rad), 110 * std::sin(rad))});
    }
    GestureSettings settings;
    settings.circle = false;
    Stage stage(settings);
    stage.play(actor, 60);
    EXPECT_THAT(stage.story(), IsEmpty());
    // Where circles are asked for it is one, the second turn just not complete, and no swipe
    // either.
    EXPECT_THAT(story_of(actor), ElementsAre("circle_counterclockwise"));
}

/// A quarter of a circle about (0, -radius) in 300 ms, after a rest.
std::vector<std::string> story_of_quarter(float radius_mm, double most_deg) {
    constexpr int kPieces = 20;
    constexpr float kQuarter = 1.57079633F;
    Actor actor{{{0.0, at(0, 0)}}};
    for (int i = 0; i <= kPieces; ++i) {
        const float rad = kQuarter * static_cast<float>(i) / kPieces;
        actor.moments.push_back(
            {800.0 + 15.0 * i, at(radius_mm * std::sin(rad), radius_mm * (std::cos(rad) - 1.0F))});
    }
    actor.moments.push_back({1800.0, actor.moments.back().palm_mm});
    GestureSettings settings;
    settings.swipe_bend_deg = most_deg;
    Stage stage(settings);
    stage.play(actor, 60);
    return stage.story();
}

TEST(Swipe, ACirclesFirstQuarterIsNone) {
    EXPECT_THAT(story_of_quarter(150.0F, 40.0), IsEmpty());
    EXPECT_THAT(story_of_quarter(150.0F, 180.0), ElementsAre("swipe_right"));
    // A forearm that swings about its elbow bends its way less.
    EXPECT_THAT(story_of_quarter(330.0F, 40.0), ElementsAre("swipe_right"));
}

TEST(Swipe, APalmThatJumpsIsNone) {
    const Actor actor{{{0, at(0, 0)}, {800, at(0, 0)}, {801, at(-250, 0)}, {1800, at(-250, 0)}}};
    for (const double fps : {30.0, 60.0, 120.0}) {
        EXPECT_THAT(story_of(actor, fps), IsEmpty()) << fps;
    }
}

TEST(Swipe, AHandHeldUpFlatSwipesUpAndDownByTheRuleOfBacks) {
    EXPECT_THAT(story_of(stroke(at(0, 180, 0), 450, Held::palm_screen)), ElementsAre("swipe_up"));
    EXPECT_THAT(story_of(stroke(at(0, 180, 0), 450, Held::palm_down)), IsEmpty());
    EXPECT_THAT(story_of(stroke(at(0, 180, 0), 850, Held::palm_screen)), IsEmpty());
    EXPECT_THAT(story_of(stroke(at(0, -180, 0), 450, Held::palm_screen)),
                ElementsAre("swipe_down"));
}

TEST(Swipe, APalmThatLeadsMaySwipeSlowly) {
    const Vec3f way = at(-160, 0, 0);
    EXPECT_THAT(story_of(stroke(way, 650, Held::palm_left)), ElementsAre("swipe_left"));
    EXPECT_THAT(story_of(stroke(way, 650, Held::palm_down)), IsEmpty());
    EXPECT_THAT(story_of(stroke(way, 650, Held::palm_right)), IsEmpty());  // its back leads
}

TEST(Swipe, AHandShownToTheScreenSwipesByThePlainRule) {
    EXPECT_THAT(story_of(stroke(at(-200, 0, 0), 400, Held::palm_screen)),
                ElementsAre("swipe_left"));
}

TEST(Swipe, ACarriedHandMustMeanIt) {
    EXPECT_THAT(story_of(stroke(at(-180, 0, 0), 450, Held::palm_down)), IsEmpty());
    EXPECT_THAT(story_of(stroke(at(-300, 0, 0), 350, Held::palm_down)), ElementsAre("swipe_left"));
}

TEST(Swipe, ALeftHandsPalmIsItsOwn) {
    // The same joints mirrored: a left hand with its palm to the right leads to the right.
    Actor actor = stroke(at(160, 0, 0), 480, Held::palm_left);
    actor.chirality = Chirality::left;
    EXPECT_THAT(story_of(actor), ElementsAre("swipe_right"));
}

TEST(Swipe, TheTipIsTheSecondVote) {
    // The palm goes left around an index tip that stays: a turn of the hand.
    Stage stage;
    for (int i = 0; i <= 120; ++i) {
        const double ms = 1000.0 * i / 60.0;
        const double s = std::clamp((ms - 800.0) / 350.0, 0.0, 1.0);
        HandFrame frame;
        frame.stamp = Stamp{static_cast<std::int64_t>(ms * 1e6)};
        frame.coordinates = CoordinateFrame::interaction;
        frame.count = 1;
        Hand& hand = frame.hands[0];
        hand.id = 1;
        hand.confidence = 1.0F;
        hand.palm_mm = at(static_cast<float>(-200.0 * s), 0);
        hand.fingertip(Finger::index) = {at(-100, 90), true};
        stage.keep(stage.recogniser.push(frame));
    }
    EXPECT_THAT(stage.story(), IsEmpty());
    EXPECT_TRUE(stage.explained("swipe", "the index tip stays behind"));
}

TEST(Swipe, UpAndDownMayBeSwitchedOff) {
    const auto story_without = [](const Vec3f& way) {
        GestureSettings settings;
        settings.swipe_vertical = false;
        Stage stage(settings);
        stage.play(stroke(way, 400), 60);
        return stage.story();
    };
    EXPECT_THAT(story_without(at(0, 250, 0)), IsEmpty());
    EXPECT_THAT(story_without(at(0, -250, 0)), IsEmpty());
    EXPECT_THAT(story_without(at(250, 0, 0)), ElementsAre("swipe_right"));
}

/// Held up at (0, 0) with the fingers up, then slowly to `from`, then a stroke by `way`.
Actor stroke_from(const Vec3f& from, const Vec3f& way, double ms) {
    const Vec3f to = from + way;
    return {{{0, at(0, 0)},
             {2000, at(0, 0)},
             {5000, from},
             {5300, from},
             {5300 + ms, to},
             {6300 + ms, to}},
            Held::palm_screen};
}

TEST(Swipe, FromFarBelowWhereTheHandIsHeldUpIsNone) {
    // Palm down on the way and on the table, as hands lie there.
    Actor actor = stroke_from(at(0, -260), at(0, 200, 0), 350);
    actor.change = [](double ms, Hand& hand) {
        if (ms > 2000.0 && ms < 5300.0) {
            hand.joints = {};
            add_joints(hand, at(0, 0, -1), at(0, -1, 0), false);
            complete_from_joints(hand);
        }
    };
    Stage stage;
    stage.play(actor, 60);
    EXPECT_THAT(stage.story(), IsEmpty());
    EXPECT_TRUE(stage.explained("swipe", "begins below where the hand is held up"));
    GestureSettings anywhere;
    anywhere.swipe_below_mm = 1000.0;
    Stage permissive(anywhere);
    permissive.play(actor, 60);
    EXPECT_THAT(permissive.story(), ElementsAre("swipe_up"));
    // A wind-up of 120 mm is none of that.
    EXPECT_THAT(story_of(stroke_from(at(0, -120), at(0, 240, 0), 400)), ElementsAre("swipe_up"));
}

TEST(Swipe, UpAndDownMayBeAskedForAPreparation) {
    GestureSettings settings;
    settings.swipe_prepared = true;
    const auto story_if_asked = [&](const Vec3f& from, const Vec3f& way, double ms) {
        Stage stage(settings);
        stage.play(stroke_from(from, way, ms), 60);
        return stage.story();
    };
    EXPECT_THAT(story_of(stroke_from(at(0, 0), at(0, -200, 0), 400)), ElementsAre("swipe_down"));
    EXPECT_THAT(story_if_asked(at(0, 0), at(0, -200, 0), 400), IsEmpty());
    EXPECT_THAT(story_if_asked(at(0, 0), at(0, 200, 0), 400), IsEmpty());
    EXPECT_THAT(story_if_asked(at(0, 0), at(0, -200, 0), 200),
                ElementsAre("swipe_down"));  // a flick
    EXPECT_THAT(story_if_asked(at(0, 80), at(0, -200, 0), 400), ElementsAre("swipe_down"));
    EXPECT_THAT(story_if_asked(at(0, -80), at(0, 200, 0), 400), ElementsAre("swipe_up"));
    EXPECT_THAT(story_if_asked(at(0, 0), at(-200, 0, 0), 400), ElementsAre("swipe_left"));
}

TEST(Swipe, AHandThatLiesFlatIsCarried) {
    // What a camera sees of it faces up by 45 degrees, as of a hand that reaches over a table.
    const auto story_of_side = [](const Vec3f& side, const Vec3f& way, double ms) {
        Actor actor = stroke(way, ms);
        actor.change = [side](double, Hand& hand) { hand.palm_normal = side.normalized(); };
        return story_of(actor);
    };
    EXPECT_THAT(story_of_side(at(0, 1, -1), at(-180, 0, 0), 450), IsEmpty());
    EXPECT_THAT(story_of_side(at(0, 0, -1), at(-180, 0, 0), 450), ElementsAre("swipe_left"));
    EXPECT_THAT(story_of_side(at(1, 0, -1), at(-180, 0, 0), 450), ElementsAre("swipe_left"));
    EXPECT_THAT(story_of_side(at(0, 1, -1), at(-250, 0, 0), 350), ElementsAre("swipe_left"));
}

TEST(Swipe, ReachingForSomethingAtTheSideIsNone) {
    // 38 degrees out of the plane; recordings have swipes of up to 28.
    EXPECT_THAT(story_of(stroke(at(-250, 0, -195), 400)), IsEmpty());
    EXPECT_THAT(story_of(stroke(at(-250, 0, 195), 400)), IsEmpty());
    EXPECT_THAT(story_of(stroke(at(-250, 0, -150), 400)), ElementsAre("swipe_left"));
}

TEST(Swipe, IsOffWhenSwitchedOff) {
    GestureSettings settings;
    settings.swipe = false;
    Stage stage(settings);
    stage.play(stroke(at(-250, 0, 0), 400), 60);
    EXPECT_THAT(stage.story(), IsEmpty());
}

}  // namespace
}  // namespace xtrack::test
