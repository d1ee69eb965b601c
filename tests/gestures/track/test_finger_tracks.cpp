// SPDX-License-Identifier: Apache-2.0
#include "gestures/track/finger_tracks.hpp"

#include <gtest/gtest.h>

namespace xtrack::track {
namespace {

constexpr Duration kFrame = std::chrono::milliseconds(16);
constexpr int kThumbClockwise = 1;

/// A hand that is seen from the front, fingers up (-y), thumb on the image's right: clockwise.
class FingerTracksTest : public ::testing::Test {
 protected:
    FingerTracksTest() {
        region_.palm_mm = {0.0F, 0.0F, 600.0F};
        region_.palm_radius_mm = 40.0F;
    }

    void add(const Vec3f& from_palm, Finger guess) {
        Tip& tip = reading_.tips[reading_.count++];
        tip = {};
        tip.position_mm = region_.palm_mm + from_palm;
        tip.pad_before_mm = tip.position_mm;
        tip.pad_after_mm = tip.position_mm;
        tip.finger = guess;
    }

    /// Tips in the order that a reading has them: counter-clockwise end first.
    void outer_fingers() {
        reading_ = {};
        add({-60.0F, -80.0F, 0.0F}, Finger::little);
        add({-30.0F, -105.0F, 0.0F}, Finger::ring);
        add({0.0F, -115.0F, 0.0F}, Finger::middle);
    }

    void open_hand(float thumb_y_mm) {
        outer_fingers();
        add({45.0F, -85.0F, 0.0F}, Finger::index);
        add({60.0F, thumb_y_mm, 0.0F}, Finger::thumb);
        reading_.thumb = 4;
        reading_.thumb_side = kThumbClockwise;
    }

    void step() {
        now_ = now_ + kFrame;
        tracks_.update(now_, region_, kThumbClockwise, reading_);
    }

    void close_hand() {
        for (float y = -30.0F; y > -75.0F; y -= 7.0F) {
            open_hand(y);
            step();
        }
    }

    HandRegion region_;
    FingerReading reading_;
    FingerTracks tracks_;
    Stamp now_;
};

TEST_F(FingerTracksTest, a_finger_keeps_its_name_when_a_frame_alone_gives_it_another) {
    open_hand(-20.0F);
    step();
    // The thumb is not seen, and this frame alone shifts every name by one.
    reading_ = {};
    add({-60.0F, -80.0F, 0.0F}, Finger::ring);
    add({-30.0F, -105.0F, 0.0F}, Finger::middle);
    add({0.0F, -115.0F, 0.0F}, Finger::index);
    add({44.0F, -84.0F, 0.0F}, Finger::thumb);
    reading_.thumb = 3;
    step();

    EXPECT_TRUE(tracks_.finger(Finger::index).fresh);
    EXPECT_FALSE(tracks_.finger(Finger::thumb).fresh);
    EXPECT_EQ(reading_.tips[0].finger, Finger::little);
    EXPECT_EQ(reading_.tips[3].finger, Finger::index);
    EXPECT_EQ(reading_.thumb, -1);
}

TEST_F(FingerTracksTest, the_aperture_lasts_through_four_frames_without_thumb_and_then_is_unknown) {
    open_hand(-20.0F);
    step();
    const float before_mm = tracks_.aperture_mm();
    EXPECT_NEAR(before_mm, 66.7F, 0.1F);
    for (int frame = 1; frame <= 8; ++frame) {
        outer_fingers();
        step();
        EXPECT_FLOAT_EQ(tracks_.aperture_mm(), frame <= 4 ? before_mm : -1.0F) << "frame " << frame;
    }
}

TEST_F(FingerTracksTest, two_tips_that_run_into_each_other_touch) {
    close_hand();
    EXPECT_FALSE(tracks_.touching());
    outer_fingers();
    add({52.0F, -78.0F, 0.0F}, Finger::index);
    for (int frame = 0; frame < 20; ++frame) {
        step();
    }

    EXPECT_TRUE(tracks_.touching());
    EXPECT_LT(tracks_.aperture_mm(), 10.0F);
}

TEST_F(FingerTracksTest, a_finger_that_leaves_the_touch_alone_takes_the_thumb_along_no_further) {
    close_hand();
    float x_mm = 52.0F;
    for (int frame = 0; frame < 40; ++frame) {
        outer_fingers();
        add({x_mm, -78.0F - (52.0F - x_mm), 0.0F}, Finger::index);
        x_mm -= 1.0F;
        step();
    }

    EXPECT_FALSE(tracks_.touching());
    EXPECT_LT(tracks_.aperture_mm(), 0.0F);
}

TEST_F(FingerTracksTest, tips_that_come_apart_measure_at_once) {
    close_hand();
    outer_fingers();
    add({52.0F, -78.0F, 0.0F}, Finger::index);
    step();
    ASSERT_TRUE(tracks_.touching());
    outer_fingers();
    add({46.0F, -85.0F, 0.0F}, Finger::middle);
    add({58.0F, -66.0F, 0.0F}, Finger::index);
    step();

    EXPECT_FALSE(tracks_.touching());
    EXPECT_NEAR(tracks_.aperture_mm(), 22.5F, 0.1F);
}

TEST_F(FingerTracksTest, fingers_that_come_apart_do_not_meet_again_where_one_is_lost) {
    close_hand();
    outer_fingers();
    add({52.0F, -78.0F, 0.0F}, Finger::index);
    step();
    ASSERT_TRUE(tracks_.touching());
    for (float gap_mm = 15.0F; gap_mm < 31.0F; gap_mm += 5.0F) {
        outer_fingers();
        add({45.0F, -85.0F, 0.0F}, Finger::index);
        add({45.0F + gap_mm, -85.0F, 0.0F}, Finger::thumb);
        reading_.thumb = 4;
        reading_.thumb_side = kThumbClockwise;
        step();
    }
    ASSERT_FALSE(tracks_.touching()) << tracks_.aperture_mm();
    outer_fingers();
    add({60.0F, -85.0F, 0.0F}, Finger::thumb);
    reading_.thumb = 3;
    reading_.thumb_side = kThumbClockwise;
    step();

    EXPECT_FALSE(tracks_.touching());
}

TEST_F(FingerTracksTest, a_touch_that_five_tips_contradict_is_let_go) {
    close_hand();
    outer_fingers();
    add({52.0F, -78.0F, 0.0F}, Finger::index);
    step();
    ASSERT_TRUE(tracks_.touching());
    // A lone thumb has stayed where they met, under the index finger's name; all five are in view.
    for (int frame = 0; frame < 20; ++frame) {
        reading_ = {};
        add({-75.0F, -60.0F, 0.0F}, Finger::little);
        add({-60.0F, -80.0F, 0.0F}, Finger::ring);
        add({-30.0F, -105.0F, 0.0F}, Finger::middle);
        add({0.0F, -115.0F, 0.0F}, Finger::index);
        add({52.0F, -78.0F, 0.0F}, Finger::thumb);
        reading_.thumb = 4;
        reading_.thumb_side = kThumbClockwise;
        step();
    }

    EXPECT_FALSE(tracks_.touching());
    EXPECT_EQ(reading_.tips[4].finger, Finger::thumb);
    EXPECT_NEAR(tracks_.aperture_mm(), 63.8F, 0.1F);
}

TEST_F(FingerTracksTest, a_hole_far_from_the_tips_is_no_ring) {
    open_hand(-20.0F);
    step();
    open_hand(-20.0F);
    reading_.ring = true;
    reading_.ring_tip_mm = region_.palm_mm + Vec3f(-40.0F, -90.0F, 0.0F);
    step();

    EXPECT_FALSE(tracks_.touching());
    EXPECT_NEAR(tracks_.aperture_mm(), 66.7F, 0.1F);
}

}  // namespace
}  // namespace xtrack::track
