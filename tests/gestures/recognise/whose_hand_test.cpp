// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "tests/gestures/recognise/play_hand.hpp"

namespace xtrack::test {
namespace {

using ::testing::ElementsAre;

Vec3f at(float x, float y = 0.0F, float z = 500.0F) { return {x, y, z}; }

constexpr float kAdultMm = 43.0F;  // radius of the palm
constexpr float kChildMm = 32.0F;
const Vec3f kHangsRight = Vec3f{0.35F, -0.55F, 0.76F}.normalized();
const Vec3f kHangsLeft = Vec3f{-0.35F, -0.55F, 0.76F}.normalized();
const Vec3f kFromBehind = Vec3f{0.2F, -0.2F, 0.96F}.normalized();

GestureSettings sessions() {
    GestureSettings s;
    s.push = s.pinch = false;
    s.engage = true;
    return s;
}

/// An adult's left hand at rest, whose session it is. Not quite still, so that it does not idle.
Actor owner(double until_ms) {
    Actor actor{{{0, at(-100)}, {0.5 * until_ms, at(-120)}, {until_ms, at(-100)}}};
    actor.chirality = Chirality::left;
    actor.forearm = kHangsLeft;
    actor.palm_radius_mm = kAdultMm;
    return actor;
}

/// A right hand that comes at 1 s, rests beside the owner's and swipes left at 3.5 s.
Actor guest(float radius_mm = kAdultMm) {
    Actor actor{{{0, at(330), 70, false},
                 {1000, at(330)},
                 {3500, at(330)},
                 {3850, at(30)},
                 {6000, at(30)}}};
    actor.moments[0].palm_mm = actor.moments[1].palm_mm = actor.moments[2].palm_mm = at(200);
    actor.moments[3].palm_mm = actor.moments[4].palm_mm = at(-60);
    actor.id = 2;
    actor.forearm = kHangsRight;
    actor.palm_radius_mm = radius_mm;
    return actor;
}

TEST(WhoseHand, TheOwnersOtherHandJoins) {
    Stage stage(sessions());
    stage.play({owner(6000), guest()}, 60);
    EXPECT_THAT(stage.story(), ElementsAre("engage begin", "swipe_left"));
    EXPECT_EQ(stage.events.back().hand_id, 2);
}

TEST(WhoseHand, AChildsIsNotAnAdultsOther) {
    Stage stage(sessions());
    stage.play({owner(6000), guest(kChildMm)}, 60);
    EXPECT_THAT(stage.story(), ElementsAre("engage begin"));
    EXPECT_TRUE(stage.explained("engage", "another body's hand"));
}

TEST(WhoseHand, OneThatWasBehindTheOwnerIsRuledOutUntilItLeaves) {
    Actor reaches = guest();
    // It waits over the shoulder for a while, and fits as soon as it is beside the other hand.
    reaches.moments.insert(reaches.moments.begin() + 1,
                           {{800, at(150, 180, 950)}, {1500, at(150, 180, 950)}});
    reaches.moments[3].ms = 2000;
    reaches.change = [](double ms, Hand& hand) {
        hand.forearm = ms < 1800 ? kFromBehind : kHangsRight;
    };
    reaches.moments[0].palm_mm = at(150, 180, 950);
    Stage stage(sessions());
    stage.play({owner(6000), reaches}, 60);
    EXPECT_THAT(stage.story(), ElementsAre("engage begin"));

    // So it is when its tracker loses it for a moment and gives it another id.
    Actor again = reaches;
    again.change = [&](double ms, Hand& hand) {
        reaches.change(ms, hand);
        hand.id = ms < 2400 ? 2 : 3;
        hand.chirality_confidence = ms < 2700 && ms > 2400 ? 0.7F : 0.9F;
    };
    Stage other(sessions());
    other.play({owner(6000), again}, 60);
    EXPECT_THAT(other.story(), ElementsAre("engage begin"));
}

TEST(WhoseHand, WhoStandsBesideHasToFitForLonger) {
    // Elbows as wide as hardly those of one body; from 3 s on they fit.
    Actor beside = guest();
    const double kFits = 3000;
    beside.change = [&](double ms, Hand& hand) {
        if (ms < kFits) {
            hand.palm_mm.x() = 330.0F;
        }
    };
    Stage stage(sessions());
    stage.play({owner(6000), beside}, 60);
    EXPECT_THAT(stage.story(), ElementsAre("engage begin"));
    // With as much time as it did not fit it joins, and is heard.
    for (At& m : beside.moments) {
        m.ms += m.ms > 3000 ? 3000 : 0;
    }
    Stage later(sessions());
    later.play({owner(9000), beside}, 60);
    EXPECT_THAT(later.story(), ElementsAre("engage begin", "swipe_left"));
}

TEST(WhoseHand, TheSameSideTwiceIsNoBody) {
    Actor other = guest();
    other.chirality = Chirality::left;
    Stage stage(sessions());
    stage.play({owner(6000), other}, 60);
    EXPECT_THAT(stage.story(), ElementsAre("engage begin"));
    // But a tracker that was wrong at first may correct itself.
    other.change = [](double ms, Hand& hand) {
        hand.chirality = ms < 2000 ? Chirality::left : Chirality::right;
    };
    Stage corrected(sessions());
    corrected.play({owner(6000), other}, 60);
    EXPECT_THAT(corrected.story(), ElementsAre("engage begin", "swipe_left"));
}

TEST(WhoseHand, AHandThatCrossesDoesNotJoinOnItsWay) {
    // There and back: its elbow fits half of the way, and never where it is slow.
    Actor crosses{{{0, at(260), 70, false},
                   {1000, at(260)},
                   {1900, at(-250)},
                   {2700, at(320)},
                   {4000, at(320)}}};
    crosses.id = 2;
    crosses.forearm = kHangsRight;
    crosses.palm_radius_mm = kAdultMm;
    GestureSettings s = sessions();
    s.engage_ms = 100.0;
    Stage stage(s);
    stage.play({owner(4000), crosses}, 60);
    EXPECT_THAT(stage.story(), ElementsAre("engage begin"));
}

TEST(WhoseHand, AFewBadFramesDoNotPartTheSecondHand) {
    Actor second = guest();
    second.change = [](double ms, Hand& hand) {
        if (ms > 3000 && ms < 3080) {
            hand.forearm = Vec3f{0.9F, 0.4F, 0.1F}.normalized();
        }
        if (ms > 3200 && ms < 3240) {
            hand.confidence = 0.0F;  // not seen
        }
        if (ms > 3300 && ms < 3380) {
            hand.chirality = Chirality::left;
        }
    };
    Stage stage(sessions());
    stage.play({owner(6000), second}, 60);
    EXPECT_THAT(stage.story(), ElementsAre("engage begin", "swipe_left"));
}

TEST(WhoseHand, AStrangerInViewDoesNotTakeTheSessionOfAnOwnerThatIsLost) {
    Actor lost = owner(8000);
    lost.moments = {
        {0, at(-100)}, {1500, at(-100)}, {1501, at(-100), 70, false}, {4000, at(-100), 70, false}};
    // As alike as can be, and nearer than the owner's own hand will be.
    Actor stranger = owner(8000);
    stranger.id = 2;
    stranger.moments = {{0, at(-40), 70, false}, {600, at(-40)}, {4000, at(-40)}};
    Actor back = owner(8000);
    back.moments = {{0, at(-250), 70, false}, {2600, at(-250)}, {4000, at(-250)}};
    back.id = 3;
    Stage stage(sessions());
    stage.play({lost, stranger, back}, 60);
    EXPECT_THAT(stage.story(), ElementsAre("engage begin", "engage cancel lost", "engage begin"));
    EXPECT_EQ(stage.recogniser.session_owner(), 3);
}

TEST(WhoseHand, NorDoesOneThatAppearsMeanwhile) {
    Actor lost = owner(3800);
    lost.moments = {
        {0, at(-100)}, {1500, at(-100)}, {1501, at(-100), 70, false}, {3700, at(-100), 70, false}};
    const auto story_with = [&](const Actor& comes) {
        Stage stage(sessions());
        stage.play({lost, comes}, 60);
        return stage.story();
    };
    Actor same = owner(3800);
    same.moments = {{0, at(-150), 70, false}, {2000, at(-150)}, {3700, at(-150)}};
    same.id = 2;
    EXPECT_THAT(story_with(same),
                ElementsAre("engage begin", "engage cancel lost", "engage begin"));
    Actor other_side = same;
    other_side.chirality = Chirality::right;
    Actor other_size = same;
    other_size.palm_radius_mm = kChildMm;
    Actor other_arm = same;
    other_arm.forearm = Vec3f{0.1F, 0.45F, 0.88F}.normalized();
    for (const Actor& stranger : {other_side, other_size, other_arm}) {
        EXPECT_THAT(story_with(stranger), ElementsAre("engage begin", "engage cancel lost"));
    }
}

TEST(WhoseHand, AnOwnerThatIsBackInTimeIsWaitedFor) {
    Actor lost = owner(5000);
    lost.moments = {
        {0, at(-100)}, {1500, at(-100)}, {1501, at(-100), 70, false}, {5000, at(-100), 70, false}};
    Actor stranger = guest(kChildMm);
    stranger.moments = {{0, at(200), 70, false}, {600, at(200)}, {5000, at(200)}};
    Actor back = owner(5000);
    back.moments = {{0, at(-100), 70, false}, {3700, at(-100)}, {5000, at(-100)}};
    back.id = 3;
    Stage stage(sessions());
    stage.play({lost, stranger, back}, 60);
    // Kept until 3.8 s; the lock-out of the hand that is back ends later.
    EXPECT_EQ(stage.recogniser.session_owner(), 3);
}

/// Two hands at rest whose tracker exchanges their ids at 2 s; each swipes after that.
std::vector<Actor> exchanged() {
    Actor mine = owner(6000);
    mine.moments = {{0, at(-150)}, {3000, at(-150)}, {3350, at(-400)}, {6000, at(-400)}};
    mine.change = [](double ms, Hand& hand) { hand.id = ms < 2000 ? 1 : 2; };
    Actor theirs = guest(kChildMm);
    theirs.moments = {
        {0, at(250), 70, false}, {400, at(250)}, {4500, at(250)}, {4850, at(0)}, {6000, at(0)}};
    theirs.change = [](double ms, Hand& hand) { hand.id = ms < 2000 ? 2 : 1; };
    return {mine, theirs};
}

TEST(WhoseHand, ExchangedIdsDoNotChangeTheOwner) {
    Stage stage(sessions());
    stage.play(exchanged(), 60);
    EXPECT_EQ(stage.recogniser.session_owner(), 2);
    ASSERT_THAT(stage.story(), ElementsAre("engage begin", "swipe_left"));
    const GestureEvent* swipe = stage.first(GestureType::swipe, EventPhase::end);
    ASSERT_NE(swipe, nullptr);
    EXPECT_EQ(swipe->hand_id, 2);
    EXPECT_LT(swipe->position_mm.x(), -150.0F);
    EXPECT_TRUE(stage.explained("engage", "its hand has another id now"));
}

TEST(WhoseHand, ExchangedIdsPardonNobody) {
    std::vector<Actor> hands = exchanged();
    // Of the owner's size, and beside it as its other hand would be, but for its arm at first.
    Actor& theirs = hands[1];
    theirs.palm_radius_mm = kAdultMm;
    theirs.moments = {
        {0, at(200), 70, false}, {400, at(200)}, {4500, at(200)}, {4850, at(-60)}, {6000, at(-60)}};
    theirs.change = [](double ms, Hand& hand) {
        hand.id = ms < 2000 ? 2 : 1;
        hand.forearm = ms < 1900 ? Vec3f(Vec3f{0.9F, 0.4F, 0.1F}.normalized()) : kHangsRight;
    };
    hands[0].moments = {{0, at(-150)}, {6000, at(-150)}};
    Stage stage(sessions());
    stage.play(hands, 60);
    EXPECT_EQ(stage.recogniser.session_owner(), 2);
    EXPECT_THAT(stage.story(), ElementsAre("engage begin"));
}

TEST(WhoseHand, ExchangedIdsDoNotPartTheSecondHand) {
    // The owner's own two hands.
    Actor mine = owner(6000);
    mine.change = [](double ms, Hand& hand) { hand.id = ms < 2500 ? 1 : 2; };
    Actor other = guest();
    other.change = [](double ms, Hand& hand) { hand.id = ms < 2500 ? 2 : 1; };
    Stage stage(sessions());
    stage.play({mine, other}, 60);
    EXPECT_EQ(stage.recogniser.session_owner(), 2);
    EXPECT_THAT(stage.story(), ElementsAre("engage begin", "swipe_left"));
    EXPECT_EQ(stage.events.back().hand_id, 1);

    // The owner's and a third one, a stranger's above them.
    mine.change = [](double ms, Hand& hand) { hand.id = ms < 2500 ? 1 : 3; };
    Actor stranger = owner(6000);
    stranger.moments = {{0, at(0, 220), 70, false}, {500, at(0, 220)}, {6000, at(0, 220)}};
    stranger.palm_radius_mm = kChildMm;
    stranger.change = [](double ms, Hand& hand) { hand.id = ms < 2500 ? 3 : 1; };
    Stage three(sessions());
    three.play({mine, guest(), stranger}, 60);
    EXPECT_EQ(three.recogniser.session_owner(), 3);
    EXPECT_THAT(three.story(), ElementsAre("engage begin", "swipe_left"));
    EXPECT_EQ(three.events.back().hand_id, 2);
}

TEST(WhoseHand, HandsThatAreMixedUpWhereTheyMeetAreToldApartAfterwards) {
    // The ids pass from one hand to the other while they are at one place; sides follow late.
    Actor mine = owner(8000);
    mine.moments = {{0, at(-150)},  {1500, at(-150)}, {2300, at(50)},
                    {2500, at(50)}, {3300, at(-150)}, {8000, at(-150)}};
    Actor theirs = guest(kChildMm);
    theirs.moments = {{0, at(250), 70, false}, {400, at(250)},  {1500, at(250)}, {2300, at(60)},
                      {2500, at(60)},          {3300, at(250)}, {8000, at(250)}};
    const auto mix = [](int before, int after, Chirality wrong) {
        return [=](double ms, Hand& hand) {
            hand.id = ms < 2400 ? before : after;
            if (ms >= 2400 && ms < 3400) {
                hand.chirality = wrong;
            }
        };
    };
    mine.change = mix(1, 2, Chirality::right);
    theirs.change = mix(2, 1, Chirality::left);
    GestureSettings s = sessions();
    s.swipe = false;
    Stage stage(s);
    stage.play({mine, theirs}, 60);
    EXPECT_EQ(stage.recogniser.session_owner(), 2);
    EXPECT_THAT(stage.story(), ElementsAre("engage begin"));
}

}  // namespace
}  // namespace xtrack::test
