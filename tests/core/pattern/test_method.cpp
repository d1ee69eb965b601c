// SPDX-License-Identifier: Apache-2.0
#include <xtrack/method.hpp>

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace xtrack {
namespace {

using testing::HasSubstr;

Rig rig() {
    Rig rig;
    rig.camera.matrix << 600.0, 0.0, 319.5, 0.0, 600.0, 239.5, 0.0, 0.0, 1.0;
    rig.camera.size = {640, 480};
    Pinhole projector;
    projector.matrix << 1400.0, 0.0, 511.5, 0.0, 1400.0, 383.5, 0.0, 0.0, 1.0;
    projector.size = {1024, 768};
    rig.projector = projector;
    rig.projector_from_camera_T << 200.0, 0.0, 0.0;
    rig.working_volume = WorkingVolume{400.0, 950.0};
    return rig;
}

TEST(Methods, AreKnownByTheirNames) {
    EXPECT_EQ(methods().size(), 12U);
    for (const MethodInfo& one : methods()) {
        EXPECT_EQ(method_of(one.name), one.method);
        EXPECT_EQ(info(one.method).name, one.name);
        EXPECT_GT(std::string(one.summary).size(), 10U);
    }
    EXPECT_FALSE(method_of("magic"));
    EXPECT_FALSE(method_of(""));
}

TEST(Methods, GiveSequencesThatAreValid) {
    for (const MethodInfo& one : methods()) {
        const auto sequence = method_sequence(one.method, rig(), Axis::x);
        ASSERT_TRUE(sequence) << one.name << sequence.error().message;
        EXPECT_TRUE(validate(*sequence)) << one.name;
        EXPECT_EQ(sequence->patterns.size() > 1, one.changes) << one.name;
        bool colour = false;
        for (const Pattern& p : sequence->patterns) {
            colour = colour || p.kind == PatternKind::rgb_sine;
        }
        EXPECT_EQ(colour, one.colour) << one.name;
    }
    // Unique from 400 to 950 mm: 1400 * 200 * (1 / 400 - 1 / 950) px, and 2 %.
    const auto grey = method_sequence(Method::grey, rig(), Axis::x);
    EXPECT_NEAR(grey->patterns[0].period_px, 405.3 * 1.02, 1.5);
    EXPECT_EQ(method_sequence(Method::triple, rig(), Axis::x)->patterns.size(), 9U);
    EXPECT_EQ(method_sequence(Method::four_step, rig(), Axis::x)->patterns.size(), 4U);
}

TEST(Methods, SayWhatARigLacks) {
    Rig none = rig();
    none.working_volume.reset();
    const auto grey = method_sequence(Method::grey, none, Axis::x);
    ASSERT_FALSE(grey);
    EXPECT_THAT(grey.error().message, HasSubstr("working_volume_mm"));
    none.projector.reset();
    EXPECT_FALSE(method_sequence(Method::paper, none, Axis::x));
}

MethodNeeds webcam() {
    MethodNeeds needs;
    needs.colour = true;
    needs.frame_hz = 30.0;
    needs.hold_frames = 2;
    needs.hand_mmps = 185.0;
    return needs;
}

TEST(Auto, TakesColourThatNeverChangesForAHandOnAWebcam) {
    const auto chosen = choose_method(webcam());
    ASSERT_TRUE(chosen) << chosen.error().message;
    EXPECT_EQ(chosen->method, Method::rgb_static);
    EXPECT_THAT(chosen->reason, HasSubstr("m/s"));
    EXPECT_NEAR(chosen->hand_mmps, 990.0, 1.0) << "33 mm an image, 30 images a second";
}

TEST(Auto, PrefersPatternsThatNeverChange) {
    MethodNeeds needs = webcam();
    needs.metric = false;
    needs.colour_works = true;
    EXPECT_EQ(choose_method(needs)->method, Method::rgb_static);
    EXPECT_THAT(choose_method(needs)->reason, HasSubstr("never changes"));
    needs.colour_works = false;
    EXPECT_EQ(choose_method(needs)->method, Method::ftp);
}

TEST(Auto, RefusesWithAWordWhatCannotCarryTheGestures) {
    MethodNeeds needs = webcam();
    needs.colour = false;
    const MethodVerdict rgb = judge(Method::rgb, needs);
    EXPECT_FALSE(rgb.possible);
    EXPECT_THAT(rgb.reason, HasSubstr("colour camera"));
    const MethodVerdict grey = judge(Method::grey, needs);
    EXPECT_FALSE(grey.possible);
    EXPECT_THAT(grey.reason, HasSubstr("0.19 m/s"));
    EXPECT_THAT(judge(Method::dual, needs).reason, HasSubstr("at rest"));
    EXPECT_THAT(judge(Method::ftp, needs).reason, HasSubstr("relative"));
    const auto none = choose_method(needs);
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().code, ErrorCode::unsupported);
    needs.static_only = true;
    EXPECT_THAT(judge(Method::grey, needs).reason, HasSubstr("change"));
    needs = webcam();
    needs.colour_works = false;
    EXPECT_THAT(judge(Method::rgb, needs).reason, HasSubstr("self-test"));
}

TEST(Auto, ASceneAtRestGetsTheFewestImages) {
    MethodNeeds needs;
    needs.frame_hz = 60.0;
    needs.hand_mmps = 200.0;
    EXPECT_EQ(choose_method(needs)->method, Method::grey);
}

}  // namespace
}  // namespace xtrack
