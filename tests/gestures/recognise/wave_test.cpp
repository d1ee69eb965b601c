// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "tests/gestures/recognise/play_hand.hpp"

namespace xtrack::test {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Not;

struct Waving {
    double width_mm = 80.0;
    int strokes = 7;
    double stroke_ms = 280.0;
    double rises_mm = 0.0;  ///< up and down from turn to turn
    double noise_mm = 0.0;
};

Actor waving(const Waving& w) {
    Actor actor;
    actor.noise_mm = w.noise_mm;
    actor.moments = {{0, {0, 0, 400}}, {800, {0, 0, 400}}};
    double ms = 800;
    for (int i = 0; i < w.strokes; ++i) {
        const auto side = static_cast<float>(i % 2 == 0 ? 0.5 * w.width_mm : -0.5 * w.width_mm);
        const auto up = static_cast<float>(i % 2 == 0 ? w.rises_mm : 0.0);
        ms += w.stroke_ms;
        actor.moments.push_back({ms, {side, up, 400}});
    }
    actor.moments.push_back({ms + 300, {0, 0, 400}});
    actor.moments.push_back({ms + 1200, {0, 0, 400}});
    return actor;
}

GestureSettings with_wave() {
    GestureSettings settings;
    settings.wave = true;
    return settings;
}

std::vector<std::string> story_of(const Actor& actor, double fps = 60,
                                  const GestureSettings& settings = with_wave()) {
    Stage stage(settings);
    stage.play(actor, fps);
    return stage.story();
}

TEST(Wave, FourTurnsAreOne) {
    for (const double fps : {15.0, 30.0, 60.0, 120.0}) {
        EXPECT_THAT(story_of(waving({}), fps), ElementsAre("wave")) << fps;
    }
    EXPECT_THAT(story_of(waving({.strokes = 4})), Not(Contains("wave")));
}

TEST(Wave, HoldsWithTheNoiseOfADepthCamera) {
    for (const double fps : {30.0, 60.0}) {
        EXPECT_THAT(story_of(waving({.noise_mm = 2.0}), fps), ElementsAre("wave")) << fps;
    }
}

TEST(Wave, AWristThatIsTakenForThePalmDoesNotSpoilIt) {
    // For one image in 16, 70 mm below; in one of three it is a hand that goes up and down.
    const auto with_wrists = [](int period) {
        Actor actor = waving({});
        actor.change = [period](double ms, Hand& hand) {
            const int image = static_cast<int>(std::lround(ms * 60.0 / 1000.0));
            hand.palm_mm.y() -= image % period == 0 ? 70.0F : 0.0F;
        };
        return actor;
    };
    GestureSettings only_waves = with_wave();
    only_waves.circle = only_waves.swipe = false;
    EXPECT_THAT(story_of(with_wrists(16), 60, only_waves), ElementsAre("wave"));
    EXPECT_THAT(story_of(with_wrists(3), 60, only_waves), IsEmpty());
}

TEST(Wave, IsOffUnlessAskedFor) {
    EXPECT_THAT(story_of(waving({}), 60, GestureSettings{}), Not(Contains("wave")));
}

TEST(Wave, SmallSlowOrSlantingIsNone) {
    EXPECT_THAT(story_of(waving({.width_mm = 40.0})), IsEmpty());
    EXPECT_THAT(story_of(waving({.stroke_ms = 700.0})), Not(Contains("wave")));
    EXPECT_THAT(story_of(waving({.rises_mm = 70.0})), Not(Contains("wave")));
}

TEST(Wave, GoesOnWithoutASecondUntilTheHandRests) {
    EXPECT_THAT(story_of(waving({.strokes = 15})), ElementsAre("wave"));
    Actor twice = waving({});
    const Actor again = waving({});
    const double later = twice.moments.back().ms;
    for (const At& at : again.moments) {
        twice.moments.push_back(at);
        twice.moments.back().ms += later + 1.0;
    }
    EXPECT_THAT(story_of(twice), ElementsAre("wave", "wave"));
}

// To the other side first, with and without a rest there: the stroke that follows is a swipe.
TEST(Wave, AWindUpDoesNotBlockASwipe) {
    for (const double rest_ms : {0.0, 500.0}) {
        Actor actor;
        const double stroke_ms = 1300 + rest_ms;
        actor.moments = {{0, {0, 0, 400}},
                         {800, {0, 0, 400}},
                         {1300, {70, 0, 400}},
                         {stroke_ms, {70, 0, 400}},
                         {stroke_ms + 350, {-130, 0, 400}},
                         {stroke_ms + 1350, {-130, 0, 400}}};
        EXPECT_THAT(story_of(actor), ElementsAre("swipe_left")) << rest_ms;
    }
}

// Strokes of a wide wave are as long and fast as swipes; the first may be one.
TEST(Wave, ItsLaterStrokesAreNoSwipes) {
    const auto story = story_of(waving({.width_mm = 160.0, .strokes = 9}));
    EXPECT_THAT(story, Contains("wave"));
    EXPECT_LE(story.size(), 2U);
}

TEST(Wave, TellsItsTurnsAndWhenItBegan) {
    Stage stage(with_wave());
    stage.play(waving({}), 60);
    const GestureEvent* wave = stage.first(GestureType::wave, EventPhase::end);
    ASSERT_NE(wave, nullptr);
    EXPECT_EQ(wave->value, 4.0F);
    EXPECT_NEAR(static_cast<double>(wave->onset.us()) * 1e-3, 1360.0, 40.0);
    EXPECT_LT(to_seconds(wave->sensor - wave->onset), 1.1);
}

TEST(Wave, AHandThatIsLostOrAtTheBorderDoesNotWave) {
    Actor lost = waving({});
    for (std::size_t i = 5; i < 7; ++i) {
        lost.moments[i].seen = false;
    }
    EXPECT_THAT(story_of(lost), Not(Contains("wave")));
    Actor border = waving({});
    for (At& at : border.moments) {
        at.border = true;
    }
    EXPECT_THAT(story_of(border), Not(Contains("wave")));
}

TEST(Wave, SettingsAreChecked) {
    GestureSettings settings;
    settings.wave_turns = 1;
    EXPECT_FALSE(validate(settings));
    settings = {};
    settings.wave_stroke_mm = 5.0;
    EXPECT_FALSE(validate(settings));
}

}  // namespace
}  // namespace xtrack::test
