// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>

#include <xtrack/depth.hpp>

#include "tests/core/sim/small_rig.hpp"

namespace xtrack {
namespace {

using testing::HasSubstr;

std::uint64_t hash_of(SimulatedRig& rig) {
    std::uint64_t hash = 1469598103934665603ULL;  // FNV-1a
    const auto add = [&hash](std::uint64_t v) { hash = (hash ^ v) * 1099511628211ULL; };
    for (;;) {
        const FrameSource::Item item = rig.next({});
        if (item.status != SourceStatus::ok) {
            return hash;
        }
        const Frame& f = *item.frame;
        add(static_cast<std::uint64_t>(f.stamp.ns));
        add(static_cast<std::uint64_t>(f.pattern));
        for (int y = 0; y < f.height(); ++y) {
            for (int x = 0; x < f.pixels.width(); ++x) {
                add(f.pixels.at(x, y));
            }
        }
    }
}

TEST(SimulatedRig, SameSeedGivesSameBits) {
    for (const char* preset : {"ideal-60", "webcam-30"}) {
        SimSettings s = test::small_settings(preset);
        s.script = {{SimAction::swipe_left, SimHand::right, -1.0, 1.0}};
        s.duration_s = 0.3;
        EXPECT_EQ(hash_of(*test::make_rig(s)), hash_of(*test::make_rig(s))) << preset;
    }
}

TEST(SimulatedRig, AnotherSeedGivesAnotherRecording) {
    SimSettings s = test::small_still_hand();
    const std::uint64_t first = hash_of(*test::make_rig(s));
    s.seed = 2;
    EXPECT_NE(first, hash_of(*test::make_rig(s)));
}

TEST(SimulatedRig, TruthAgreesWithItself) {
    SimSettings s = test::small_still_hand();
    const auto rig = test::make_rig(s);
    ASSERT_EQ(rig->next({}).status, SourceStatus::ok);
    const SimTruth& truth = rig->truth();
    ASSERT_EQ(truth.hand_count, 1U);
    const SimHandTruth& hand = truth.hands[0];
    ASSERT_TRUE(hand.palm_visible);

    const Mat3d& k = s.rig.camera.matrix;
    const auto pixel = [&k](const Vec3f& p) {
        return std::pair<int, int>(
            static_cast<int>(std::lround(k(0, 0) * p.x() / p.z() + k(0, 2))),
            static_cast<int>(std::lround(k(1, 1) * p.y() / p.z() + k(1, 2))));
    };
    const auto [x, y] = pixel(hand.palm_mm);
    EXPECT_EQ(truth.mask.at(x, y), static_cast<std::uint8_t>(SimPart::hand));
    EXPECT_NEAR(truth.depth.at(x, y) * kDepthUnitMm, hand.palm_mm.z(), 0.11);
    // The circle lies inside the hand, and nothing twice as large would.
    EXPECT_GT(hand.palm_radius_mm, 30.0F);
    EXPECT_LT(hand.palm_radius_mm, 50.0F);
    // The skin of the palm is before the joint in the middle of the hand, by half a hand's depth.
    EXPECT_GT(hand.joints_mm[0].z() - hand.palm_mm.z(), 5.0F);
    EXPECT_LT(hand.joints_mm[0].z() - hand.palm_mm.z(), 30.0F);
    for (std::size_t f = 0; f < kSimFingerCount; ++f) {
        EXPECT_TRUE(hand.tip_visible[f]) << f;
        const auto [tx, ty] = pixel(hand.tips_mm[f]);
        bool touches = false;
        for (int dy = -1; dy <= 1; ++dy) {
            for (int dx = -1; dx <= 1; ++dx) {
                touches = touches || truth.mask.at(tx + dx, ty + dy) == 1;
            }
        }
        EXPECT_TRUE(touches) << f;
    }
    // Right hand, palm to the camera, fingers up: the thumb is to the image's right.
    EXPECT_GT(hand.tips_mm[0].x(), hand.palm_mm.x() + 40.0F);
    EXPECT_LT(hand.tips_mm[2].y(), hand.palm_mm.y() - 90.0F);
    EXPECT_GT(hand.aperture_mm, 50.0F);
    // Length of the hand, wrist to middle tip.
    EXPECT_NEAR((hand.tips_mm[2] - hand.joints_mm[1]).norm(), s.user.hand_length_mm, 8.0);
}

TEST(SimulatedRig, AllPartsAreInTheMaskAtTheirDepths) {
    SimSettings s = test::small_still_hand();
    s.room.wall_yaw_rad = 0.0;
    const auto rig = test::make_rig(s);
    ASSERT_EQ(rig->next({}).status, SourceStatus::ok);
    const SimTruth& truth = rig->truth();
    std::array<int, 7> count{};
    for (int y = 0; y < truth.mask.height(); ++y) {
        for (int x = 0; x < truth.mask.width(); ++x) {
            const double z = truth.depth.at(x, y) * kDepthUnitMm;
            const std::uint8_t part = truth.mask.at(x, y);
            ++count.at(part);
            if (part == static_cast<std::uint8_t>(SimPart::wall)) {
                EXPECT_NEAR(z, s.room.wall_distance_mm, 0.1);
            } else if (part == static_cast<std::uint8_t>(SimPart::hand)) {
                EXPECT_NEAR(z, s.user.hand_distance_mm, 60.0);
            }
        }
    }
    for (const SimPart part : {SimPart::hand, SimPart::forearm, SimPart::body, SimPart::wall}) {
        EXPECT_GT(count[static_cast<std::size_t>(part)], 200) << static_cast<int>(part);
    }
    EXPECT_EQ(count[0], 0);
}

TEST(SimulatedRig, LeftHandIsTheRightOneMirrored) {
    SimSettings s = test::small_still_hand();
    s.script = {{SimAction::idle, SimHand::right, -1.0, 0.1},
                {SimAction::idle, SimHand::left, -1.0, 0.1}};
    s.user.hand_x_mm = -130.0;
    const auto rig = test::make_rig(s);
    ASSERT_EQ(rig->next({}).status, SourceStatus::ok);
    const SimTruth& truth = rig->truth();
    ASSERT_EQ(truth.hand_count, 2U);
    const SimHandTruth& left = truth.hands[0];
    const SimHandTruth& right = truth.hands[1];
    ASSERT_EQ(left.hand, SimHand::left);
    ASSERT_TRUE(left.palm_visible);
    ASSERT_TRUE(right.palm_visible);
    // The user's left hand is to the image's right, and both thumbs point to the middle.
    EXPECT_GT(left.palm_mm.x(), 100.0F);
    EXPECT_LT(right.palm_mm.x(), -100.0F);
    EXPECT_LT(left.tips_mm[0].x(), left.palm_mm.x() - 40.0F);
    EXPECT_GT(right.tips_mm[0].x(), right.palm_mm.x() + 40.0F);
    EXPECT_NEAR(left.palm_radius_mm, right.palm_radius_mm, 5.0F);
}

TEST(SimulatedRig, EntersWithItsForearmAndLeaves) {
    SimSettings s = test::small_settings();
    s.script = {{SimAction::enter, SimHand::right, 0.1, 1.0},
                {SimAction::leave, SimHand::right, -1.0, 1.0}};
    s.camera.frame_hz = 10.0;
    const auto rig = test::make_rig(s);
    int seen = 0;
    bool first = true;
    bool last = true;
    while (rig->next({}).status == SourceStatus::ok) {
        const SimHandTruth& hand = rig->truth().hands[0];
        last = hand.in_view;
        seen += hand.in_view ? 1 : 0;
        EXPECT_FALSE(first && hand.in_view);
        first = false;
    }
    EXPECT_GT(seen, 8);
    EXPECT_FALSE(last);
    EXPECT_TRUE(rig->labels().empty());
}

TEST(SimulatedRig, EverythingIsInTheWorkingVolume) {
    // Where the one wide period is unique; a wall beyond would alias into the volume.
    for (const std::uint64_t seed : {3U, 4U}) {
        SimSettings s = test::small_settings();
        s.vary(seed);
        s.camera.frame_hz = 1.0;
        s.camera.exposure_s = 1e-3;
        const auto rig = test::make_rig(s);
        double nearest = 1e9;
        double furthest = 0.0;
        while (rig->next({}).status == SourceStatus::ok) {
            const SimTruth& truth = rig->truth();
            for (int y = 0; y < truth.depth.height(); ++y) {
                for (int x = 0; x < truth.depth.width(); ++x) {
                    nearest = std::min(nearest, truth.depth.at(x, y) * kDepthUnitMm);
                    furthest = std::max(furthest, truth.depth.at(x, y) * kDepthUnitMm);
                }
            }
        }
        EXPECT_GT(nearest, s.rig.working_volume->near_mm) << seed;
        EXPECT_LT(furthest, s.rig.working_volume->far_mm) << seed;
    }
}

TEST(SimulatedRig, EndsAndCountsItsFrames) {
    const auto rig = test::make_rig(test::small_still_hand(0.1));
    std::uint64_t expected = 0;
    Stamp before{-1};
    for (;;) {
        const FrameSource::Item item = rig->next({});
        if (item.status == SourceStatus::end) {
            break;
        }
        ASSERT_EQ(item.status, SourceStatus::ok);
        EXPECT_EQ(item.frame->sequence, expected);
        EXPECT_EQ(item.frame->pattern, static_cast<int>(expected % 3));
        EXPECT_EQ(item.frame->clean_row_begin, 0);
        EXPECT_EQ(item.frame->clean_row_end, item.frame->height());
        EXPECT_GT(item.frame->stamp, before);
        before = item.frame->stamp;
        ++expected;
    }
    EXPECT_EQ(expected, 6U);
    EXPECT_EQ(rig->duration(), std::chrono::milliseconds(100));
    EXPECT_EQ(rig->next({}).status, SourceStatus::end);
}

// A program may keep every frame that it gets, more than the pool lends.
TEST(SimulatedRig, KeptFramesLoseNone) {
    const SimSettings s = test::small_still_hand(1.0);
    constexpr std::uint64_t kFrames = 60;
    const auto rig = test::make_rig(s);
    const auto again = test::make_rig(s);
    std::vector<FramePtr> kept;
    for (std::uint64_t i = 0; i < kFrames; ++i) {
        const FrameSource::Item item = rig->next({});
        ASSERT_EQ(item.status, SourceStatus::ok) << i;
        EXPECT_EQ(item.frame->sequence, i);
        kept.push_back(item.frame);
        // The same seed gives the same bits, wherever they lie.
        const FramePtr lent = again->next({}).frame;
        ASSERT_EQ(item.frame->size(), lent->size());
        EXPECT_EQ(item.frame->format, lent->format);
        for (int y = 0; y < lent->height(); ++y) {
            const auto* row = item.frame->pixels.row(y);
            ASSERT_TRUE(std::equal(row, row + lent->pixels.width(), lent->pixels.row(y))) << i;
        }
    }
    EXPECT_EQ(rig->next({}).status, SourceStatus::end);
}

TEST(SimSettings, NamesTheFieldThatIsWrong) {
    SimSettings s = test::small_settings();
    s.user.hand_length_mm = 20.0;
    EXPECT_THAT(s.validate().error().message, HasSubstr("user.hand_length_mm"));
    s = test::small_settings();
    s.room.ambient_grey = std::nan("");
    EXPECT_THAT(s.validate().error().message, HasSubstr("room.ambient_grey"));
    s = test::small_settings();
    s.rig.projector.reset();
    EXPECT_THAT(s.validate().error().message, HasSubstr("projector"));
    s = test::small_settings();
    s.camera.readout_s = 0.01;
    EXPECT_THAT(s.validate().error().message, HasSubstr("locked"));
    s = test::small_settings();
    s.script.clear();
    EXPECT_THAT(s.validate().error().message, HasSubstr("duration_s"));
    EXPECT_THAT(SimSettings::preset("mobile").error().message, HasSubstr("webcam-30"));
    EXPECT_FALSE(SimulatedRig::create(s).ok());
}

}  // namespace
}  // namespace xtrack
