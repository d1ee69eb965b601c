// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "tests/tools/command.hpp"
#include "tools/corpus/definitions.hpp"
#include "tools/corpus/everyday.hpp"
#include "tools/corpus/performer.hpp"
#include "tools/corpus/run.hpp"
#include "tools/corpus/tracked.hpp"

namespace xtrack::tools::corpus {
namespace {

using testing::HasSubstr;

const Vec3f kLeft{1.0F, 0.0F, 0.0F};
const Vec3f kNearer{0.0F, 0.0F, -1.0F};

Person somebody() {
    Person p;
    p.seed = 7;
    p.home_mm = {-40.0F, 20.0F, 600.0F};
    p.chest_mm = 900.0;
    return p;
}

/// At home, then straight and even.
Movement straight(const Vec3f& way, double seconds) {
    Movement m(somebody(), SimHand::right);
    m.go_evenly(m.home(), 0.0);
    m.wait(1.0);
    m.go_evenly(m.home() + way, seconds);
    m.wait(0.5);
    return m;
}

GestureSettings all_gestures() {
    GestureSettings settings;
    for (const GestureField& field : gesture_fields()) {
        if (field.is_switch) {
            field.set(settings, 1.0);
        }
    }
    return settings;
}

TEST(Definitions, AStrokeIsOneWhenItHasItsLengthAndItsSpeed) {
    const Movement fast = straight(kLeft * 300.0F, 0.5);  // 600 mm/s
    const auto commit = definitions::stroke(fast, kLeft, 1.0, 1.5);
    ASSERT_TRUE(commit.has_value());
    EXPECT_NEAR(*commit, 1.0 + 100.0 / 600.0, 0.005);
    EXPECT_FALSE(definitions::stroke(fast, -kLeft, 1.0, 1.5).has_value());
    const Movement slow = straight(kLeft * 300.0F, 1.2);  // 250 mm/s
    EXPECT_FALSE(definitions::stroke(slow, kLeft, 1.0, 2.2).has_value());
    const Movement shorter = straight(kLeft * 90.0F, 0.15);
    EXPECT_FALSE(definitions::stroke(shorter, kLeft, 1.0, 1.5).has_value());
    const Movement askew = straight(Vec3f(200.0F, 200.0F, 0.0F), 0.5);
    EXPECT_FALSE(definitions::stroke(askew, kLeft, 1.0, 1.5).has_value());
    EXPECT_TRUE(definitions::fulfilled_before(fast, "swipe_left", 1.2));
    EXPECT_FALSE(definitions::fulfilled_before(fast, "swipe_right", 1.2));
    EXPECT_FALSE(definitions::fulfilled_before(fast, "push", 1.2));
}

TEST(Definitions, AThrustIsMeasuredOverItsWindow) {
    const Movement push = straight(kNearer * 150.0F, 0.3);  // 500 mm/s
    const auto commit = definitions::thrust(push, kNearer, 1.0, 1.3);
    ASSERT_TRUE(commit.has_value());
    EXPECT_NEAR(*commit, 1.0 + 0.240 * 330.0 / 500.0, 0.005);
    EXPECT_FALSE(definitions::thrust(push, -kNearer, 1.0, 1.3).has_value());
    EXPECT_FALSE(definitions::thrust(straight(kNearer * 150.0F, 0.5), kNearer, 1.0, 1.5));
}

TEST(Definitions, AForceIsFilledByLessWayTheFasterItIs) {
    const auto slow = definitions::press(straight(kNearer * 60.0F, 0.4), 1.0, 1.4);  // 150 mm/s
    ASSERT_TRUE(slow.has_value());
    EXPECT_NEAR(*slow, 1.0 + 42.0 / 150.0, 0.005);
    const auto fast = definitions::press(straight(kNearer * 60.0F, 0.12), 1.0, 1.2);  // 500 mm/s
    ASSERT_TRUE(fast.has_value());
    EXPECT_NEAR(*fast, 1.0 + 8.0 / 500.0, 0.005);
}

TEST(Performer, EveryGestureOfTheVocabularyFulfilsItsDefinition) {
    const GestureSettings settings = all_gestures();
    const std::vector<std::string> names = names_of(settings);
    EXPECT_THAT(names, testing::IsSupersetOf({"swipe_left", "circle_clockwise", "pull", "fist",
                                              "two_hand_zoom", "drag", "touch", "dwell"}));
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
        const Sequence s = perform_all(names, draw_person(seed), 1, {});
        EXPECT_EQ(s.short_of_definition, 0) << seed;
        EXPECT_EQ(s.labels.size(), names.size()) << seed;
        std::set<std::string> performed;
        for (const GestureLabel& label : s.labels) {
            performed.insert(label.gesture);
            ASSERT_TRUE(label.commit.has_value()) << label.gesture;
            EXPECT_LT(label.start, *label.commit) << label.gesture << " of " << seed;
            EXPECT_LE(*label.commit, label.end) << label.gesture << " of " << seed;
        }
        EXPECT_EQ(performed.size(), names.size()) << seed;
    }
}

TEST(Performer, AsksForWhatSomebodyMeantWhoCannotFulfilIt) {
    const Sequence s =
        perform_all({"swipe_left", "push"}, draw_person(3, Manner::slow_and_short), 2, {});
    EXPECT_EQ(s.labels.size(), 4U);
    EXPECT_EQ(s.short_of_definition, 0);
}

TEST(Everyday, HoldsNoPinchAndNoFist) {
    const Sequence s = everyday(5, 120.0, {});
    ASSERT_FALSE(s.hands.empty());
    EXPECT_TRUE(s.labels.empty());
    EXPECT_FALSE(definitions::pinch(s.hands[0], 0.0, s.end_s).has_value());
    EXPECT_FALSE(definitions::grab(s.hands[0], 0.0, s.end_s).has_value());
    // It is not one thing all the time.
    std::set<std::string> doings;
    for (double t = 0.0; t < s.end_s; t += 1.0) {
        doings.insert(s.hands[0].doing_at(t));
    }
    EXPECT_GE(doings.size(), 4U);
}

TEST(Tracked, AHandAtRestJittersAsItWasMeasured) {
    Movement m(somebody(), SimHand::right);
    m.go_evenly(m.home(), 0.0);
    m.wait(60.0);
    const std::array<const Movement*, 1> hands{&m};
    Tracked tracked(View::fine, 60.0, 1, hands);
    double sum = 0.0;
    int count = 0;
    for (int i = 60; i < 3600; ++i) {
        const double t = i / 60.0;
        const HandFrame& frame = tracked.at(t);
        if (frame.count == 0) {
            continue;
        }
        const SeenHand truth = look_at(m.at(t), SimHand::right, 1.0F, corpus_camera());
        const double off = frame.hands[0].palm_mm.z() - truth.palm_mm.z();
        sum += off * off;
        ++count;
        ASSERT_EQ(tracked.owner_of(frame.hands[0].id), 0U);
    }
    EXPECT_GT(count, 3400);
    const double sigma = noise_of(View::fine).palm_deep_mm[0];
    EXPECT_NEAR(std::sqrt(sum / count), sigma, 0.2 * sigma);
}

TEST(Tracked, ABodyHidesAHandFromACameraOfDepthAlone) {
    Movement m(somebody(), SimHand::right);
    m.go_evenly({0.0F, 60.0F, 870.0F}, 0.0);
    m.wait(1.0);
    const std::array<const Movement*, 1> hands{&m};
    EXPECT_EQ(Tracked(View::fine, 60.0, 1, hands).at(0.5).count, 0U);
    EXPECT_EQ(Tracked(View::joints, 60.0, 1, hands).at(0.5).count, 1U);
}

TEST(Tracked, AHandThatWasAwayHasAnotherId) {
    Movement m(somebody(), SimHand::right);
    m.go_evenly(m.home(), 0.0);
    m.wait(0.5);
    m.go_evenly(m.away(), 0.0);
    m.wait(0.5);
    m.go_evenly(m.home(), 0.0);
    m.wait(0.5);
    const std::array<const Movement*, 1> hands{&m};
    Tracked tracked(View::joints, 60.0, 1, hands);
    EXPECT_EQ(tracked.at(0.25).hands[0].id, 1);
    EXPECT_EQ(tracked.at(0.75).count, 0U);
    EXPECT_EQ(tracked.at(1.25).hands[0].id, 2);
}

GestureSettings no_gestures() {
    GestureSettings settings;
    for (const GestureField& field : gesture_fields()) {
        if (field.is_switch) {
            field.set(settings, 0.0);
        }
    }
    return settings;
}

TEST(Run, FindsTheSwipesOfSomebodySeenClearlyAndTheSameAgain) {
    GestureSettings settings = no_gestures();
    settings.swipe = true;
    Person person = somebody();
    person.speed_mmps = 700.0;
    const Sequence s = perform_all(names_of(settings), person, 3, {});
    const auto first = run(s, settings);
    ASSERT_TRUE(first);
    EXPECT_EQ(first->all().labelled, 12);
    EXPECT_GE(first->all().correct, 11);
    EXPECT_LT(percentile(first->all().from_commit_ms, 0.5), 120.0);
    const auto again = run(perform_all(names_of(settings), person, 3, {}), settings);
    ASSERT_TRUE(again);
    EXPECT_EQ(again->all().from_commit_ms, first->all().from_commit_ms);
    EXPECT_EQ(again->findings.size(), first->findings.size());
}

// Grabs whose hands open in the same image: the pinches that gave way to them say nothing of it.
TEST(Run, TwoHandsThatOpenTogetherHaveEnded) {
    GestureSettings settings = no_gestures();
    settings.two_hand_zoom = settings.two_hand_rotate = true;
    const auto tally =
        run(perform_all(names_of(settings), draw_person(11), 3, {View::joints, 60.0}), settings);
    ASSERT_TRUE(tally);
    EXPECT_EQ(tally->all().labelled, 6);
    EXPECT_GE(tally->all().correct, 5);
    EXPECT_EQ(tally->all().cancelled, 0);
}

TEST(Run, WhatStrangersDoIsTheirs) {
    GestureSettings settings;
    settings.pinch = false;
    Sequence s = perform_all(names_of(settings), somebody(), 1, {});
    s.strange = {true};
    s.labels.clear();
    const auto tally = run(s, settings);
    ASSERT_TRUE(tally);
    EXPECT_EQ(tally->false_events, 0);
    EXPECT_GE(tally->strange_events, 4);
}

TEST(Command, TheSameSeedGivesTheSameFigures) {
    const std::vector<std::string> arguments{"corpus", "--gestures", "swipe,push", "--people",
                                             "2",      "--hours",    "0.1",        "--json"};
    const test::Outcome first = test::xtrack_command(arguments);
    ASSERT_EQ(first.status, 0) << first.err;
    EXPECT_EQ(test::xtrack_command(arguments).out, first.out);
    std::vector<std::string> others = arguments;
    others.insert(others.end(), {"--seed", "2"});
    EXPECT_NE(test::xtrack_command(others).out, first.out);

    const auto groups = nlohmann::json::parse(first.out);
    std::set<std::string> parts;
    for (const auto& group : groups) {
        parts.insert(group.at("part").get<std::string>());
        if (group.at("part") == "everyday") {
            EXPECT_NEAR(group.at("hours").get<double>(), 1.0 / 6.0, 1e-6);
            EXPECT_EQ(group.at("all").at("labelled"), 0);
        }
        if (group.at("part") == "company") {
            EXPECT_EQ(group.at("all").at("labelled"), 10);
        }
    }
    EXPECT_EQ(parts, (std::set<std::string>{"gestures", "manners", "everyday", "engaged",
                                            "passers-by", "company"}));
}

TEST(Command, SavesWhatEvalReads) {
    const test::TemporaryFolder folder;
    const test::Outcome saved =
        test::xtrack_command({"corpus", "--only", "gestures", "--gestures", "swipe", "--people",
                              "1", "--save", folder.path().string(), "--json"});
    ASSERT_EQ(saved.status, 0) << saved.err;
    std::vector<std::string> recordings;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
        recordings.push_back(entry.path().string());
    }
    ASSERT_EQ(recordings.size(), 1U);
    const test::Outcome judged =
        test::xtrack_command({"eval", recordings[0], "--gestures", "swipe", "--json"});
    ASSERT_EQ(judged.status, 0) << judged.err;
    EXPECT_EQ(nlohmann::json::parse(judged.out).at("all").at("labelled"), 12);
}

TEST(Command, SaysWhatIsWrongWithItsArguments) {
    const auto said = [](const std::vector<std::string>& arguments) {
        const test::Outcome outcome = test::xtrack_command(arguments);
        EXPECT_EQ(outcome.status, 2);
        EXPECT_TRUE(test::is_one_line_message(outcome.err)) << outcome.err;
        return outcome.err;
    };
    EXPECT_THAT(said({"corpus", "--gestures", "nix"}), HasSubstr("'nix' is not known"));
    EXPECT_THAT(said({"corpus", "--set", "nix=1"}), HasSubstr("nix"));
    EXPECT_THAT(said({"corpus", "--set", "swipe_speed_mmps"}), HasSubstr("NAME=VALUE"));
    EXPECT_THAT(said({"corpus", "--only", "nix"}), HasSubstr("--only"));
    EXPECT_THAT(said({"corpus", "--hours", "0"}), HasSubstr("--hours"));
}

}  // namespace
}  // namespace xtrack::tools::corpus
