// SPDX-License-Identifier: Apache-2.0
// Whole recordings through the whole pipeline: images in, events out.
#include <gtest/gtest.h>

#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <xtrack/labels.hpp>
#include <xtrack/method.hpp>
#include <xtrack/recording.hpp>
#include <xtrack/scoring.hpp>
#include <xtrack/session.hpp>
#include <xtrack/sim.hpp>

namespace xtrack {
namespace {

namespace fs = std::filesystem;

struct Replay {
    std::vector<GestureEvent> gestures;  ///< ends, without hands
    std::string json;                    ///< everything
    std::string error;
};

Replay replay(const fs::path& folder) {
    Replay result;
    auto session = Session::open(folder.string());
    if (!session) {
        result.error = session.error().message;
        return result;
    }
    session->subscribe([&](const GestureEvent& event) {
        result.json += to_json(event) + "\n";
        if (event.type != GestureType::hand && event.phase == EventPhase::end) {
            result.gestures.push_back(event);
        }
    });
    if (const auto ran = session->run(); !ran) {
        result.error = ran.error().message;
    }
    return result;
}

/// One gesture is labelled: it must come within its label (and the 200 ms that scoring allows), and
/// nothing else may.
void expect_only_the_label(const fs::path& folder) {
    const auto labels = read_labels(folder / "labels.csv");
    ASSERT_TRUE(labels) << labels.error().message;
    ASSERT_EQ(labels->size(), 1U);
    const GestureLabel& label = labels->front();
    const Replay got = replay(folder);
    ASSERT_EQ(got.error, "");
    ASSERT_EQ(got.gestures.size(), 1U) << got.json;
    const GestureEvent& event = got.gestures.front();
    EXPECT_EQ(name_of(event), label.gesture);
    EXPECT_GE(event.sensor, label.start);
    EXPECT_LE(event.sensor, label.end + std::chrono::milliseconds(200));
    if (label.hand != Chirality::unknown) {
        EXPECT_EQ(event.hand, label.hand);
    }
}

TEST(Recordings, TheSimulatedSwipeIsFoundAndNothingElse) {
    expect_only_the_label(fs::path(XTRACK_TEST_DATA) / "sim-swipe");
}

TEST(Recordings, ReplayIsBitExact) {
    const fs::path folder = fs::path(XTRACK_TEST_DATA) / "sim-swipe";
    const Replay first = replay(folder);
    const Replay second = replay(folder);
    ASSERT_EQ(first.error, "");
    EXPECT_FALSE(first.json.empty());
    EXPECT_EQ(first.json, second.json);
}

TEST(Recordings, AFolderThatIsNotThereIsNamed) {
    const Replay got = replay("no/such/recording");
    EXPECT_NE(got.error.find("no/such/recording"), std::string::npos);
    EXPECT_EQ(got.error.find('\n'), std::string::npos);
}

TEST(Recordings, DepthWithoutItsCameraIsSentForTheCamera) {
    const fs::path folder = fs::path(testing::TempDir()) / "xtrack_depth_without_rig";
    fs::remove_all(folder);
    auto writer = RecordingWriter::create(folder, {});
    ASSERT_TRUE(writer) << writer.error().message;
    DepthFrame depth;
    depth.depth = Image<std::uint16_t>(160, 120, 7000);
    ASSERT_TRUE(writer->add(depth));
    ASSERT_TRUE(writer->close());
    const auto session = Session::open(folder.string(), {});
    fs::remove_all(folder);
    ASSERT_FALSE(session);
    EXPECT_NE(session.error().message.find("rig.yaml: missing"), std::string::npos);
    EXPECT_NE(session.error().message.find("add camera_matrix"), std::string::npos);
    EXPECT_EQ(session.error().message.find("decode"), std::string::npos);
}

TEST(Recordings, UnknownPresetsOfTheSimulatorNameTheKnownOnes) {
    const Replay got = replay("sim:nonsense");
    EXPECT_NE(got.error.find("ideal-60"), std::string::npos);
}

// The preset's own person, whom the demo shows; docs/measurements/gestures.md counts the others.
TEST(Recordings, ASimulatedPersonIsUnderstood) {
    auto settings = SimSettings::preset("ideal-60");
    ASSERT_TRUE(settings);
    auto rig = SimulatedRig::create(*settings);
    ASSERT_TRUE(rig) << rig.error().message;
    std::vector<GestureLabel> labels;
    for (const SimLabel& label : (*rig)->labels()) {
        labels.push_back({label.gesture,
                          label.hand == SimHand::left ? Chirality::left : Chirality::right,
                          label.start, label.end, label.commit});
    }
    const Duration length = (*rig)->duration();
    auto session = Session::create(std::unique_ptr<FrameSource>(std::move(*rig)), {});
    ASSERT_TRUE(session) << session.error().message;
    std::vector<GestureEvent> events;
    session->subscribe([&](const GestureEvent& event) { events.push_back(event); });
    ASSERT_TRUE(session->run());
    GestureScorer scorer;
    scorer.add(events, labels, length);
    EXPECT_EQ(scorer.all().labelled, 7);
    EXPECT_EQ(scorer.all().correct, 7);
    EXPECT_EQ(scorer.all().false_events(), 0);
}

/// A person before a wall whom fringes show, and nobody has calibrated anything.
struct Uncalibrated {
    const char* preset;
    const char* method;  ///< null: three steps of 128 px
    int found;           ///< of four
};
class WithoutARig : public testing::TestWithParam<Uncalibrated> {};

TEST_P(WithoutARig, SwipesPushesAndWavesAreFound) {
    auto settings = *SimSettings::preset(GetParam().preset);
    if (GetParam().method != nullptr) {
        settings.camera.colour = settings.camera.chroma_422 = true;
        settings.patterns =
            *method_sequence(*method_of(GetParam().method), settings.rig, settings.patterns.axis);
    } else {
        settings.patterns =
            three_step_sequence(settings.patterns.axis, settings.rig.projector->size, 128.0);
    }
    settings.script = {{SimAction::enter, SimHand::right, 0.6}, {SimAction::idle}};
    for (const SimAction action :
         {SimAction::swipe_left, SimAction::push, SimAction::wave, SimAction::swipe_right}) {
        settings.script.push_back({action});
    }
    auto rig = SimulatedRig::create(settings);
    ASSERT_TRUE(rig) << rig.error().message;
    std::vector<GestureLabel> labels;
    for (const SimLabel& label : (*rig)->labels()) {
        labels.push_back({label.gesture, Chirality::right, label.start, label.end, label.commit});
    }
    const Duration length = (*rig)->duration();
    SessionOptions options;
    options.use_rig = false;
    options.gestures.wave = true;
    options.gestures.pinch = false;
    auto session = Session::create(std::unique_ptr<FrameSource>(std::move(*rig)), options);
    ASSERT_TRUE(session) << session.error().message;
    EXPECT_FALSE(session->metric());
    std::vector<GestureEvent> events;
    session->subscribe([&](const GestureEvent& event) {
        EXPECT_FALSE(event.metric);
        events.push_back(event);
    });
    ASSERT_TRUE(session->run());
    GestureScorer scorer(options.gestures);
    scorer.add(events, labels, length);
    std::cout << GetParam().preset << ": " << scorer.all().correct << " of "
              << scorer.all().labelled << " found, " << scorer.all().false_events()
              << " invented\n";
    EXPECT_EQ(scorer.all().labelled, 4);
    EXPECT_GE(scorer.all().correct, GetParam().found);
    EXPECT_LE(scorer.all().false_events(), 1);  // the first stroke of a wave may be a swipe
}

INSTANTIATE_TEST_SUITE_P(Simulated, WithoutARig,
                         testing::Values(Uncalibrated{"webcam-30", "rgb-static", 4},
                                         Uncalibrated{"ideal-60", nullptr, 4}),
                         [](const auto& which) {
                             return which.param.method != nullptr ? "OneColourPattern"
                                                                  : "ThreeSteps";
                         });

/// Recordings of others, not part of the project.
class SharedRecordings : public testing::TestWithParam<const char*> {};

TEST_P(SharedRecordings, TheLabelledGestureIsFoundAndNothingElse) {
    const fs::path folder = fs::path(XTRACK_SHARED_DATA) / GetParam();
    if (!fs::exists(folder)) {
        GTEST_SKIP() << folder << " is not there: recordings that are not part of the project";
    }
    expect_only_the_label(folder);
}

INSTANTIATE_TEST_SUITE_P(Rendered, SharedRecordings,
                         testing::Values("rendered/swipe-left-dual-60",
                                         "rendered/grey-swipe-left-60"));
INSTANTIATE_TEST_SUITE_P(DepthVideo, SharedRecordings,
                         testing::Values("hands/depth/car-01-move-hand-left-subject3-r0",
                                         "hands/depth/car-02-move-hand-right-subject3-r0"));

}  // namespace
}  // namespace xtrack
