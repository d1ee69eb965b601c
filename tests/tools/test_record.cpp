// SPDX-License-Identifier: Apache-2.0
#include <sys/stat.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include <gmock/gmock.h>
#include <xtrack/joint_recording.hpp>
#include <xtrack/labels.hpp>
#include <xtrack/recording.hpp>

#include "tests/tools/command.hpp"

namespace xtrack::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

const std::string kSwipe = XTRACK_TEST_DATA "/sim-swipe";

/// Events as lines, without the time at which they were handed out, which a replay has none of.
std::vector<std::string> events_of(const std::string& out) {
    std::vector<std::string> events;
    std::istringstream lines(out);
    for (std::string line; std::getline(lines, line);) {
        const std::size_t emit = line.find("\"t_emit_us\"");
        if (emit != std::string::npos) {
            line.erase(emit, line.find(',', emit) - emit);
            events.push_back(line);
        }
    }
    return events;
}

class Record : public testing::Test {
 protected:
    [[nodiscard]] std::string at(const std::string& name) const {
        return (folder_.path() / name).string();
    }
    TemporaryFolder folder_;
};

TEST_F(Record, ReplaysToTheBitAsItWent) {
    for (const char* source : {"sim", "sim:webcam-30"}) {
        const std::string out = at(source);
        const Outcome live = xtrack_command(
            {"record", source, "--fast", "--seconds", "5.5", "--out", out, "--json"});
        ASSERT_EQ(live.status, 0) << live.err;
        EXPECT_THAT(live.out, HasSubstr("swipe"));
        EXPECT_THAT(live.out, HasSubstr("{\"type\":\"recording\",\"folder\":"));
        const Outcome again = xtrack_command({"replay", out, "--json"});
        auto before = events_of(live.out);
        auto after = events_of(again.out);
        EXPECT_GE(before.size(), 3U) << source;
        EXPECT_EQ(before, after) << source;
    }
}

TEST_F(Record, IsForItsOwnersEyesAlone) {
    ASSERT_EQ(xtrack_command({"record", kSwipe, "--fast", "--out", at("rec")}).status, 0);
    struct stat info {};
    for (const auto& part : fs::recursive_directory_iterator(folder_.path())) {
        ASSERT_EQ(stat(part.path().c_str(), &info), 0);
        EXPECT_EQ(info.st_mode & 0777U, part.is_directory() ? 0700U : 0600U) << part.path();
    }
}

TEST_F(Record, DepthAndJointsTellTheSameGestures) {
    for (const char* what : {"depth", "joints"}) {
        ASSERT_EQ(
            xtrack_command({"record", kSwipe, "--fast", "--what", what, "--out", at(what)}).status,
            0);
        const Outcome again = xtrack_command({"replay", at(what)});
        EXPECT_EQ(again.status, 0) << again.err;
        EXPECT_THAT(again.out, HasSubstr("swipe_left")) << what;
        EXPECT_FALSE(fs::exists(at(what) + "/frames")) << what;
    }
    const auto joints = read_joint_recording(at("joints") + "/joints.csv");
    ASSERT_TRUE(joints.ok()) << joints.error().message;
    const Hand& hand = joints->back().hands[0];
    EXPECT_TRUE(hand.joint(Joint::palm).valid);
    EXPECT_TRUE(hand.joint(Joint::index_tip).valid);
    EXPECT_FALSE(hand.joint(Joint::index_proximal).valid);  // what nobody saw is not there
}

TEST_F(Record, JointsComeBackAsTheyWere) {
    ASSERT_EQ(
        xtrack_command({"record", kSwipe, "--fast", "--what", "joints", "--out", at("a")}).status,
        0);
    const Outcome first = xtrack_command({"record", at("a"), "--fast", "--out", at("b"), "--json"});
    ASSERT_EQ(first.status, 0) << first.err;
    EXPECT_EQ(text_of(at("a") + "/joints.csv"), text_of(at("b") + "/joints.csv"));
    EXPECT_EQ(events_of(first.out), events_of(xtrack_command({"replay", at("b"), "--json"}).out));
}

TEST_F(Record, AnonymousDepthIsOfTheHandAlone) {
    ASSERT_EQ(
        xtrack_command({"record", kSwipe, "--fast", "--anonymise", "--out", at("rec")}).status, 0);
    const auto reader = RecordingReader::open(at("rec"));
    ASSERT_TRUE(reader.ok()) << reader.error().message;
    EXPECT_EQ(reader->kind(), RecordingKind::depth);
    const auto known = [&](std::size_t index) {
        DepthFrame depth;
        EXPECT_TRUE(reader->read_depth(index, depth).ok());
        int count = 0;
        for (int y = 0; y < depth.depth.height(); ++y) {
            for (int x = 0; x < depth.depth.width(); ++x) {
                count += depth.depth.at(x, y) != 0 ? 1 : 0;
            }
        }
        return static_cast<double>(count) / (depth.depth.width() * depth.depth.height());
    };
    EXPECT_EQ(known(0), 0.0);
    double most = 0.0;
    for (std::size_t i = 0; i < reader->entries().size(); ++i) {
        most = std::max(most, known(i));
    }
    EXPECT_GT(most, 0.01);
    EXPECT_LT(most, 0.2);
    EXPECT_THAT(xtrack_command({"replay", at("rec")}).out, HasSubstr("swipe_left"));
    const Outcome images =
        xtrack_command({"record", "--anonymise", "--what", "images", "--out", at("no")});
    EXPECT_EQ(images.status, 2);
    EXPECT_THAT(images.err, HasSubstr("--anonymise: images show who is there"));
    EXPECT_FALSE(fs::exists(at("no")));
}

// Lines that come from a program while it runs, through a pipe with a name.
TEST_F(Record, TakesLabelsFromAPipe) {
    const std::string pipe = at("lines");
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    std::thread writer([&] {
        std::ofstream lines(pipe);
        lines << "begin swipe_left right\n" << std::flush;
        std::this_thread::sleep_for(std::chrono::milliseconds(400));
        lines << "end\nbegin pinch\nbegin nonsense\nfoo\nend push\n" << std::flush;
    });
    const Outcome outcome = interrupted_command(
        {"record", kSwipe, "--out", at("rec"), "--events", "none"}, SIGINT,
        [&](const std::string&) { return fs::exists(at("rec")); }, std::chrono::seconds(20),
        pipe.c_str());
    writer.join();
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("recording every image of the camera to " + at("rec")));
    EXPECT_THAT(outcome.err, HasSubstr("'begin nonsense': the gesture is 'nonsense'; give swipe"));
    EXPECT_THAT(outcome.err, HasSubstr("'foo': is no label; give begin GESTURE [HAND]"));
    EXPECT_THAT(outcome.err, HasSubstr("'end push': this label is not open"));
    EXPECT_THAT(outcome.err, HasSubstr("2 labels in " + at("rec")));
    const auto labels = read_labels(at("rec") + "/labels.csv");
    ASSERT_TRUE(labels.ok()) << labels.error().message;
    ASSERT_EQ(labels->size(), 2U);
    EXPECT_EQ(labels->at(0).gesture, "swipe_left");
    EXPECT_EQ(labels->at(0).hand, Chirality::right);
    EXPECT_GE(to_seconds(labels->at(0).end - labels->at(0).start), 0.15);
    EXPECT_EQ(labels->at(1).gesture, "pinch");
    EXPECT_EQ(labels->at(1).start, labels->at(0).end);
    // What was open at the end ended with it.
    EXPECT_EQ(labels->at(1).end, RecordingReader::open(at("rec"))->entries().back().stamp);
}

TEST_F(Record, EndsInOrderOnInterrupt) {
    const Outcome outcome = interrupted_command(
        {"record", "sim", "--out", at("rec")}, SIGINT,
        [](const std::string& out) { return out.find('\n') != std::string::npos; });
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_THAT(outcome.err, testing::ContainsRegex("recorded [0-9]+ images of [0-9.]+ s"));
    const auto reader = RecordingReader::open(at("rec"));
    ASSERT_TRUE(reader.ok()) << reader.error().message;
    EXPECT_GT(reader->entries().size(), 30U);
}

TEST_F(Record, WhatIsKilledIsMarkedAndCanBeRead) {
    const Outcome outcome = interrupted_command(
        {"record", "sim", "--out", at("rec")}, SIGKILL,
        [](const std::string& out) { return out.find('\n') != std::string::npos; });
    EXPECT_EQ(outcome.status, 128 + SIGKILL);
    EXPECT_FALSE(fs::exists(at("rec")));
    const fs::path left = fs::directory_iterator(folder_.path())->path();
    EXPECT_THAT(left.filename().string(), testing::StartsWith(".rec."));
    EXPECT_THAT(left.filename().string(), testing::EndsWith(".part"));
    EXPECT_THAT(outcome.err, HasSubstr(left.filename().string()));  // it said so
    const auto reader = RecordingReader::open(left);
    ASSERT_TRUE(reader.ok()) << reader.error().message;
    EXPECT_GT(reader->entries().size(), 30U);
    EXPECT_EQ(xtrack_command({"replay", left.string(), "--events", "none"}).status, 0);
}

TEST_F(Record, SaysWhatIsWrongInALine) {
    const auto refused = [&](const std::vector<std::string>& more, int status, const char* why) {
        std::vector<std::string> arguments = {"record", "--fast", "--seconds", "1"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Outcome outcome = xtrack_command(arguments);
        EXPECT_EQ(outcome.status, status) << outcome.err;
        EXPECT_TRUE(is_one_line_message(outcome.err)) << outcome.err;
        EXPECT_THAT(outcome.err, HasSubstr(why));
    };
    fs::create_directories(at("full/of/things"));
    refused({"--out", at("full")}, 2, "exists already; remove it or give another name");
    refused({"--out", at("no/parent")}, 1, "its parent folder is missing");
    refused({"--out", at("x"), "--label", "swpe"}, 2, "--label: the gesture is 'swpe'; give swipe");
    refused({"--out", at("x"), "--label", "swipe:both"}, 2, "the hand is 'both'; give left");
    refused({"--out", at("x"), "--label", "swipe_left:"}, 2, "the hand is ''; give left");
    refused({"--out", at("x"), "--label", ":left"}, 2, "the gesture is ''; give swipe");
    refused({"--out", at("x"), "--without-rig", "--what", "joints"}, 1,
            "without a calibration there are none; record images");
    refused({"--out", at("x"), "--seconds", "0"}, 2, "--seconds");
    refused({"--what", "depth"}, 2, "--out");
    EXPECT_FALSE(fs::exists(at("x")));
}

// As of a disk that is full or gone. What was stored before is kept, images and list alike.
TEST_F(Record, StopsWhereNothingCanBeWritten) {
    const Outcome outcome = interrupted_command(
        {"record", "sim", "--out", at("rec"), "--events", "none"}, 0, [&](const std::string&) {
            if (fs::is_empty(folder_.path())) {
                return false;
            }
            const fs::path part = fs::directory_iterator(folder_.path())->path();
            if (!fs::exists(part / "frames" / "000009.png")) {
                return false;
            }
            fs::rename(part / "frames", part / "gone");
            return true;
        });
    EXPECT_EQ(outcome.status, 1);
    EXPECT_THAT(outcome.err, HasSubstr("recorded "));
    EXPECT_THAT(outcome.err, testing::ContainsRegex("xtrack: .*/rec/frames/[0-9]+\\.png: cannot be "
                                                    "written; is the disk full\\?\n$"));
    fs::rename(at("rec") + "/gone", at("rec") + "/frames");
    const auto reader = RecordingReader::open(at("rec"));
    ASSERT_TRUE(reader.ok()) << reader.error().message;
    EXPECT_GE(reader->entries().size(), 10U);
}

}  // namespace
}  // namespace xtrack::test
