// SPDX-License-Identifier: Apache-2.0
#include <xtrack/depth_decoder.hpp>

#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/core/pipeline/plane_scene.hpp"

namespace xtrack {
namespace {

using test::plane_frame;
using test::plane_rig;

constexpr double kWall = 700.0;

PatternSequence wide() { return three_step_sequence(Axis::x, {512, 384}, 512.0); }
PatternSequence dual() { return dual_sequence(Axis::x, {512, 384}, 512.0, 64.0); }
PatternSequence gray() { return gray_code_sequence(Axis::x, {512, 384}, 32.0); }

DepthDecoder make(const PatternSequence& patterns, DecodeSettings settings = {}) {
    auto made = DepthDecoder::create(plane_rig(), patterns, plane_rig().camera.size, settings);
    EXPECT_TRUE(made) << made.error().message;
    return *std::move(made);
}

// Share of all pixels with a depth within 1 % of the wall, and of those with none.
struct Score {
    double good = 0.0;
    double none = 0.0;
};
Score score(const DepthFrame& depth, double z_mm, int row_begin = 0, int row_end = 64) {
    Score s;
    const double count = depth.depth.width() * (row_end - row_begin);
    for (int y = row_begin; y < row_end; ++y) {
        for (int x = 0; x < depth.depth.width(); ++x) {
            const double z = depth.depth.at(x, y) * 0.1;
            s.none += z == 0.0 ? 1.0 : 0.0;
            s.good += std::fabs(z - z_mm) < 0.01 * z_mm ? 1.0 : 0.0;
        }
    }
    return {s.good / count, s.none / count};
}

class EverySequence : public testing::TestWithParam<int> {
 protected:
    PatternSequence patterns() const {
        return GetParam() == 0 ? wide() : GetParam() == 1 ? dual() : gray();
    }
};
INSTANTIATE_TEST_SUITE_P(WideDualGray, EverySequence, testing::Values(0, 1, 2));

TEST_P(EverySequence, GivesTheWallFromTheFirstCompleteSetOnInAnyOrder) {
    const PatternSequence patterns = this->patterns();
    const int count = static_cast<int>(patterns.patterns.size());
    for (const PixelFormat format : {PixelFormat::grey8, PixelFormat::bgr8}) {
        DepthDecoder decoder = make(patterns);
        EXPECT_EQ(decoder.frames_needed(), count);
        for (int n = 0; n < 3 * count; ++n) {
            // Begins in the middle of the sequence.
            const auto frame =
                plane_frame(plane_rig(), patterns, (n + 2) % count, n, kWall, format);
            const DecodeStatus status = decoder.push(frame);
            ASSERT_EQ(status.state,
                      n + 1 < count ? DecodeState::need_more : DecodeState::depth_ready);
            if (status.state == DecodeState::depth_ready) {
                const Score s = score(decoder.depth(), kWall);
                // The projector does not light the whole image.
                EXPECT_GT(s.good, 0.95) << n;
                EXPECT_LT(s.none, 0.05) << n;
            }
        }
    }
}

TEST_P(EverySequence, BridgesLostFramesWithOlderOnes) {
    const PatternSequence patterns = this->patterns();
    const int count = static_cast<int>(patterns.patterns.size());
    DepthDecoder decoder = make(patterns);
    for (int n = 0; n < 4 * count; ++n) {
        if (n >= count && n % 4 == 1) {
            continue;
        }
        const DecodeStatus status =
            decoder.push(plane_frame(plane_rig(), patterns, n % count, n, kWall));
        if (n + 1 >= count) {
            ASSERT_EQ(status.state, DecodeState::depth_ready);
            EXPECT_GT(score(decoder.depth(), kWall).good, 0.95);
        }
    }
}

TEST(DepthDecoder, StampsTheNewestFrameWhenItFollowsMotionAndTheCentreOtherwise) {
    DecodeSettings settings;
    DepthDecoder following = make(wide(), settings);
    settings.motion = MotionHandling::off;
    DepthDecoder centred = make(wide(), settings);
    for (int n = 0; n < 9; ++n) {
        const auto frame = plane_frame(plane_rig(), wide(), n % 3, n, kWall);
        following.push(frame);
        centred.push(frame);
        if (n >= 2) {
            EXPECT_EQ(following.depth().sequence, static_cast<std::uint64_t>(n));
            EXPECT_EQ(following.depth().stamp, frame->stamp);
            // Three images at first, then the five of the 3+2 taps.
            const int centre = n < 4 ? n - 1 : n - 2;
            EXPECT_EQ(centred.depth().sequence, static_cast<std::uint64_t>(centre)) << n;
            EXPECT_EQ(centred.depth().stamp, Stamp::from_us(10000 * centre));
            EXPECT_EQ(following.depth().span, std::chrono::milliseconds{n < 4 ? 20 : 40}) << n;
        }
    }
}

TEST_P(EverySequence, SpansTheImagesThatItIsMadeOf) {
    DecodeSettings settings;
    settings.taps = PhaseTaps::least_squares;
    const PatternSequence patterns = this->patterns();
    const int count = static_cast<int>(patterns.patterns.size());
    DepthDecoder decoder = make(patterns, settings);
    for (int n = 0; n < 3 * count; ++n) {
        decoder.push(plane_frame(plane_rig(), patterns, n % count, n, kWall));
        if (n + 1 >= count) {
            EXPECT_EQ(decoder.depth().span, std::chrono::milliseconds{10 * (count - 1)}) << n;
        }
    }
}

TEST(DepthDecoder, RejectsFramesItCannotUseAndGoesOn) {
    DepthDecoder decoder = make(wide());
    const Rig rig = plane_rig();
    const auto reason = [&](const FramePtr& frame) {
        const DecodeStatus status = decoder.push(frame);
        EXPECT_EQ(status.state, DecodeState::rejected);
        EXPECT_NE(std::string(describe(status.reason)), "");
        return status.reason;
    };
    ASSERT_EQ(decoder.push(plane_frame(rig, wide(), 0, 5, kWall)).state, DecodeState::need_more);
    EXPECT_EQ(reason(nullptr), RejectReason::damaged);
    auto frame = plane_frame(rig, wide(), 1, 6, kWall);
    frame->status = FrameStatus::damaged;
    EXPECT_EQ(reason(frame), RejectReason::damaged);
    EXPECT_EQ(reason(plane_frame(plane_rig({97, 64}), wide(), 1, 6, kWall)),
              RejectReason::wrong_size);
    frame = plane_frame(rig, wide(), 1, 6, kWall);
    frame->pattern = kUnknownPattern;
    EXPECT_EQ(reason(frame), RejectReason::unknown_pattern);
    for (const int pattern : {3, 1000, -2}) {
        frame = plane_frame(rig, wide(), 1, 6, kWall);
        frame->pattern = pattern;
        EXPECT_EQ(reason(frame), RejectReason::pattern_out_of_range);
    }
    EXPECT_EQ(reason(plane_frame(rig, wide(), 1, 4, kWall)), RejectReason::time_backwards);
    // Equal stamps are allowed.
    EXPECT_EQ(decoder.push(plane_frame(rig, wide(), 1, 5, kWall)).state, DecodeState::need_more);
    EXPECT_EQ(decoder.push(plane_frame(rig, wide(), 2, 5, kWall)).state, DecodeState::depth_ready);
    decoder.reset();
    EXPECT_EQ(decoder.push(plane_frame(rig, wide(), 2, 1, kWall)).state, DecodeState::need_more);
}

TEST(DepthDecoder, UsesOlderFramesForRowsThatWereNotCleanAndMasksTheRest) {
    DecodeSettings settings;
    settings.motion = MotionHandling::off;
    settings.taps = PhaseTaps::least_squares;
    DepthDecoder decoder = make(wide(), settings);
    for (int n = 0; n < 3; ++n) {
        auto frame = plane_frame(plane_rig(), wide(), n, n, kWall);
        if (n == 1) {
            frame->clean_row_begin = 20;
            frame->clean_row_end = 40;
        }
        decoder.push(frame);
    }
    EXPECT_GT(score(decoder.depth(), kWall, 20, 40).good, 0.95);
    EXPECT_DOUBLE_EQ(score(decoder.depth(), kWall, 0, 20).none, 1.0);
    EXPECT_DOUBLE_EQ(score(decoder.depth(), kWall, 40, 64).none, 1.0);
    // The same pattern again, clean elsewhere: the two together cover the image.
    auto rest = plane_frame(plane_rig(), wide(), 1, 3, kWall);
    rest->clean_row_begin = 40;
    decoder.push(rest);
    EXPECT_GT(score(decoder.depth(), kWall, 20, 64).good, 0.95);
    EXPECT_DOUBLE_EQ(score(decoder.depth(), kWall, 0, 20).none, 1.0);
}

TEST(DepthDecoder, FollowsTheDepthOfASceneThatJumps) {
    DepthDecoder decoder = make(wide());
    for (int n = 0; n < 24; ++n) {
        decoder.push(plane_frame(plane_rig(), wide(), n % 3, n, n < 12 ? 700.0 : 900.0));
    }
    EXPECT_GT(score(decoder.depth(), 900.0).good, 0.85);
}

TEST(DepthDecoder, TakesTheOrderFromADepthImage) {
    DecodeSettings settings;
    settings.order = OrderSource::depth_image;
    const PatternSequence fine = three_step_sequence(Axis::x, {512, 384}, 32.0);
    DepthDecoder decoder = make(fine, settings);
    Image<std::uint16_t> rough(96, 64, 7080);  // 8 mm off: 1 px of 32
    rough.at(10, 10) = 0;
    ASSERT_TRUE(decoder.set_order_depth(rough.view(), 0.1));
    for (int n = 0; n < 3; ++n) {
        decoder.push(plane_frame(plane_rig(), fine, n, n, kWall));
    }
    EXPECT_GT(score(decoder.depth(), kWall).good, 0.95);
    EXPECT_EQ(decoder.depth().depth.at(10, 10), 0);
    EXPECT_FALSE(decoder.set_order_depth(Image<std::uint16_t>(5, 5).view(), 0.1));
    EXPECT_FALSE(decoder.set_order_depth(rough.view(), 0.0));
    EXPECT_FALSE(make(wide()).set_order_depth(rough.view(), 0.1));
}

TEST(DepthDecoder, KeepsItsMapsOnRequest) {
    DecodeSettings settings;
    settings.keep_maps = true;
    DepthDecoder decoder = make(dual(), settings);
    for (int n = 0; n < 6; ++n) {
        decoder.push(plane_frame(plane_rig(), dual(), n, n, kWall));
    }
    const double x = test::plane_coordinate(plane_rig(), 40, kWall);
    EXPECT_NEAR(decoder.coordinate_px().at(40, 30), x, 0.1);
    EXPECT_EQ(decoder.phase().period_px, 64.0);
    EXPECT_NEAR(
        std::remainder(decoder.phase().phase_rad.at(40, 30) - 2.0 * std::numbers::pi * x / 64.0,
                       2.0 * std::numbers::pi),
        0.0, 0.02);
    EXPECT_NEAR(decoder.phase().modulation.at(40, 30), 90.0F, 1.0F);
    EXPECT_NEAR(decoder.average().at(40, 30), 120.0F, 1.0F);
    EXPECT_EQ(decoder.depth().quality.at(40, 30),
              std::lround(decoder.phase().modulation.at(40, 30)));
    EXPECT_TRUE(make(dual()).coordinate_px().empty());
}

// Black, white, then the bits; instead of black and white, every bit once more, inverted.
PatternSequence gray_with_inverses() {
    PatternSequence sequence = gray_code_sequence(Axis::x, {512, 384}, 32.0);
    std::erase_if(sequence.patterns,
                  [](const Pattern& p) { return p.kind != PatternKind::gray_code; });
    const std::size_t bits = sequence.patterns.size();
    for (std::size_t bit = 0; bit < bits; ++bit) {
        Pattern inverse = sequence.patterns[bit];
        inverse.inverted = true;
        sequence.patterns.push_back(inverse);
    }
    return sequence;
}

TEST(DepthDecoder, AveragesABitAndItsInverseWhereNoFlatIs) {
    DecodeSettings settings;
    settings.keep_maps = true;
    const PatternSequence patterns = gray_with_inverses();
    DepthDecoder decoder = make(patterns, settings);
    for (int n = 0; n < decoder.frames_needed(); ++n) {
        decoder.push(plane_frame(plane_rig(), patterns, n, n, kWall));
    }
    for (int x = 0; x < 96; ++x) {
        ASSERT_EQ(decoder.average().at(x, 30), 120.0F) << x;
    }
    EXPECT_GT(score(decoder.depth(), kWall).good, 0.0);
}

TEST_P(EverySequence, SettingsChangeWhileItRuns) {
    const PatternSequence patterns = this->patterns();
    const int count = static_cast<int>(patterns.patterns.size());
    DepthDecoder decoder = make(patterns);
    EXPECT_EQ(decoder.decode_again().state, DecodeState::need_more);
    for (int n = 0; n < count; ++n) {
        (void)decoder.push(plane_frame(plane_rig(), patterns, n, n, kWall));
    }
    const double before = score(decoder.depth(), kWall).good;
    DecodeSettings settings;
    settings.min_modulation = 127.0;
    ASSERT_TRUE(decoder.set_settings(settings));
    EXPECT_EQ(score(decoder.depth(), kWall).good, before) << "not before the next decode";
    EXPECT_EQ(decoder.decode_again().state, DecodeState::depth_ready);
    EXPECT_EQ(score(decoder.depth(), kWall).none, 1.0);
    // What needs other memory: the images at hand stay.
    settings = {};
    settings.keep_maps = true;
    settings.motion = MotionHandling::off;
    settings.threads = 2;
    const DepthFrame& given = decoder.depth();
    ASSERT_TRUE(decoder.set_settings(settings));
    EXPECT_EQ(score(decoder.depth(), kWall).none, 1.0) << "that of the last decode";
    EXPECT_EQ(&given, &decoder.depth());
    EXPECT_EQ(decoder.decode_again().state, DecodeState::depth_ready);
    EXPECT_EQ(score(decoder.depth(), kWall).good, before);
    EXPECT_EQ(decoder.sigma_mm().width(), plane_rig().camera.size.width);
    EXPECT_EQ(decoder.push(plane_frame(plane_rig(), patterns, 0, count, kWall)).state,
              DecodeState::depth_ready);

    settings.order_tolerance = 0.6;
    const auto refused = decoder.set_settings(settings);
    ASSERT_FALSE(refused);
    EXPECT_THAT(refused.error().message, testing::HasSubstr("order_tolerance"));
    EXPECT_EQ(decoder.settings().order_tolerance, 0.5);
    settings = decoder.settings();
    settings.taps = PhaseTaps::four_plus_one;
    EXPECT_FALSE(decoder.set_settings(settings)) << "no cycle of four";
    EXPECT_EQ(decoder.decode_again().state, DecodeState::depth_ready);
    EXPECT_EQ(score(decoder.depth(), kWall).good, before);
}

TEST(DepthDecoder, HasNoDepthBeforeItsFirst) {
    const DepthDecoder decoder = make(wide());
    EXPECT_DOUBLE_EQ(score(decoder.depth(), kWall).none, 1.0);
}

TEST(DepthDecoder, DecodesPhaseAloneWithoutARig) {
    DecodeSettings settings;
    settings.order = OrderSource::none;
    settings.keep_maps = true;
    auto made = DepthDecoder::create(Rig{}, wide(), {96, 64}, settings);
    ASSERT_TRUE(made) << made.error().message;
    for (int n = 0; n < 3; ++n) {
        made->push(plane_frame(plane_rig(), wide(), n, n, kWall));
    }
    EXPECT_FALSE(made->depth().metric);
    EXPECT_DOUBLE_EQ(score(made->depth(), kWall).none, 1.0);
    EXPECT_NEAR(made->phase().modulation.at(40, 30), 90.0F, 1.0F);
}

// Before any buffer is made for them: these sizes overflow, or no memory holds them.
TEST(DepthDecoder, SizesThatNoImageHasAreRefused) {
    DecodeSettings settings;
    settings.order = OrderSource::none;
    const PatternSequence patterns = three_step_sequence(Axis::x, {512, 384}, 512.0);
    for (const Size size :
         {Size{0, 48}, Size{64, -1}, Size{1 << 28, 1 << 28}, Size{16384, 16384}, Size{16385, 1}}) {
        const auto made = DepthDecoder::create({}, patterns, size, settings);
        ASSERT_FALSE(made) << size.width << "x" << size.height;
        EXPECT_EQ(made.error().code, ErrorCode::invalid_argument);
        EXPECT_NE(made.error().message.find(std::to_string(size.width) + "x"), std::string::npos)
            << made.error().message;
    }
}

PatternSequence ramps(bool four) {
    PatternSequence s = wide();
    Pattern white;
    white.level = 1.0;
    Pattern ramp;
    ramp.kind = PatternKind::ramp;
    ramp.period_px = 512.0;
    s.patterns = {white, Pattern{}, ramp};
    if (four) {
        ramp.period_px = 128.0;
        s.patterns.push_back(ramp);
    }
    return s;
}

double mean_error_mm(const DepthFrame& depth, double z_mm) {
    double sum = 0.0;
    double count = 0.0;
    for (int y = 0; y < depth.depth.height(); ++y) {
        for (int x = 0; x < depth.depth.width(); ++x) {
            if (depth.depth.at(x, y) != 0) {
                sum += std::fabs(depth.depth.at(x, y) * 0.1 - z_mm);
                count += 1.0;
            }
        }
    }
    return sum / count;
}

// 8 bits for 512 px are half a level a pixel: four ramps are four times finer.
TEST(Ramps, GiveTheWallAsWellAsEightBitsCan) {
    double errors_mm[2] = {};
    for (const bool four : {false, true}) {
        const PatternSequence patterns = ramps(four);
        DepthDecoder decoder = make(patterns);
        for (int n = 0; n < decoder.frames_needed(); ++n) {
            decoder.push(plane_frame(plane_rig(), patterns, n, n, kWall));
        }
        EXPECT_GT(score(decoder.depth(), kWall).good + score(decoder.depth(), kWall).none,
                  four ? 0.9 : 0.3);
        errors_mm[four ? 1 : 0] = mean_error_mm(decoder.depth(), kWall);
    }
    EXPECT_LT(errors_mm[0], 15.0);
    EXPECT_LT(errors_mm[1], 0.4 * errors_mm[0]);
}

TEST(Ramps, NeedWhiteAndBlack) {
    PatternSequence patterns = ramps(false);
    patterns.patterns.erase(patterns.patterns.begin());
    const auto made = DepthDecoder::create(plane_rig(), patterns, plane_rig().camera.size, {});
    ASSERT_FALSE(made);
    EXPECT_NE(made.error().message.find("white and a black"), std::string::npos);
}

TEST(Steps, FourGiveTheWallWhereverTheWindowStarts) {
    const PatternSequence four = n_step_sequence(Axis::x, {512, 384}, 512.0, 4);
    DepthDecoder decoder = make(four);
    for (int n = 0; n < 11; ++n) {
        const DecodeStatus status =
            decoder.push(plane_frame(plane_rig(), four, (n + 2) % 4, n, kWall));
        if (n >= 4) {
            ASSERT_EQ(status.state, DecodeState::depth_ready);
            ASSERT_GT(score(decoder.depth(), kWall).good, 0.97) << n;
        }
    }
}

// Colour fringes: one image is a phase, the other its order.
PatternSequence rgb() { return rgb_sequence(Axis::x, {512, 384}, {512.0, 64.0}); }

TEST(Colour, GivesTheWallWithEveryImageOfTheFinePattern) {
    DepthDecoder decoder = make(rgb());
    EXPECT_EQ(decoder.frames_needed(), 2);
    for (int n = 0; n < 8; ++n) {
        const DecodeStatus status =
            decoder.push(plane_frame(plane_rig(), rgb(), n % 2, n, kWall, PixelFormat::bgr8));
        EXPECT_EQ(status.state, n % 2 == 1 ? DecodeState::depth_ready : DecodeState::need_more);
        if (n % 2 == 1) {
            EXPECT_GT(score(decoder.depth(), kWall).good, 0.98);
            EXPECT_EQ(decoder.depth().stamp, Stamp::from_us(10000 * n));
        }
    }
}

TEST(Colour, GreyFramesAreRefusedWithTheReason) {
    DepthDecoder decoder = make(rgb());
    const DecodeStatus status = decoder.push(plane_frame(plane_rig(), rgb(), 0, 0, kWall));
    EXPECT_EQ(status.state, DecodeState::rejected);
    EXPECT_EQ(status.reason, RejectReason::no_colour);
    EXPECT_NE(std::string(describe(status.reason)).find("colour"), std::string::npos);
}

TEST(Colour, OnePatternWillDoWhereItsPeriodIsUnique) {
    const PatternSequence one = rgb_sequence(Axis::x, {512, 384}, {512.0});
    DepthDecoder decoder = make(one);
    EXPECT_EQ(decoder.frames_needed(), 1);
    for (int n = 0; n < 3; ++n) {
        EXPECT_EQ(decoder.push(plane_frame(plane_rig(), one, 0, n, kWall, PixelFormat::bgr8)).state,
                  DecodeState::depth_ready);
    }
    EXPECT_GT(score(decoder.depth(), kWall).good, 0.9);
}

TEST(Colour, TellsWhatItCannotDecode) {
    PatternSequence both = rgb();
    both.patterns[1].phase_rad = {0.0, 2.0943951, 4.1887902};
    const auto turned = DepthDecoder::create(plane_rig(), both, plane_rig().camera.size, {});
    ASSERT_FALSE(turned);
    EXPECT_NE(turned.error().message.find("both directions"), std::string::npos);
    PatternSequence uneven = rgb();
    uneven.patterns[1].phase_rad = {0.0, 1.0, 2.0};
    uneven.patterns[0].phase_rad = {0.0, 1.0, 2.0};
    EXPECT_FALSE(DepthDecoder::create(plane_rig(), uneven, plane_rig().camera.size, {}));
    PatternSequence twice = rgb();
    twice.patterns.push_back(twice.patterns.back());
    EXPECT_FALSE(DepthDecoder::create(plane_rig(), twice, plane_rig().camera.size, {}));
}

}  // namespace
}  // namespace xtrack
