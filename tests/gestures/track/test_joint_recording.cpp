// SPDX-License-Identifier: Apache-2.0
#include <xtrack/joint_recording.hpp>

#include <filesystem>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace xtrack {
namespace {

using testing::HasSubstr;

constexpr const char* kHeader =
    "t_us,hand,hand_id,confidence,palm_x,palm_y,palm_z,wrist_x,wrist_y,wrist_z\n";

std::string message_of(const std::string& rows) {
    const auto frames = parse_joint_recording(kHeader + rows, "joints.csv");
    return frames ? "" : frames.error().message;
}

TEST(JointRecording, LinesOfOneMomentAreOneFrame) {
    const auto frames = parse_joint_recording(std::string(kHeader) +
                                                  "0,right,1,0.9,1,2,3,,,\n"
                                                  "0,left,2,1.0,4,5,6,7,8,9\n"
                                                  "50000,,,,,,,,,\n"
                                                  "100000,unknown,1,0.5,1,2,3,,,\n",
                                              "joints.csv");
    ASSERT_TRUE(frames.ok()) << frames.error().message;
    ASSERT_EQ(frames->size(), 3U);
    const HandFrame& first = (*frames)[0];
    ASSERT_EQ(first.count, 2U);
    EXPECT_EQ(first.coordinates, CoordinateFrame::interaction);
    EXPECT_EQ(first.hands[0].chirality, Chirality::right);
    EXPECT_FLOAT_EQ(first.hands[0].confidence, 0.9F);
    EXPECT_FLOAT_EQ(first.hands[0].chirality_confidence, 0.9F);
    EXPECT_EQ(first.hands[0].joint(Joint::palm).position_mm, Vec3f(1, 2, 3));
    EXPECT_FALSE(first.hands[0].joint(Joint::wrist).valid);
    EXPECT_FALSE(first.hands[0].joint(Joint::index_tip).valid);
    EXPECT_EQ(first.hands[1].id, 2);
    EXPECT_EQ(first.hands[1].joint(Joint::wrist).position_mm, Vec3f(7, 8, 9));
    EXPECT_EQ((*frames)[1].count, 0U);
    EXPECT_EQ((*frames)[1].stamp, Stamp::from_us(50000));
    EXPECT_EQ((*frames)[2].hands[0].chirality_confidence, 0.0F);
}

TEST(JointRecording, BadRowsAreNamed) {
    EXPECT_THAT(message_of("0,right,1,1,nan,2,3,,,\n"), HasSubstr("joints.csv line 2: palm_x"));
    EXPECT_THAT(message_of("0,right,1,1,1,inf,3,,,\n"), HasSubstr("line 2: palm_y"));
    EXPECT_THAT(message_of("0,right,1,1,1,1e9,3,,,\n"), HasSubstr("line 2: palm_y"));
    EXPECT_THAT(message_of("0,right,1,1,1,,3,,,\n"), HasSubstr("line 2: palm_y is empty"));
    EXPECT_THAT(message_of("0,right,1,1,1,2,3,,,\n-5,right,1,1,1,2,3,,,\n"),
                HasSubstr("line 3: t_us is '-5'; time goes backwards"));
    EXPECT_THAT(message_of("0,right,1,1.5,1,2,3,,,\n"), HasSubstr("confidence"));
    EXPECT_THAT(message_of("0,third,1,1,1,2,3,,,\n"), HasSubstr("hand is 'third'"));
    EXPECT_THAT(message_of("0,right,x,1,1,2,3,,,\n"), HasSubstr("hand_id"));
    EXPECT_THAT(message_of("0,right,1,1,1,2,3,,,\n0,left,1,1,1,2,3,,,\n"),
                HasSubstr("line 3: hand_id"));
    EXPECT_THAT(message_of("0,right,1,1,1,2,3,,,\n0,left,2,1,1,2,3,,,\n0,left,3,1,1,2,3,,,\n"
                           "0,left,4,1,1,2,3,,,\n0,left,5,1,1,2,3,,,\n"),
                HasSubstr("line 6: t_us is '0'; it has over 4 hands"));
    EXPECT_THAT(message_of(""), HasSubstr("lists no frame"));
}

TEST(JointRecording, LongerThanAnHourIsRefused) {
    // Moments without a hand cost as much memory as others.
    std::string text = "t_us,hand,hand_id,confidence\n";
    for (int t = 0; t <= 250'000; ++t) {
        text += std::to_string(t) + ",,,\n";
    }
    const auto frames = parse_joint_recording(text, "joints.csv");
    ASSERT_FALSE(frames.ok());
    EXPECT_EQ(frames.error().message,
              "joints.csv line 250002: comes after 250000 frames; split the recording");
}

TEST(JointRecording, NumbersHaveAPointAndTheirDigits) {
    std::vector<HandFrame> frames(1);
    frames[0].count = 1;
    frames[0].hands[0].id = 3;
    frames[0].hands[0].chirality = Chirality::right;
    frames[0].hands[0].confidence = 0.5F;
    frames[0].hands[0].joints[0] = {{-1.25F, 1234.567F, 0.0F}, true};
    const std::string text = joint_recording_text(frames);
    EXPECT_THAT(text, HasSubstr("\n0,right,3,0.500,-1.25,1234.57,0.00,,,"));
}

TEST(JointRecording, MissingColumnsAreNamed) {
    const auto no_hand = parse_joint_recording("t_us,hand_id,confidence\n0,1,1\n", "j.csv");
    ASSERT_FALSE(no_hand.ok());
    EXPECT_THAT(no_hand.error().message, HasSubstr("column 'hand' is missing"));
    const auto no_z =
        parse_joint_recording("t_us,hand,hand_id,confidence,palm_x,palm_y\n0,,,,,\n", "j.csv");
    ASSERT_FALSE(no_z.ok());
    EXPECT_THAT(no_z.error().message, HasSubstr("column 'palm_z' is missing"));
}

TEST(JointRecording, WhatIsWrittenReadsBack) {
    std::vector<HandFrame> frames(3);
    for (std::size_t i = 0; i < frames.size(); ++i) {
        frames[i].stamp = Stamp::from_us(static_cast<std::int64_t>(i) * 16667);
        frames[i].coordinates = CoordinateFrame::interaction;
    }
    frames[1].count = 2;
    frames[1].hands[0].id = 7;
    frames[1].hands[0].chirality = Chirality::left;
    frames[1].hands[0].confidence = 0.75F;
    frames[1].hands[0].joint(Joint::little_tip) = {{-1.25F, 300.5F, 12.0F}, true};
    frames[1].hands[1].id = 8;
    const auto file = std::filesystem::path(testing::TempDir()) / "xtrack_joints_round_trip.csv";
    ASSERT_TRUE(write_joint_recording(file, frames).ok());
    const auto back = read_joint_recording(file);
    std::filesystem::remove(file);
    ASSERT_TRUE(back.ok()) << back.error().message;
    ASSERT_EQ(back->size(), 3U);
    EXPECT_EQ((*back)[0].count, 0U);
    ASSERT_EQ((*back)[1].count, 2U);
    const Hand& hand = (*back)[1].hands[0];
    EXPECT_EQ(hand.id, 7);
    EXPECT_EQ(hand.chirality, Chirality::left);
    EXPECT_EQ(hand.confidence, 0.75F);
    EXPECT_EQ(hand.joint(Joint::little_tip).position_mm, Vec3f(-1.25F, 300.5F, 12.0F));
    EXPECT_FALSE(hand.joint(Joint::palm).valid);
    EXPECT_EQ((*back)[2].stamp, frames[2].stamp);
}

TEST(JointRecording, NothingThatCannotBeReadIsWritten) {
    std::vector<HandFrame> frames(1);
    frames[0].count = 1;
    frames[0].hands[0].joints[0] = {Vec3f::Constant(std::numeric_limits<float>::quiet_NaN()), true};
    const auto file = std::filesystem::path(testing::TempDir()) / "xtrack_joints_nan.csv";
    EXPECT_FALSE(write_joint_recording(file, frames).ok());
    EXPECT_FALSE(std::filesystem::exists(file));
}

}  // namespace
}  // namespace xtrack
