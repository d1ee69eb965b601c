// SPDX-License-Identifier: Apache-2.0
// Two hands that come together keep their ids.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <ostream>
#include <string>

#include <gtest/gtest.h>

#include <xtrack/hand_tracker.hpp>

#include "tests/gestures/track/synthetic_hand.hpp"

namespace xtrack {
namespace {

using test::Scene;
using test::SyntheticHand;

struct Case {
    const char* name;
    Size size;
    int frames_per_second;
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

/// Moves two hands as `place` says, and counts what became of them.
struct Meeting {
    int frames = 0;
    int both = 0;       ///< images in which both are found
    int swapped = 0;    ///< hands with the id of the other
    int strangers = 0;  ///< hands with an id that neither began with
    bool ends_as_begun = false;

    template <typename Place>
    Meeting(const Case& c, float seconds, Place&& place) {
        Scene scene(c.size, 600.0 / 640.0 * c.size.width);
        Result<HandTracker> tracker = HandTracker::create(scene.rig, c.size, {});
        EXPECT_TRUE(tracker.ok());
        frames = static_cast<int>(seconds * static_cast<float>(c.frames_per_second));
        std::array<int, 2> ids{};
        for (int k = 0; k < frames; ++k) {
            const float t = static_cast<float>(k) / static_cast<float>(c.frames_per_second);
            std::array<SyntheticHand, 2> truth;
            truth[0].thumb_to_the_right = true;
            truth[1].thumb_to_the_right = false;
            place(t, truth[0].palm_mm, truth[1].palm_mm);
            scene.clear();
            for (const SyntheticHand& hand : truth) {
                hand.draw(scene);
            }
            scene.noise(1.5, 0.03, static_cast<unsigned>(k));
            scene.depth.stamp = Stamp::from_us(k * 1000000LL / c.frames_per_second);
            const HandFrame& hands = tracker->track(scene.depth);
            std::array<int, 2> now{};
            for (const Hand& hand : hands.all()) {
                const std::size_t near = (hand.palm_mm - truth[0].palm_mm).norm() <
                                                 (hand.palm_mm - truth[1].palm_mm).norm()
                                             ? 0
                                             : 1;
                now[near] = hand.id;
            }
            if (k == 0) {
                ids = now;
                EXPECT_TRUE(ids[0] != 0 && ids[1] != 0) << "both are found apart";
            }
            for (std::size_t h = 0; h < 2; ++h) {
                swapped += now[h] != 0 && now[h] == ids[1 - h] ? 1 : 0;
                strangers += now[h] != 0 && now[h] != ids[0] && now[h] != ids[1] ? 1 : 0;
            }
            both += now[0] != 0 && now[1] != 0 ? 1 : 0;
            ends_as_begun = now == ids;
        }
    }
    void print(const char* what, const Case& c) const {
        std::printf("%s, %s: both in %d of %d images, swapped %d, new ids %d, ids at the end %s\n",
                    what, c.name, both, frames, swapped, strangers,
                    ends_as_begun ? "as at the beginning" : "others");
    }
};

class TwoHands : public testing::TestWithParam<Case> {};

/// One passes before the other at 0.5 m/s each.
TEST_P(TwoHands, ThatCrossKeepTheirIds) {
    const Meeting meeting(GetParam(), 0.7F, [](float t, Vec3f& a, Vec3f& b) {
        a = {-175.0F + 500.0F * t, 0.0F, 520.0F};
        b = {175.0F - 500.0F * t, 10.0F, 660.0F};
    });
    meeting.print("crossing", GetParam());
    EXPECT_GE(meeting.both * 100, meeting.frames * 85);
    EXPECT_EQ(meeting.swapped, 0);
    EXPECT_EQ(meeting.strangers, 0);
    EXPECT_TRUE(meeting.ends_as_begun);
}

/// They come together until their palms touch, stay so for half a second, and part.
TEST_P(TwoHands, ThatTouchKeepTheirIds) {
    const Meeting meeting(GetParam(), 1.7F, [](float t, Vec3f& a, Vec3f& b) {
        const float apart = 45.0F + 300.0F * std::max(0.0F, std::abs(t - 0.85F) - 0.25F);
        a = {-apart, 0.0F, 560.0F};
        b = {apart, 0.0F, 560.0F};
    });
    meeting.print("touching", GetParam());
    EXPECT_EQ(meeting.both, meeting.frames);
    EXPECT_EQ(meeting.swapped, 0);
    EXPECT_EQ(meeting.strangers, 0);
    EXPECT_TRUE(meeting.ends_as_begun);
}

INSTANTIATE_TEST_SUITE_P(Streams, TwoHands,
                         testing::Values(Case{"640x480, 20 fps", {640, 480}, 20},
                                         Case{"640x480, 60 fps", {640, 480}, 60},
                                         Case{"640x480, 120 fps", {640, 480}, 120},
                                         Case{"320x240, 30 fps", {320, 240}, 30}));

}  // namespace
}  // namespace xtrack
