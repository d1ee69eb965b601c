// SPDX-License-Identifier: Apache-2.0
// Joint recordings of public data sets, kept beside the project (../shared/data).
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <xtrack/gesture_recogniser.hpp>
#include <xtrack/joint_recording.hpp>
#include <xtrack/labels.hpp>
#include <xtrack/scoring.hpp>

#include "gestures/track/hand_from_joints.hpp"

namespace xtrack::test {
namespace {

namespace fs = std::filesystem;

const fs::path kJoints = fs::path(XTRACK_SHARED_DATA) / "hands" / "joints";

void score(const fs::path& folder, GestureScorer& scorer) {
    const auto frames = read_joint_recording(folder / "joints.csv");
    ASSERT_TRUE(frames.ok()) << frames.error().message;
    std::vector<GestureLabel> labels;
    if (fs::exists(folder / "labels.csv")) {
        auto read = read_labels(folder / "labels.csv");
        ASSERT_TRUE(read.ok()) << read.error().message;
        labels = *read;
    }
    auto recogniser = GestureRecogniser::create();
    recogniser->set_trace([](const RecogniserTrace& line) {
        EXPECT_FALSE(line.impossible) << line.machine << " " << line.from << " " << line.event;
    });
    HandFromJoints reader;
    std::vector<GestureEvent> events;
    for (HandFrame frame : *frames) {
        reader.complete(frame);
        const auto now = recogniser->push(frame);
        events.insert(events.end(), now.begin(), now.end());
    }
    const auto last = recogniser->finish();
    events.insert(events.end(), last.begin(), last.end());
    scorer.add(events, labels, frames->back().stamp - frames->front().stamp);
}

int score_all(const std::string& prefix, GestureScorer& scorer) {
    int recordings = 0;
    if (!fs::is_directory(kJoints)) {
        return 0;
    }
    for (const auto& entry : fs::directory_iterator(kJoints)) {
        if (entry.path().filename().string().starts_with(prefix)) {
            score(entry.path(), scorer);
            ++recordings;
        }
    }
    return recordings;
}

// Bounds, not figures: worse than that is a regression. docs/gestures/ has the figures.
TEST(JointRecordings, SwipesAndPinchesAreFound) {
    GestureScorer scorer;
    if (score_all("sfinge-", scorer) == 0) {
        GTEST_SKIP() << "no recordings at " << kJoints;
    }
    const GestureScore all = scorer.all();
    EXPECT_GE(all.detection().value, 0.80);
    EXPECT_LE(all.false_per_label().value, 0.30);
    EXPECT_GE(scorer.gestures().at("pinch").detection().value, 0.80);
    EXPECT_GE(scorer.gestures().at("swipe_left").detection().value, 0.80);
    EXPECT_GE(scorer.gestures().at("swipe_right").detection().value, 0.70);
    EXPECT_LE(percentile(all.from_onset_ms, 0.95), 700.0);
    EXPECT_EQ(all.wrong_hand, 0);
}

TEST(JointRecordings, IdleHandsStayQuiet) {
    GestureScorer scorer;
    int recordings = 0;
    for (const char* name : {"leap-Waiting", "leap-waiting", "leap-flapping", "leap-HandSplay",
                             "leap-rollAndPitch", "leap-three-claps", "leap-gun"}) {
        recordings += score_all(name, scorer);
    }
    if (recordings == 0) {
        GTEST_SKIP() << "no recordings at " << kJoints;
    }
    EXPECT_EQ(scorer.unlabelled_events(), 0);
}

TEST(JointRecordings, PinchesOfAnotherTracker) {
    GestureScorer scorer;
    if (score_all("leap-pinch", scorer) == 0) {
        GTEST_SKIP() << "no recordings at " << kJoints;
    }
    EXPECT_EQ(scorer.all().stray, 2);  // one a recording; they have no labels to match
    EXPECT_EQ(scorer.gestures().at("pinch").stray, 2);
}

}  // namespace
}  // namespace xtrack::test
