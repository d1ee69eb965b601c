// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "tests/tools/command.hpp"
#include "tools/eval/evaluation.hpp"
#include "tools/eval/player.hpp"
#include "tools/eval/sweep.hpp"
#include "tools/eval/timeline.hpp"

namespace xtrack::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;

const std::string kSwipe = XTRACK_TEST_DATA "/sim-swipe";

/// The swipe of sim-swipe under other labels: `found`, `missed`, `unlabelled`.
class EvalRecordings : public testing::Test {
 protected:
    EvalRecordings() {
        for (const char* name : {"found", "missed", "unlabelled"}) {
            fs::create_directory(folder_.path() / name);
            for (const auto& part : fs::directory_iterator(kSwipe)) {
                if (part.path().filename() != "labels.csv") {
                    fs::create_symlink(part.path(), folder_.path() / name / part.path().filename());
                }
            }
        }
        fs::copy(kSwipe + "/labels.csv", folder_.path() / "found");
        set_text(folder_.path() / "missed" / "labels.csv",
                 "gesture,hand,start_us,end_us\nswipe_right,right,1733333,2243155\n"
                 "x_point,left,1500000,1600000\n");
    }
    [[nodiscard]] std::string at(const std::string& name) const {
        return (folder_.path() / name).string();
    }
    [[nodiscard]] json figures(std::vector<std::string> arguments) const {
        arguments.insert(arguments.begin(), "eval");
        arguments.emplace_back("--json");
        const Outcome outcome = xtrack_command(arguments);
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        return json::parse(outcome.out);
    }

    TemporaryFolder folder_;
};

TEST_F(EvalRecordings, SaysWhatBecameOfEachRecording) {
    const json all = figures({at("found"), at("missed"), at("unlabelled")});
    ASSERT_EQ(all["recordings"].size(), 3U);
    const json& found = all["recordings"][0]["score"];
    EXPECT_EQ(found["correct"], 1);
    EXPECT_EQ(found["jaccard"], 1.0);
    // Decided at 1.971 s; the label's commit is at 1.958333, its start and end at 1.733333 and
    // 2.243155.
    EXPECT_NEAR(found["latency_from_commit_ms"]["p50"], 12.3, 0.5);
    EXPECT_NEAR(found["latency_from_start_ms"]["p95"], 237.3, 0.5);
    EXPECT_NEAR(found["latency_from_end_ms"]["p50"], -272.5, 0.5);
    EXPECT_EQ(found["wrong_hand_rate"]["value"], 0.0);
    EXPECT_EQ(found["unclosed"], 0);
    const json& missed = all["recordings"][1]["score"];
    EXPECT_EQ(missed["labelled"], 1);
    EXPECT_EQ(missed["correct"], 0);
    EXPECT_EQ(missed["false"], 1);
    EXPECT_EQ(missed["jaccard"], 0.0);
    EXPECT_EQ(missed["latency_from_commit_ms"], nullptr);
    EXPECT_EQ(all["all"]["labelled"], 2);
    EXPECT_EQ(all["all"]["false"], 2);
    EXPECT_EQ(all["unlabelled"]["events"], 1);
    EXPECT_NEAR(all["unlabelled"]["per_hour"]["value"], 3600.0 / 1.0, 400.0);
}

TEST_F(EvalRecordings, PrintsARowARecording) {
    const Outcome outcome = xtrack_command({"eval", at("found"), at("missed")});
    EXPECT_EQ(outcome.status, 0);
    EXPECT_THAT(outcome.out, testing::ContainsRegex("found +1\\.0 +1/1 +0 +0 +0 +1\\.00 +12 / 12"));
    EXPECT_THAT(outcome.out, testing::ContainsRegex("missed +1\\.0 +0/1 +1 +0 +0 +0\\.00 +-"));
}

TEST_F(EvalRecordings, KeepsTheFiguresOfTheOthersWhereOneIsTorn) {
    set_text(folder_.path() / "missed" / "labels.csv", "gesture,hand,start_us,end_us\nswipe\n");
    const Outcome outcome = xtrack_command({"eval", at("missed"), at("found"), "--json"});
    EXPECT_EQ(outcome.status, 1);
    EXPECT_TRUE(is_one_line_message(outcome.err)) << outcome.err;
    const json all = json::parse(outcome.out);
    EXPECT_EQ(all["recordings"].size(), 1U);
    EXPECT_EQ(all["all"]["correct"], 1);
    ASSERT_EQ(all["failed"].size(), 1U);
    EXPECT_EQ(all["failed"][0]["name"], "missed");
    EXPECT_THAT(all["failed"][0]["message"].get<std::string>(), HasSubstr("labels.csv line 2"));

    const Outcome none = xtrack_command({"eval", at("missed"), "--json"});
    EXPECT_EQ(none.status, 1);
    EXPECT_EQ(none.out, "");
}

TEST_F(EvalRecordings, RecognisesWhatASessionDoes) {
    for (const char* source : {"found", "unlabelled"}) {
        SessionOptions options;
        auto session = Session::open(at(source), options);
        ASSERT_TRUE(session.ok()) << session.error().message;
        std::vector<std::string> live;
        session->subscribe([&](const GestureEvent& e) { live.push_back(to_json(e)); });
        ASSERT_TRUE(session->run().ok());
        const auto played = tools::play_recording(at(source), options);
        ASSERT_TRUE(played.ok()) << played.error().message;
        const auto events = tools::recognise(*played, options.gestures);
        ASSERT_TRUE(events.ok());
        std::vector<std::string> again;
        for (const GestureEvent& e : *events) {
            again.push_back(to_json(e));
        }
        EXPECT_EQ(again, live);
        EXPECT_GE(live.size(), 4U);
    }
}

TEST_F(EvalRecordings, SweepsASetting) {
    const json all = figures({at("found"), at("unlabelled"), "--sweep",
                              "swipe_speed_mmps=300:900:3", "--gestures", "swipe"});
    EXPECT_EQ(all["setting"], "swipe_speed_mmps");
    ASSERT_EQ(all["values"].size(), 3U);
    EXPECT_EQ(all["values"][1]["value"], 600.0);
    EXPECT_EQ(all["values"][0]["score"]["correct"], 1);
    EXPECT_EQ(all["values"][0]["unlabelled"]["events"], 1);
    EXPECT_EQ(all["values"][2]["score"]["correct"], 0);
    EXPECT_EQ(all["values"][2]["unlabelled"]["events"], 0);
    // As each value alone.
    const json alone = figures({at("found"), "--set", "swipe_speed_mmps=900"});
    EXPECT_EQ(alone["all"]["correct"], 0);

    const Outcome table =
        xtrack_command({"eval", at("found"), "--sweep", "swipe_speed_mmps=300,900"});
    EXPECT_EQ(table.status, 0) << table.err;
    EXPECT_THAT(table.out, testing::ContainsRegex("\n +300 +1/1 +1\\.00 .*\n +900 +0/1 +0\\.00 "));
}

TEST_F(EvalRecordings, RefusesASweepThatIsNone) {
    const auto refused = [&](const std::string& sweep, const char* why) {
        const Outcome outcome = xtrack_command({"eval", at("found"), "--sweep", sweep});
        EXPECT_EQ(outcome.status, 2) << sweep;
        EXPECT_TRUE(is_one_line_message(outcome.err)) << outcome.err;
        EXPECT_THAT(outcome.err, HasSubstr(why)) << sweep;
        EXPECT_EQ(outcome.out, "");
    };
    refused("swipe_speed_mmps", "give NAME=FROM:TO:STEPS");
    refused("swipe_speed_mmps=300:400", "give NAME=FROM:TO:STEPS");
    refused("swipe_speed_mmps=300:400:1", "of 2 to 1000 steps");
    refused("swipe_sped=1,2", "swipe_sped");
    refused("swipe_speed_mmps=300,30000", "swipe_speed_mmps");
    refused("pinch_release_mm=20,25", "pinch_release_mm");  // against pinch_close_mm
    EXPECT_EQ(xtrack_command({"eval", at("found"), "--set", "swipe_sped=1"}).status, 2);
}

int pixels_like(const cv::Mat& picture, const cv::Vec3b& colour) {
    int count = 0;
    for (int y = 0; y < picture.rows; ++y) {
        for (int x = 0; x < picture.cols; ++x) {
            const cv::Vec3b& p = picture.at<cv::Vec3b>(y, x);
            int off = 0;
            for (int c = 0; c < 3; ++c) {
                off = std::max(off, std::abs(p[c] - colour[c]));
            }
            count += off < 12 ? 1 : 0;
        }
    }
    return count;
}

constexpr int kLegend = 200;  // pixels of one colour in it at most
const cv::Vec3b kGreen(64, 148, 44);
const cv::Vec3b kRed(44, 44, 212);
const cv::Vec3b kOrange(0, 120, 235);

TEST_F(EvalRecordings, DrawsWhatBecameOfLabelsAndEvents) {
    const Outcome outcome =
        xtrack_command({"eval", at("found"), at("missed"), "--timeline", at("pictures")});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const cv::Mat found = cv::imread(at("pictures/found.png"));
    const cv::Mat missed = cv::imread(at("pictures/missed.png"));
    ASSERT_FALSE(found.empty());
    ASSERT_FALSE(missed.empty());
    EXPECT_GT(pixels_like(found, kGreen), pixels_like(missed, kGreen) + 100);
    EXPECT_LT(pixels_like(found, kRed), kLegend);
    EXPECT_GT(pixels_like(missed, kRed), pixels_like(found, kRed) + 100);
    EXPECT_GT(pixels_like(missed, kOrange), pixels_like(found, kOrange) + 300);
    // Two of one name do not take each other's place.
    ASSERT_EQ(xtrack_command({"eval", at("found"), at("found"), "--timeline", at("twice")}).status,
              0);
    EXPECT_TRUE(fs::exists(at("twice/found-2.png")));
}

TEST_F(EvalRecordings, SaysWhereATimelineCannotBeDrawn) {
    const Outcome several =
        xtrack_command({"eval", at("found"), at("missed"), "--timeline", at("one.png")});
    EXPECT_EQ(several.status, 2);
    EXPECT_THAT(several.err, HasSubstr("there are 2 recordings; give a folder"));
    const Outcome nowhere =
        xtrack_command({"eval", at("found"), "--timeline", at("no/where/one.png")});
    EXPECT_EQ(nowhere.status, 1);
    EXPECT_TRUE(is_one_line_message(nowhere.err)) << nowhere.err;
    EXPECT_THAT(nowhere.out, HasSubstr("swipe_left"));  // the figures are not lost
}

// Whatever is labelled, no name may cover another: every row has its own place.
TEST(Timeline, GrowsWithWhatIsCloseTogether) {
    tools::EvaluatedRecording r;
    r.name = "many";
    r.seconds = 10.0;
    const auto label = [&](double from_s, double to_s) {
        r.labels.push_back({"swipe_left", Chirality::right,
                            Stamp::from_us(static_cast<std::int64_t>(from_s * 1e6)),
                            Stamp::from_us(static_cast<std::int64_t>(to_s * 1e6)), std::nullopt});
    };
    label(1.0, 1.5);
    label(5.0, 5.5);
    const int apart = tools::timeline_picture(r).rows;
    label(5.1, 5.6);
    label(5.2, 5.7);
    EXPECT_EQ(tools::timeline_picture(r).rows, apart + 2 * 25);
    r.seconds = 100.0;  // five strips
    const int folded = tools::timeline_picture(r).rows;
    EXPECT_GT(folded, apart + 4 * 60);
    r.seconds = 36'000.0;
    EXPECT_LT(tools::timeline_picture(r).rows, 60 * 200);
}

TEST_F(EvalRecordings, CountsFingersOfStills) {
    const std::string stills = at("stills");
    ASSERT_EQ(xtrack_command({"record", kSwipe, "--out", stills, "--what", "depth", "--fast",
                              "--events", "none"})
                  .status,
              0);
    // Five fingers are spread in all of them; the last shows nothing at all.
    ASSERT_TRUE(cv::imwrite(stills + "/depth/000046.png", cv::Mat::zeros(240, 320, CV_16UC1)));
    set_text(stills + "/poses.csv",
             "frame,pose,extended_fingers,hand_present\n0,,5,1\n10,,5,1\n20,,4,1\n30,,1,1\n"
             "40,,,1\n45,,,0\n46,,,0\n");
    const json all = figures({stills});
    ASSERT_EQ(all["stills"].size(), 1U);
    const json& s = all["stills"][0];
    EXPECT_EQ(s["with_hand"], 5);
    EXPECT_EQ(s["found"], 5);
    EXPECT_EQ(s["without_hand"], 2);
    EXPECT_EQ(s["none_found"], 1);
    EXPECT_EQ(s["fingers_counted"], 4);
    EXPECT_EQ(s["fingers_right"], 2);
    EXPECT_EQ(s["fingers_within_one"], 3);
    EXPECT_NEAR(s["found_rate"]["low"], 0.5655, 1e-3);  // Wilson, 5 of 5
    EXPECT_TRUE(all["recordings"].empty());
    set_text(stills + "/poses.csv", "frame,pose,extended_fingers,hand_present\n900,,5,1\n");
    const Outcome beyond = xtrack_command({"eval", stills});
    EXPECT_EQ(beyond.status, 1);
    EXPECT_THAT(beyond.err, HasSubstr("poses.csv: frame is 900, and frames.csv lists"));
}

}  // namespace
}  // namespace xtrack::test
