// SPDX-License-Identifier: Apache-2.0
// Joint recordings of public data sets, kept beside the project (../shared/data).
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <span>
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

void score(const fs::path& folder, GestureScorer& scorer, const GestureSettings& settings) {
    const auto frames = read_joint_recording(folder / "joints.csv");
    ASSERT_TRUE(frames.ok()) << frames.error().message;
    std::vector<GestureLabel> labels;
    if (fs::exists(folder / "labels.csv")) {
        auto read = read_labels(folder / "labels.csv");
        ASSERT_TRUE(read.ok()) << read.error().message;
        labels = *read;
    }
    auto recogniser = GestureRecogniser::create(settings);
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

int score_all(const std::string& prefix, GestureScorer& scorer,
              const GestureSettings& settings = {}) {
    int recordings = 0;
    if (!fs::is_directory(kJoints)) {
        return 0;
    }
    for (const auto& entry : fs::directory_iterator(kJoints)) {
        if (entry.path().filename().string().starts_with(prefix)) {
            score(entry.path(), scorer, settings);
            ++recordings;
        }
    }
    return recordings;
}

// Bounds, not figures: worse than that is a regression. docs/gestures/ has the figures.
TEST(JointRecordings, SwipesAndPinchesAreFound) {
    GestureSettings settings;
    settings.grab = settings.tap = settings.circle = settings.pull = false;
    GestureScorer scorer(settings);
    if (score_all("sfinge-", scorer, settings) == 0) {
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

TEST(JointRecordings, GrabsTapsAndCirclesAreFoundBesideThem) {
    GestureScorer scorer;
    if (score_all("sfinge-", scorer) == 0) {
        GTEST_SKIP() << "no recordings at " << kJoints;
    }
    for (const char* gesture : {"grab", "tap", "circle", "pinch", "swipe_left"}) {
        const GestureScore& score = scorer.gestures().at(gesture);
        EXPECT_GE(score.detection().value, 0.80) << gesture;
        EXPECT_LE(score.false_per_label().value, 0.30) << gesture;
    }
    EXPECT_LE(scorer.all().false_per_label().value, 0.15);
    EXPECT_EQ(scorer.all().wrong_hand, 0);
}

Chirality mirrored(Chirality c) {
    return c == Chirality::left    ? Chirality::right
           : c == Chirality::right ? Chirality::left
                                   : Chirality::unknown;
}

/// Seen in a mirror: the other hand, on the other side.
HandFrame mirrored(HandFrame frame) {
    for (Hand& hand : std::span(frame.hands).first(frame.count)) {
        hand.palm_mm.x() = -hand.palm_mm.x();
        for (TrackedPoint& joint : hand.joints) {
            joint.position_mm.x() = -joint.position_mm.x();
        }
        hand.chirality = mirrored(hand.chirality);
    }
    return frame;
}

Direction mirrored(Direction d) {
    switch (d) {
        case Direction::left: return Direction::right;
        case Direction::right: return Direction::left;
        case Direction::clockwise: return Direction::counterclockwise;
        case Direction::counterclockwise: return Direction::clockwise;
        case Direction::none:
        case Direction::up:
        case Direction::down: break;
    }
    return d;
}

TEST(JointRecordings, LeftHandsAreLikeRightOnes) {
    int compared = 0;
    for (const auto& entry :
         fs::is_directory(kJoints) ? fs::directory_iterator(kJoints) : fs::directory_iterator()) {
        const auto frames = read_joint_recording(entry.path() / "joints.csv");
        ASSERT_TRUE(frames.ok()) << frames.error().message;
        auto recogniser = GestureRecogniser::create({});
        auto in_mirror = GestureRecogniser::create({});
        HandFromJoints reader;
        HandFromJoints reader_in_mirror;
        for (HandFrame frame : *frames) {
            HandFrame other = mirrored(frame);
            reader.complete(frame);
            reader_in_mirror.complete(other);
            const auto events = recogniser->push(frame);
            const auto others = in_mirror->push(other);
            ASSERT_EQ(events.size(), others.size()) << entry.path() << " " << frame.stamp.us();
            for (std::size_t i = 0; i < events.size(); ++i) {
                EXPECT_EQ(events[i].type, others[i].type) << entry.path();
                EXPECT_EQ(events[i].phase, others[i].phase);
                EXPECT_EQ(mirrored(events[i].direction), others[i].direction);
                EXPECT_EQ(mirrored(events[i].hand), others[i].hand);
                EXPECT_NEAR(events[i].position_mm.x(), -others[i].position_mm.x(), 0.1F);
                EXPECT_NEAR(events[i].position_mm.y(), others[i].position_mm.y(), 0.1F);
                EXPECT_NEAR(events[i].value, others[i].value, 1e-2F * std::abs(events[i].value));
                compared += events[i].type != GestureType::hand ? 1 : 0;
            }
        }
    }
    if (compared == 0) {
        GTEST_SKIP() << "no recordings at " << kJoints;
    }
    EXPECT_GT(compared, 100);
}

TEST(JointRecordings, VictoriesAreTwosAndThumbsUpAreOnes) {
    GestureSettings settings;
    for (const GestureField& field : gesture_fields()) {
        if (field.is_switch) {
            field.set(settings, 0.0);
        }
    }
    settings.victory = settings.thumb_up = true;
    int twos = 0;
    int ones = 0;
    for (int i = 1; i <= 71; i += 2) {
        const std::string number = std::to_string(i);
        const fs::path folder =
            kJoints / ("sfinge-" + std::string(3 - number.size(), '0') + number);
        if (!fs::exists(folder)) {
            GTEST_SKIP() << "no recordings at " << kJoints;
        }
        const auto frames = read_joint_recording(folder / "joints.csv");
        const auto labels = read_labels(folder / "labels.csv");
        ASSERT_TRUE(frames.ok() && labels.ok());
        auto recogniser = GestureRecogniser::create(settings);
        HandFromJoints reader;
        for (HandFrame frame : *frames) {
            reader.complete(frame);
            for (const GestureEvent& e : recogniser->push(frame)) {
                if (e.type == GestureType::hand || e.phase != EventPhase::begin) {
                    continue;
                }
                const std::string wanted = e.type == GestureType::victory ? "x_two" : "x_one";
                const bool right =
                    std::any_of(labels->begin(), labels->end(), [&](const GestureLabel& label) {
                        return label.gesture == wanted && label.start <= e.sensor &&
                               e.sensor <= label.end;
                    });
                EXPECT_TRUE(right) << folder << " " << to_string(e.type) << " " << e.sensor.us();
                (e.type == GestureType::victory ? twos : ones) += right ? 1 : 0;
            }
        }
    }
    EXPECT_GE(twos, 11);  // of 12
    EXPECT_GE(ones, 7);   // of 11
}

TEST(JointRecordings, GrabsOfAnotherTracker) {
    GestureScorer scorer;
    if (score_all("leap-grab", scorer) == 0) {
        GTEST_SKIP() << "no recordings at " << kJoints;
    }
    EXPECT_EQ(scorer.gestures().at("grab").stray, 2);  // it has two, and no labels to match
    EXPECT_EQ(scorer.all().stray, 2);
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
