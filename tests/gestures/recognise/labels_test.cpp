// SPDX-License-Identifier: Apache-2.0
#include <xtrack/labels.hpp>

#include <clocale>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <xtrack/gesture_event.hpp>

namespace xtrack {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::string message_of(const std::string& rows) {
    const auto labels = parse_labels("gesture,hand,start_us,end_us,commit_us\n" + rows, "l.csv");
    return labels ? "" : labels.error().message;
}

TEST(Labels, AreRead) {
    const auto labels = parse_labels(
        "gesture,hand,start_us,end_us,commit_us\n"
        "swipe_left,right,100,200,150\nx_ok,unknown,-5,5,\n",
        "l.csv");
    ASSERT_TRUE(labels.ok()) << labels.error().message;
    const std::vector<GestureLabel> expected = {
        {"swipe_left", Chirality::right, Stamp::from_us(100), Stamp::from_us(200),
         Stamp::from_us(150)},
        {"x_ok", Chirality::unknown, Stamp::from_us(-5), Stamp::from_us(5), std::nullopt}};
    EXPECT_EQ(*labels, expected);
    EXPECT_TRUE(parse_labels("gesture,hand,start_us,end_us\n", "l.csv")->empty());
    const auto without = parse_labels("gesture,hand,start_us,end_us\npush,left,1,2\n", "l.csv");
    ASSERT_TRUE(without.ok());
    EXPECT_FALSE(without->front().commit.has_value());
}

TEST(Labels, BadRowsAreNamed) {
    EXPECT_THAT(message_of("push,right,200,100,\n"), HasSubstr("l.csv line 2: end_us is '100'"));
    EXPECT_THAT(message_of("push,both,1,2,\n"), HasSubstr("hand is 'both'"));
    EXPECT_THAT(message_of(",right,1,2,\n"), HasSubstr("gesture is empty"));
    EXPECT_THAT(message_of("a b,right,1,2,\n"), HasSubstr("gesture is 'a b'"));
    EXPECT_THAT(message_of("push,left,1,2,\nswipe_lft,left,1,2,\n"),
                AllOf(HasSubstr("l.csv line 3: gesture is 'swipe_lft'"), HasSubstr("swipe_left")));
    EXPECT_THAT(message_of("x_,right,1,2,\n"), HasSubstr("gesture is 'x_'"));
    EXPECT_THAT(message_of("x_a b,right,1,2,\n"), HasSubstr("gesture is 'x_a b'"));
    EXPECT_THAT(message_of("push,right,nan,2,\n"), HasSubstr("start_us is 'nan'"));
    EXPECT_THAT(message_of("push,right,1,99999999999999999,\n"), HasSubstr("end_us"));
    EXPECT_THAT(message_of("push,right,1,,\n"), HasSubstr("end_us is empty"));
    const auto torn = parse_labels("gesture,hand,start_us\npush,right,1\n", "l.csv");
    ASSERT_FALSE(torn.ok());
    EXPECT_THAT(torn.error().message, HasSubstr("column 'end_us' is missing"));
    EXPECT_EQ(read_labels("no/such/labels.csv").error().code, ErrorCode::not_found);
}

TEST(Labels, KnowTheNamesOfGestures) {
    for (const char* name : {"swipe", "swipe_up", "pull", "circle", "two_hand_zoom", "open_palm",
                             "thumb_down", "x_swipe_V"}) {
        EXPECT_EQ(message_of(std::string(name) + ",right,1,2,\n"), "") << name;
    }
}

TEST(Labels, WhatIsWrittenReadsBack) {
    const std::vector<GestureLabel> labels = {
        {"push", Chirality::left, Stamp::from_us(1), Stamp::from_us(2), std::nullopt},
        {"pinch", Chirality::unknown, Stamp::from_us(3), Stamp::from_us(9), Stamp::from_us(4)}};
    const auto file = std::filesystem::path(testing::TempDir()) / "xtrack_labels_round_trip.csv";
    ASSERT_TRUE(write_labels(file, labels).ok());
    const auto back = read_labels(file);
    std::filesystem::remove(file);
    ASSERT_TRUE(back.ok()) << back.error().message;
    EXPECT_EQ(*back, labels);
}

TEST(Labels, WhatDoesNotReadBackIsNotWritten) {
    const auto file = std::filesystem::path(testing::TempDir()) / "xtrack_labels_wrong.csv";
    const std::vector<GestureLabel> labels = {{"swype_left", Chirality::right, {}, {}, {}}};
    const auto written = write_labels(file, labels);
    ASSERT_FALSE(written.ok());
    EXPECT_THAT(written.error().message, AllOf(HasSubstr("'swype_left'"), HasSubstr("x_")));
    EXPECT_FALSE(std::filesystem::exists(file));
}

// A gesture that is recognised and is no label could be asked for by nobody.
TEST(Labels, AreTheNamesOfAllEvents) {
    const std::string none = "unknown";
    for (int t = 1; to_string(static_cast<GestureType>(t)) != none; ++t) {
        GestureEvent event;
        event.type = static_cast<GestureType>(t);
        if (event.type == GestureType::engage) {
            continue;  // whose session it is, nobody labels
        }
        EXPECT_EQ(message_of(name_of(event) + ",right,1,2,\n"), "");
        for (const Direction direction : directions_of(event.type)) {
            event.direction = direction;
            EXPECT_EQ(message_of(name_of(event) + ",right,1,2,\n"), "");
        }
    }
}

TEST(Poses, AreRead) {
    const auto poses = parse_poses(
        "frame,pose,extended_fingers,hand_present\n0,,5,1\n2,open_palm,,1\n3,,,0\n", "p.csv");
    ASSERT_TRUE(poses.ok()) << poses.error().message;
    const std::vector<PoseLabel> expected = {
        {0, "", 5, true}, {2, "open_palm", std::nullopt, true}, {3, "", std::nullopt, false}};
    EXPECT_EQ(*poses, expected);
    const auto six = parse_poses("frame,pose,extended_fingers,hand_present\n0,,6,1\n", "p.csv");
    ASSERT_FALSE(six.ok());
    EXPECT_THAT(six.error().message, HasSubstr("extended_fingers is '6'"));
}

TEST(HandTruth, WhatIsWrittenReadsBack) {
    std::vector<HandTruth> truth(2);
    truth[0].hand = Chirality::right;
    truth[0].palm = {{1.5F, -2.0F, 700.25F}, true};
    truth[0].tips[1] = {{3.0F, 4.0F, 5.0F}, true};
    truth[0].pads[4] = {{6.0F, 7.0F, 8.0F}, true};
    truth[0].pinch_mm = 12.5F;
    truth[1].stamp = Stamp::from_us(16667);
    const auto back = parse_hand_truth(hand_truth_text(truth), "h.csv");
    ASSERT_TRUE(back.ok()) << back.error().message;
    ASSERT_EQ(back->size(), 2U);
    EXPECT_EQ((*back)[0].palm.position_mm, truth[0].palm.position_mm);
    EXPECT_EQ((*back)[0].tips[1].position_mm, truth[0].tips[1].position_mm);
    EXPECT_EQ((*back)[0].pads[4].position_mm, truth[0].pads[4].position_mm);
    EXPECT_FALSE((*back)[0].tips[0].valid);
    EXPECT_EQ((*back)[0].pinch_mm, 12.5F);
    EXPECT_EQ((*back)[1].stamp, Stamp::from_us(16667));
    EXPECT_FALSE((*back)[1].palm.valid);
    EXPECT_EQ((*back)[1].pinch_mm, -1.0F);
}

TEST(HandTruth, IgnoresTheLocale) {
    HandTruth truth;
    truth.palm = {{1.5F, -2.0F, 700.25F}, true};
    truth.pinch_mm = 12.5F;
    const char* const german =
        std::setlocale(LC_ALL, "de_DE.UTF-8");  // NOLINT(concurrency-mt-unsafe): one thread
    const std::string text = hand_truth_text({{truth}});
    std::setlocale(LC_ALL, "C");  // NOLINT(concurrency-mt-unsafe): one thread
    EXPECT_THAT(text, HasSubstr(",1.50,-2.00,700.25,"));
    EXPECT_THAT(text, HasSubstr(",12.50\n"));
    if (german == nullptr) {
        GTEST_SKIP() << "the locale de_DE.UTF-8 is not installed";
    }
}

TEST(HandTruth, TimeMustNotGoBack) {
    const auto back =
        parse_hand_truth("t_us,hand,palm_x,palm_y,palm_z\n5,right,1,2,3\n4,right,1,2,3\n", "h.csv");
    ASSERT_FALSE(back.ok());
    EXPECT_THAT(back.error().message, HasSubstr("h.csv line 3: t_us is '4'; time goes backwards"));
}

TEST(LabelOf, IsAKnownGestureAndAHand) {
    const auto label = label_of("swipe_left", "right");
    ASSERT_TRUE(label.ok()) << label.error().message;
    EXPECT_EQ(label->gesture, "swipe_left");
    EXPECT_EQ(label->hand, Chirality::right);
    EXPECT_EQ(label_of("x_nod", "unknown")->hand, Chirality::unknown);
    EXPECT_EQ(label_of("swpe", "left").error().code, ErrorCode::invalid_argument);
    EXPECT_NE(label_of("swpe", "left").error().message.find("'swpe'; give swipe"),
              std::string::npos);
    EXPECT_NE(label_of("swipe", "both").error().message.find("'both'; give left"),
              std::string::npos);
}

}  // namespace
}  // namespace xtrack
