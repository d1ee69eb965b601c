// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "gestures/recognise/machines/pose.hpp"
#include "tests/gestures/recognise/play_fingers.hpp"

namespace xtrack::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

const std::vector<GestureType> kPoses{GestureType::open_palm, GestureType::fist,
                                      GestureType::point,     GestureType::victory,
                                      GestureType::thumb_up,  GestureType::thumb_down};

GestureSettings poses() {
    GestureSettings settings;
    settings.swipe = settings.push = settings.pull = settings.pinch = settings.grab = settings.tap =
        settings.circle = false;
    settings.open_palm = settings.fist = settings.point = settings.victory = settings.thumb_up =
        settings.thumb_down = true;
    return settings;
}

/// The palm to the user's left: a right hand's thumb is up.
const Posture kThumbUp{{0.0F, 0.0F, -1.0F}, {-1.0F, 0.0F, 0.0F}};
const Posture kThumbDown{{0.0F, 0.0F, -1.0F}, {1.0F, 0.0F, 0.0F}};
const Posture kFingersUp{{0.0F, 1.0F, 0.0F}, {0.0F, 0.0F, -1.0F}};

struct Shown {
    const char* name;
    Bent bent;
    Posture posture;
    GestureType is;
};

const std::vector<Shown> kShown{
    {"open", {0, {15, 15, 15, 15}, 1.0}, kFingersUp, GestureType::open_palm},
    {"fist", {0, {200, 200, 200, 200}, 0.0}, kFingersUp, GestureType::fist},
    {"point", {0, {10, 190, 190, 190}, 0.0}, kFingersUp, GestureType::point},
    {"victory", {0, {10, 15, 190, 190}, 0.0}, kFingersUp, GestureType::victory},
    {"up", {0, {210, 210, 210, 210}, 1.0}, kThumbUp, GestureType::thumb_up},
    {"down", {0, {210, 210, 210, 210}, 1.0}, kThumbDown, GestureType::thumb_down},
};

TEST(Pose, EachHandShowsOne) {
    Noise noise(1);
    for (const Shown& shown : kShown) {
        const Hand hand = hand_of(shown.bent, shown.posture, noise);
        const auto sample = recognise::sample_of(hand, Stamp{}, Duration::zero());
        for (const GestureType pose : kPoses) {
            const double score = recognise::pose_score(pose, sample);
            if (pose == shown.is) {
                EXPECT_GE(score, 0.9) << shown.name << " " << to_string(pose);
            } else {
                EXPECT_LE(score, 0.3) << shown.name << " " << to_string(pose);
            }
        }
        EXPECT_EQ(recognise::pose_score(GestureType::swipe, sample), 0.0);
    }
}

TEST(Pose, ARelaxedHandShowsNone) {
    Noise noise(1);
    const Hand hand = hand_of(Bent{0, {110, 120, 120, 110}, 0.5}, Posture{}, noise);
    const auto sample = recognise::sample_of(hand, Stamp{}, Duration::zero());
    for (const GestureType pose : kPoses) {
        EXPECT_LT(recognise::pose_score(pose, sample), 0.6) << to_string(pose);
    }
}

TEST(Pose, TwoFingersAndTheThumbAreThreeAndNoVictory) {
    Noise noise(1);
    const Hand hand = hand_of(Bent{0, {10, 15, 190, 190}, 1.0}, kFingersUp, noise);
    const auto sample = recognise::sample_of(hand, Stamp{}, Duration::zero());
    EXPECT_EQ(recognise::pose_score(GestureType::victory, sample), 0.0);
}

TEST(Pose, BeginsUpdatesAndEnds) {
    Bent later = pointing(2000);
    Stage stage(poses());
    play(stage,
         {open_hand(0), open_hand(600), pointing(700), later, open_hand(2150), open_hand(2400)}, 60,
         kFingersUp);
    EXPECT_THAT(stage.story(),
                ElementsAre("open_palm begin", "open_palm end", "point begin", "point end"));
    const GestureEvent* begin = stage.first(GestureType::point, EventPhase::begin);
    const GestureEvent* update = stage.first(GestureType::point, EventPhase::update);
    ASSERT_NE(update, nullptr);
    EXPECT_EQ(begin->gesture_id, update->gesture_id);
    EXPECT_GE(begin->value, 0.8F);
    // The open palm has the hand until 100 ms after it fitted; then held for 500.
    EXPECT_NEAR(static_cast<double>(begin->sensor.us()), 1.25e6, 0.05e6);
    EXPECT_NEAR(static_cast<double>((begin->sensor - begin->onset).count()) * 1e-6, 500, 20);
}

TEST(Pose, ShownForAMomentIsNone) {
    Stage stage(poses());
    const Bent half{0, {120, 120, 120, 120}, 0.5};
    std::vector<Bent> moments{half, half, pointing(900), pointing(1250), half, half};
    moments[1].ms = 800;
    moments[4].ms = 1350;
    moments[5].ms = 2200;
    play(stage, moments, 60);
    EXPECT_THAT(stage.story(), IsEmpty());
}

TEST(Pose, AMovingHandShowsNone) {
    Stage stage(poses());
    Bent first = pointing(0);
    Bent last = pointing(3000);
    last.palm_mm.x() += 900.0F;
    play(stage, {first, last}, 60);
    EXPECT_THAT(stage.story(), IsEmpty());
    EXPECT_TRUE(stage.explained("point", "the palm moves"));
}

TEST(Pose, WaversWithoutAnEnd) {
    std::vector<Bent> moments{pointing(0), pointing(900)};
    for (int i = 0; i < 5; ++i) {
        // The index bends to a score of 0.7, and once in a while to none for a moment.
        moments.push_back(pointing(1000 + 200 * i, 75));
        moments.push_back(pointing(1100 + 200 * i));
    }
    moments.push_back(pointing(2200));
    Stage stage(poses());
    play(stage, moments, 60, kFingersUp);
    EXPECT_THAT(stage.story(), ElementsAre("point begin"));
}

TEST(Pose, IsCancelledWhenItsHandIsLost) {
    Stage stage(poses());
    play(stage, {pointing(0), pointing(1500)}, 60);
    ASSERT_THAT(stage.story(), ElementsAre("point begin"));
    stage.keep(stage.recogniser.advance(Stamp::from_us(1'700'000)));
    EXPECT_THAT(stage.story(), ElementsAre("point begin", "point cancel lost"));
}

TEST(Pose, AStrokeTakesTheHand) {
    GestureSettings settings = poses();
    settings.swipe = true;
    Stage stage(settings);
    const Vec3f rest{0.0F, 0.0F, 400.0F};
    Bent moved = open_hand(1500);
    moved.palm_mm = rest - Vec3f{250.0F, 0.0F, 0.0F};
    Bent after = moved;
    after.ms = 1800;
    play(stage, {open_hand(0), open_hand(1200), moved, after}, 60, kFingersUp);
    EXPECT_THAT(stage.story(),
                ElementsAre("open_palm begin", "swipe_left", "open_palm cancel superseded"));
}

TEST(Pose, OfACamerasHandByItsExtensions) {
    Hand hand;
    hand.finger_extension = {1.0F, 1.0F, 1.0F, 1.0F, 1.0F};
    const auto score = [&](GestureType pose) {
        return recognise::pose_score(pose, recognise::sample_of(hand, Stamp{}, Duration::zero()));
    };
    EXPECT_EQ(score(GestureType::open_palm), 1.0);
    hand.finger_extension = {0.0F, 1.0F, 1.0F, 0.1F, 0.0F};
    EXPECT_EQ(score(GestureType::victory), 1.0);
    EXPECT_LE(score(GestureType::open_palm), 0.1);
    // A folded finger's knuckle may stand out, as a finger counts as extended from 0.35 on.
    hand.finger_extension = {0.0F, 1.0F, 1.0F, 0.35F, 0.0F};
    EXPECT_NEAR(score(GestureType::victory), 0.81, 0.005);
    hand.finger_extension = {0.0F, 1.0F, 1.0F, 0.45F, 0.0F};
    EXPECT_LT(score(GestureType::victory), 0.7);
    hand.finger_extension = {0.45F, 1.0F, 1.0F, 0.0F, 0.0F};
    EXPECT_LT(score(GestureType::victory), 0.7);
    hand.finger_extension = {0.35F, 0.35F, 0.35F, 0.35F, 0.35F};
    EXPECT_NEAR(score(GestureType::fist), 0.81, 0.005);
    EXPECT_LT(score(GestureType::thumb_up), 0.5);
    hand.finger_extension = {-1.0F, -1.0F, -1.0F, -1.0F, -1.0F};
    for (const GestureType pose : kPoses) {
        EXPECT_EQ(score(pose), 0.0) << to_string(pose);
    }
}

}  // namespace
}  // namespace xtrack::test
