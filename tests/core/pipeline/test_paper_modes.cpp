// SPDX-License-Identifier: Apache-2.0
#include <xtrack/paper_decoder.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <xtrack/method.hpp>
#include <xtrack/sim.hpp>

#include "tests/core/pipeline/paper_scene.hpp"
#include "tests/core/pipeline/step_scene.hpp"

namespace xtrack {
namespace {

using test::fringes;
using test::make;
using test::plain;
using test::show;
using test::wide_fringes;
using test::with_depth;
using testing::HasSubstr;

TEST(PaperDecoder, SlidesOverTheLastThreeImages) {
    auto decoder = make();
    const test::StepScene scene;
    std::vector<DecodeState> states;
    std::vector<std::uint64_t> centres;
    for (int n = 0; n < 5; ++n) {
        states.push_back(decoder.push(scene.frame(fringes(), n % 3, n)).state);
        centres.push_back(decoder.depth().sequence);
    }
    EXPECT_THAT(states, testing::ElementsAre(DecodeState::need_more, DecodeState::need_more,
                                             DecodeState::depth_ready, DecodeState::depth_ready,
                                             DecodeState::depth_ready));
    EXPECT_THAT(centres, testing::ElementsAre(0, 0, 1, 2, 3));
    EXPECT_EQ(decoder.depth().span, Stamp::from_us(16667 * 2) - Stamp{});
}

TEST(PaperDecoder, ABurstUsesEveryImageOnce) {
    DecodeSettings settings = plain();
    settings.mode = CaptureMode::burst;
    auto decoder = make(settings);
    const test::StepScene scene;
    std::vector<std::uint64_t> centres;
    for (int n = 0; n < 9; ++n) {
        if (decoder.push(scene.frame(fringes(), n % 3, n)).state == DecodeState::depth_ready) {
            centres.push_back(decoder.depth().sequence);
        }
    }
    EXPECT_THAT(centres, testing::ElementsAre(1, 4, 7));
    // An image that is lost leaves its set open until its pattern comes again.
    EXPECT_EQ(decoder.push(scene.frame(fringes(), 0, 9)).state, DecodeState::need_more);
    EXPECT_EQ(decoder.push(scene.frame(fringes(), 2, 11)).state, DecodeState::need_more);
    EXPECT_EQ(decoder.push(scene.frame(fringes(), 0, 12)).state, DecodeState::need_more);
    EXPECT_EQ(decoder.push(scene.frame(fringes(), 1, 13)).state, DecodeState::depth_ready);
}

TEST(PaperDecoder, OnHoldAChangedSettingShowsInTheSameImages) {
    auto decoder = make();
    test::StepScene scene;
    scene.contrast_grey = 60.0;  // an amplitude of 30
    ASSERT_EQ(show(decoder, scene, 0), DecodeState::depth_ready);
    const int before = with_depth(decoder);
    DecodeSettings settings = decoder.settings();
    settings.mode = CaptureMode::hold;
    ASSERT_TRUE(decoder.set_settings(settings));
    EXPECT_EQ(with_depth(decoder), before);
    const std::uint64_t sequence = decoder.depth().sequence;

    const DecodeStatus status = decoder.push(scene.frame(fringes(), 0, 3));
    EXPECT_EQ(status.state, DecodeState::rejected);
    EXPECT_EQ(status.reason, RejectReason::on_hold);
    EXPECT_THAT(describe(status.reason), HasSubstr("on hold"));

    settings.min_modulation = 30.0;  // about half of the pixels reach it
    ASSERT_TRUE(decoder.set_settings(settings));
    const int masked = with_depth(decoder);
    EXPECT_LT(masked, before * 3 / 4);
    EXPECT_GT(masked, 0);
    settings.min_modulation = 6.0;
    ASSERT_TRUE(decoder.set_settings(settings));
    EXPECT_EQ(with_depth(decoder), before);
    EXPECT_EQ(decoder.decode_again().state, DecodeState::depth_ready);
    EXPECT_EQ(with_depth(decoder), before);
    EXPECT_EQ(decoder.depth().sequence, sequence);

    settings.min_component_px = 1 << 20;  // more than the image has
    ASSERT_TRUE(decoder.set_settings(settings));
    EXPECT_EQ(with_depth(decoder), 0);
}

TEST(PaperDecoder, SettingsChangeWhileItRuns) {
    auto decoder = make();
    test::StepScene scene;
    scene.contrast_grey = 60.0;
    ASSERT_EQ(show(decoder, scene, 0), DecodeState::depth_ready);
    const int before = with_depth(decoder);
    DecodeSettings settings = plain();
    settings.min_modulation = 40.0;
    ASSERT_TRUE(decoder.set_settings(settings));
    EXPECT_EQ(with_depth(decoder), before) << "not before the next decode";
    ASSERT_EQ(show(decoder, scene, 1), DecodeState::depth_ready);
    EXPECT_EQ(with_depth(decoder), 0);

    settings.min_modulation = 128.0;
    const auto refused = decoder.set_settings(settings);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::invalid_argument);
    EXPECT_THAT(refused.error().message, HasSubstr("min_modulation"));
    EXPECT_EQ(decoder.settings().min_modulation, 40.0);
}

// What moves is followed from then on, and no longer once it is switched off.
TEST(PaperDecoder, MotionIsSwitchedWhileItRuns) {
    auto decoder = make(plain(), nullptr, wide_fringes());
    const auto sequence_of = [&](int number) {
        EXPECT_EQ(show(decoder, test::StepScene{}, number, wide_fringes()),
                  DecodeState::depth_ready);
        return decoder.depth().sequence;
    };
    EXPECT_EQ(sequence_of(0), 1U) << "the middle of its images";
    DecodeSettings settings = plain();
    settings.motion = MotionHandling::follow;
    ASSERT_TRUE(decoder.set_settings(settings));
    for (int number = 1; number < 4; ++number) {
        EXPECT_EQ(sequence_of(number), 3U * static_cast<unsigned>(number) + 2U) << "the newest";
    }
    const int followed = with_depth(decoder);
    settings.mode = CaptureMode::hold;
    settings.min_modulation = 127.0;
    ASSERT_TRUE(decoder.set_settings(settings));
    EXPECT_EQ(with_depth(decoder), 0);
    settings.min_modulation = 6.0;
    ASSERT_TRUE(decoder.set_settings(settings));
    EXPECT_EQ(with_depth(decoder), followed);
    ASSERT_TRUE(decoder.set_settings(plain()));
    EXPECT_EQ(sequence_of(4), 13U);
}

TEST(PaperDecoder, NothingToHoldIsNoDecode) {
    DecodeSettings settings = plain();
    settings.mode = CaptureMode::hold;
    auto decoder = make(settings);
    EXPECT_EQ(decoder.decode_again().state, DecodeState::need_more);
    ASSERT_FALSE(decoder.learn_background());
}

}  // namespace
}  // namespace xtrack
