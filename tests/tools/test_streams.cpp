// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <csignal>
#include <filesystem>

#include <gmock/gmock.h>

#include "tests/tools/command.hpp"
#include "tools/interrupt.hpp"

namespace xtrack::test {
namespace {

using testing::HasSubstr;

const std::string kSwipe = XTRACK_TEST_DATA "/sim-swipe";

TEST(Replay, FindsTheSwipe) {
    const Outcome outcome = xtrack_command({"replay", kSwipe});
    EXPECT_EQ(outcome.status, 0);
    EXPECT_EQ(outcome.err, "");
    EXPECT_THAT(outcome.out, HasSubstr("swipe_left"));
}

TEST(Replay, TwiceIsTheSameToTheByte) {
    const std::vector<std::string> arguments = {"replay", kSwipe, "--json", "--hands", "jsonl"};
    const Outcome first = xtrack_command(arguments);
    const Outcome second = xtrack_command(arguments);
    EXPECT_EQ(first.status, 0);
    EXPECT_THAT(first.out, HasSubstr("swipe"));
    EXPECT_EQ(first.out, second.out);
}

TEST(Replay, OfOtherGesturesSaysNothingOfTheSwipe) {
    const Outcome outcome = xtrack_command({"replay", kSwipe, "--gestures", "pinch,push"});
    EXPECT_EQ(outcome.status, 0);
    EXPECT_THAT(outcome.out, HasSubstr("hand begin"));
    EXPECT_THAT(outcome.out, Not(HasSubstr("swipe")));
}

TEST(Replay, StatisticsGoToStderr) {
    const Outcome outcome = xtrack_command({"replay", kSwipe, "--events", "none", "--stats"});
    EXPECT_EQ(outcome.status, 0);
    EXPECT_EQ(outcome.out, "");
    EXPECT_THAT(outcome.err, HasSubstr("frames"));
}

TEST(Replay, ToAFullDiskFails) {
    if (!std::filesystem::exists("/dev/full")) {
        GTEST_SKIP() << "this system has no /dev/full";
    }
    const Outcome outcome = xtrack_command({"replay", kSwipe, "--events", "jsonl"}, "/dev/full");
    EXPECT_EQ(outcome.status, 1);
    EXPECT_TRUE(is_one_line_message(outcome.err)) << outcome.err;
}

TEST(Run, SettingsChangeWhileItRuns) {
    const TemporaryFolder folder;
    const auto lines = folder.path() / "lines";
    std::string text = "mode=hold\n\nmin_modulation\r\ntaps=least_squares\nmin_support=2\n" +
                       std::string(600, 'x') + "\nmin_support=0.75\n";
    for (int n = 0; n < 20; ++n) {  // one is taken with each image
        text += "min_modulation=8\n";
    }
    set_text(lines, text + "mode=hold\nmin_modulation=127\nmin_modulation=4");
    const Outcome outcome = interrupted_command(
        {"run", "--mode", "default", "--events", "none", "--control"}, SIGINT,
        [](const std::string&) { return false; }, std::chrono::seconds(2), lines.c_str());
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("min_modulation=8: from the next image on\n"));
    EXPECT_THAT(outcome.err, HasSubstr("'min_modulation': give NAME=VALUE"));
    EXPECT_THAT(outcome.err, HasSubstr("'taps=least_squares': means nothing where"));
    EXPECT_THAT(outcome.err, HasSubstr("min_support is '2', must be a number from 0 to 1"));
    EXPECT_THAT(outcome.err, HasSubstr("a line of more than 256 characters is no setting"));
    EXPECT_THAT(outcome.err, HasSubstr("min_support=0.75: from the next image on"));
    EXPECT_THAT(outcome.err, Not(HasSubstr("xx")));
    EXPECT_THAT(outcome.err, HasSubstr("mode=hold: nothing was decoded yet that could be held"));
    EXPECT_THAT(outcome.err, HasSubstr("min_modulation=127: 0.0 % of the pixels have depth"));
    EXPECT_THAT(outcome.err,
                testing::ContainsRegex("min_modulation=4: [5-9][0-9]\\.[0-9] % of the pixels"));
}

TEST(Replay, ASettingThatWouldDoNothingIsRefused) {
    const auto refused = [](const std::vector<std::string>& arguments, const char* why) {
        const Outcome outcome = xtrack_command(arguments);
        EXPECT_EQ(outcome.status, 2) << outcome.err;
        EXPECT_TRUE(is_one_line_message(outcome.err)) << outcome.err;
        EXPECT_THAT(outcome.err, HasSubstr(why));
    };
    refused({"run", "--set", "min_support=0.4"}, "unwrapped in space");
    refused({"run", "--mode", "burst", "--set", "order_tolerance=0.4"}, "means nothing");
    refused({"run", "--mode", "burst", "--set", "mode=hold"}, "no images to hold yet");
    refused({"run", "--mode", "burst", "--set", "threads=2"}, "means nothing");
    refused({"run", "--set", "read_noise_levels=2"}, "means nothing");
    refused({"decode", kSwipe, "--out", "x", "--set", "mode=burst"}, "unwrapped in space");
}

// The simulator's script takes half a minute; the first event comes within two seconds.
TEST(Run, StopsWhenNobodyCanReadIt) {
    if (!std::filesystem::exists("/dev/full")) {
        GTEST_SKIP() << "this system has no /dev/full";
    }
    const auto begin = std::chrono::steady_clock::now();
    const Outcome outcome = xtrack_command({"run", "sim", "--events", "jsonl"}, "/dev/full");
    EXPECT_EQ(outcome.status, 1);
    EXPECT_TRUE(is_one_line_message(outcome.err)) << outcome.err;
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds{20});
}

TEST(Run, SaysThatThereAreNoCamerasYet) {
    const Outcome outcome = xtrack_command({"run", "/dev/null"});
    EXPECT_EQ(outcome.status, 1);
    EXPECT_THAT(outcome.err, HasSubstr("is a device, and live cameras are not part of"));
    EXPECT_TRUE(is_one_line_message(outcome.err)) << outcome.err;
}

bool has_a_line(const std::string& out) { return out.find('\n') != std::string::npos; }

// What was begun is ended, what is known is printed, and the status is that of a run that ended.
TEST(Run, EndsInOrderOnInterrupt) {
    const Outcome outcome =
        interrupted_command({"run", "sim", "--json", "--stats"}, SIGINT, has_a_line);
    EXPECT_EQ(outcome.status, 0);
    EXPECT_THAT(outcome.out, HasSubstr("\"begin\""));
    EXPECT_EQ(outcome.out.back(), '\n');
    EXPECT_THAT(outcome.err, HasSubstr("frames"));
}

TEST(Run, OfARecordingIsNotWholeOnInterrupt) {
    const Outcome outcome = interrupted_command({"run", kSwipe}, SIGTERM, has_a_line);
    EXPECT_EQ(outcome.status, 130);
    EXPECT_THAT(outcome.err, HasSubstr("not all of the recording's"));
}

TEST(Run, LeavesASignalIgnoredThatWas) {
    const auto before = std::signal(SIGINT, SIG_IGN);  // as nohup does with SIGHUP
    const Outcome outcome = interrupted_command({"run", kSwipe}, SIGINT, has_a_line);
    std::signal(SIGINT, before);
    EXPECT_EQ(outcome.status, 0);
    EXPECT_THAT(outcome.out, HasSubstr("swipe_left"));
}

TEST(NoteInterrupt, LeavesAllAsItWas) {
    const auto mine = [](int) {};
    const auto before = std::signal(SIGTERM, mine);
    {
        const tools::NoteInterrupt note;
        std::raise(SIGTERM);
        EXPECT_TRUE(tools::interrupted());
    }
    EXPECT_EQ(std::signal(SIGTERM, before), static_cast<void (*)(int)>(mine));
}

TEST(Eval, SaysInJsonThatThereWereNoGestures) {
    const Outcome outcome = xtrack_command({"eval", kSwipe, "--gestures", "pinch", "--json"});
    EXPECT_EQ(outcome.status, 0);
    EXPECT_THAT(outcome.out, HasSubstr("\"gestures\": {}"));
}

// Decodes every frame into `out` of `folder` and is interrupted while it writes.
Outcome interrupted_decode(const std::filesystem::path& folder, int signal) {
    return interrupted_command(
        {"decode", kSwipe, "--all", "--out", (folder / "out").string()}, signal,
        [&](const std::string&) { return !std::filesystem::is_empty(folder); });
}

TEST(Decode, LeavesNothingOnInterrupt) {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        const TemporaryFolder folder;
        const Outcome outcome = interrupted_decode(folder.path(), signal);
        EXPECT_EQ(outcome.status, 130);
        EXPECT_EQ(outcome.out, "");
        EXPECT_EQ(outcome.err, "xtrack: interrupted; nothing was written\n");
        EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
    }
}

}  // namespace
}  // namespace xtrack::test
