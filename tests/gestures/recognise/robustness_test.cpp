// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <limits>

#include "tests/gestures/recognise/play_hand.hpp"
#include "tests/support/allocation_counter.hpp"

namespace xtrack::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

Vec3f at(float x, float y = 0.0F, float z = 400.0F) { return {x, y, z}; }

Actor performance() {
    return {{{0, at(150), 75},
             {1000, at(150), 75},
             {1300, at(-150), 75},  // swipe left
             {2600, at(-150), 75},
             {2800, at(-150), 12},  // pinch
             {3600, at(-150), 12},
             {3850, at(-150), 75},
             {4800, at(-150), 75},
             {5200, at(-150, 0, 180), 75},  // push
             {6200, at(-150, 0, 180), 75},
             {6500, at(-150, 280, 180), 75},  // swipe up
             {7500, at(-150, 280, 180), 75}}};
}

class FrameRate : public ::testing::TestWithParam<double> {};

TEST_P(FrameRate, ChangesNothing) {
    Stage stage;
    stage.play(performance(), GetParam());
    EXPECT_THAT(stage.story(),
                ElementsAre("swipe_left", "pinch begin", "pinch end", "push", "swipe_up"));
}

TEST_P(FrameRate, NorDoesNoise) {
    Stage stage;
    Actor actor = performance();
    actor.noise_mm = 2.0;
    stage.play(actor, GetParam());
    EXPECT_THAT(stage.story(),
                ElementsAre("swipe_left", "pinch begin", "pinch end", "push", "swipe_up"));
}

INSTANTIATE_TEST_SUITE_P(Rates, FrameRate, ::testing::Values(15.0, 30.0, 60.0, 120.0));

class Jitter : public ::testing::TestWithParam<double> {};

TEST_P(Jitter, TenMinutesOfARestingHandGiveNothing) {
    for (const double noise_mm : {2.0, 3.0}) {
        for (const double aperture_mm : {70.0, 34.0}) {
            Actor actor{{{0, at(0), aperture_mm}, {600e3, at(0), aperture_mm}}};
            actor.noise_mm = noise_mm;
            Stage stage;
            stage.recogniser.set_trace({});
            stage.play(actor, GetParam());
            EXPECT_THAT(stage.story(), IsEmpty()) << noise_mm << " mm at " << GetParam() << " fps";
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Rates, Jitter, ::testing::Values(15.0, 30.0));

TEST(Jitter60, TenMinutesOfARestingHandGiveNothing) {
    Actor actor{{{0, at(0), 70.0}, {600e3, at(0), 70.0}}};
    actor.noise_mm = 3.0;
    Stage stage;
    stage.recogniser.set_trace({});
    stage.play(actor, 60);
    EXPECT_THAT(stage.story(), IsEmpty());
}

TEST(Robust, SlowWanderingIsNothing) {
    Actor actor{{}, Held::plain};
    for (int i = 0; i <= 60; ++i) {
        const float a = 1.7F * static_cast<float>(i);
        actor.moments.push_back({3000.0 * i, at(120 * std::sin(a), 80 * std::cos(1.3F * a),
                                                400 + 60 * std::sin(2 * a))});
    }
    actor.noise_mm = 2.0;
    Stage stage;
    stage.play(actor, 60);
    EXPECT_THAT(stage.story(), IsEmpty());
}

TEST(Robust, TheSameFramesGiveTheSameBits) {
    const auto lines = [] {
        Stage stage;
        Actor actor = performance();
        actor.noise_mm = 2.0;
        stage.play(actor, 60);
        std::vector<std::string> out;
        for (const GestureEvent& e : stage.events) {
            out.push_back(to_json(e));
        }
        return out;
    };
    EXPECT_EQ(lines(), lines());
}

TEST(Robust, StampsThatRepeatOrGoBackAreSkipped) {
    Stage stage;
    Noise noise(1);
    const Actor actor{{{0, at(0)}}};
    HandFrame frame;
    frame.coordinates = CoordinateFrame::interaction;
    frame.count = 1;
    frame.hands[0] = hand_of(actor, actor.moments[0], noise);
    frame.stamp = Stamp::from_us(1000);
    stage.keep(stage.recogniser.push(frame));
    EXPECT_EQ(stage.recogniser.status(), RecogniseStatus::ok);
    stage.keep(stage.recogniser.push(frame));
    EXPECT_EQ(stage.recogniser.status(), RecogniseStatus::repeated_stamp);
    frame.stamp = Stamp::from_us(999);
    stage.keep(stage.recogniser.push(frame));
    EXPECT_EQ(stage.recogniser.status(), RecogniseStatus::decreasing_stamp);
    frame.stamp = Stamp::from_us(2000);
    frame.coordinates = CoordinateFrame::camera;
    stage.keep(stage.recogniser.push(frame));
    EXPECT_EQ(stage.recogniser.status(), RecogniseStatus::wrong_frame);
    EXPECT_THAT(stage.events, IsEmpty());
}

TEST(Robust, WhatIsNoNumberIsNotSeen) {
    Stage stage;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float inf = std::numeric_limits<float>::infinity();
    Noise noise(1);
    for (int i = 0; i < 120; ++i) {
        const Actor actor{{{0, at(0), 12}}};
        HandFrame frame;
        frame.stamp = Stamp::from_us(16'667LL * i);
        frame.coordinates = CoordinateFrame::interaction;
        frame.count = 1;
        Hand& hand = frame.hands[0];
        hand = hand_of(actor, actor.moments[0], noise);
        switch (i % 5) {
            case 0: hand.palm_mm.x() = nan; break;
            case 1: hand.confidence = nan; break;
            case 2: hand.pinch_aperture_mm = inf; break;
            case 3: put(hand, Joint::index_proximal, {nan, nan, nan}); break;
            case 4: hand.fingertip(Finger::index).position_mm.y() = inf; break;
        }
        stage.keep(stage.recogniser.push(frame));
        for (const GestureEvent& e : stage.events) {
            EXPECT_TRUE(e.position_mm.allFinite());
            EXPECT_TRUE(e.velocity_mmps.allFinite());
        }
    }
    EXPECT_THAT(stage.story(), IsEmpty());
}

TEST(Robust, NoHeapInSteadyState) {
    if (!counts_allocations()) {
        GTEST_SKIP()
            << "allocations cannot be counted here: no glibc, or a sanitizer is in its way";
    }
    auto recogniser = std::move(*GestureRecogniser::create());
    Noise noise(1);
    Actor actor = performance();
    actor.held = Held::plain;
    std::vector<HandFrame> frames(450);
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const double ms = 1000.0 * static_cast<double>(i) / 60.0;
        frames[i].stamp = Stamp{static_cast<std::int64_t>(ms * 1e6)};
        frames[i].coordinates = CoordinateFrame::interaction;
        frames[i].count = 1;
        frames[i].hands[0] = hand_of(actor, actor.where(ms), noise);
    }
    std::size_t events = 0;
    const long before = allocations();
    for (const HandFrame& frame : frames) {
        events += recogniser.push(frame).size();
        events += recogniser.advance(frame.stamp + std::chrono::milliseconds{10}).size();
    }
    EXPECT_EQ(allocations() - before, 0);
    EXPECT_GT(events, 20U);
}

TEST(Robust, ALongGapEndsEverything) {
    Stage stage;
    stage.play(Actor{{{0, at(0), 75}, {800, at(0), 75}, {950, at(0), 12}, {1500, at(0), 12}}}, 60);
    stage.play(Actor{{{5000, at(0), 12}, {5500, at(0), 12}}}, 60);
    EXPECT_THAT(stage.story(), ElementsAre("pinch begin", "pinch cancel lost"));
}

TEST(Robust, ResetStartsAnew) {
    Stage stage;
    stage.play(performance(), 60);
    const int last_id = stage.events.back().gesture_id;
    stage.events.clear();
    stage.recogniser.reset();
    stage.play(performance(), 60);
    EXPECT_THAT(stage.story(),
                ElementsAre("swipe_left", "pinch begin", "pinch end", "push", "swipe_up"));
    EXPECT_GT(stage.first(GestureType::swipe, EventPhase::begin)->gesture_id, last_id);
}

}  // namespace
}  // namespace xtrack::test
