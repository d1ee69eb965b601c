// SPDX-License-Identifier: Apache-2.0
#include <xtrack/scoring.hpp>

#include <cmath>

#include <gmock/gmock.h>

namespace xtrack::test {
namespace {

constexpr Duration kLength = std::chrono::seconds{60};

struct Script {
    std::vector<GestureEvent> events;
    int next_id = 1;

    void one_shot(GestureType type, Direction direction, double s,
                  Chirality hand = Chirality::right) {
        GestureEvent e;
        e.type = type;
        e.direction = direction;
        e.hand = hand;
        e.gesture_id = next_id++;
        e.sensor = e.emit = Stamp::from_us(static_cast<std::int64_t>(s * 1e6));
        e.onset = e.sensor - std::chrono::milliseconds{150};
        events.push_back(e);
        e.phase = EventPhase::end;
        events.push_back(e);
    }
    void pinch(double from_s, double to_s, EventPhase how = EventPhase::end) {
        one_shot(GestureType::pinch, Direction::none, from_s);
        events.back().phase = how;
        events.back().sensor = Stamp::from_us(static_cast<std::int64_t>(to_s * 1e6));
    }
    void swipe_left(double s, Chirality hand = Chirality::right) {
        one_shot(GestureType::swipe, Direction::left, s, hand);
    }
};

GestureLabel label(const std::string& gesture, double from_s, double to_s,
                   Chirality hand = Chirality::right) {
    return {gesture, hand, Stamp::from_us(static_cast<std::int64_t>(from_s * 1e6)),
            Stamp::from_us(static_cast<std::int64_t>(to_s * 1e6)), std::nullopt};
}

TEST(Intervals, AreThePublishedOnes) {
    // Wilson 1927: 13 of 16.
    EXPECT_NEAR(wilson(13, 16).low, 0.5699, 1e-3);
    EXPECT_NEAR(wilson(13, 16).high, 0.9341, 1e-3);
    EXPECT_NEAR(wilson(0, 10).high, 0.2775, 1e-3);
    EXPECT_EQ(wilson(0, 0).high, 1.0);
    // Garwood 1936: 0, 3, 20 events.
    EXPECT_NEAR(poisson(0, 1.0).high, 3.689, 1e-3);
    EXPECT_EQ(poisson(0, 1.0).low, 0.0);
    EXPECT_NEAR(poisson(3, 1.0).low, 0.6187, 1e-3);
    EXPECT_NEAR(poisson(3, 1.0).high, 8.767, 1e-3);
    EXPECT_NEAR(poisson(20, 2.0).low, 12.217 / 2, 1e-3);
    EXPECT_NEAR(poisson(20, 2.0).high, 30.888 / 2, 1e-3);
    // Where exp(-mean) is no double any more; from sums with 60 digits.
    EXPECT_NEAR(poisson(745, 1.0).low, 692.45675, 1e-4);
    EXPECT_NEAR(poisson(745, 1.0).high, 800.47326, 1e-4);
    EXPECT_NEAR(poisson(1000, 1.0).low, 938.97302, 1e-4);
    EXPECT_NEAR(poisson(1000, 1.0).high, 1063.95214, 1e-4);
    EXPECT_NEAR(poisson(5000, 1.0).high, 5140.54885, 1e-4);
}

TEST(Intervals, PercentilesInterpolate) {
    EXPECT_DOUBLE_EQ(percentile({4, 1, 3, 2}, 0.5), 2.5);
    EXPECT_DOUBLE_EQ(percentile({1, 2}, 1.0), 2.0);
    EXPECT_TRUE(std::isnan(percentile({}, 0.5)));
}

TEST(Scorer, MatchesBetweenStartAndEndPlus200Ms) {
    const std::vector<GestureLabel> labels{label("swipe_left", 1.0, 2.0)};
    for (const auto& [at_s, hits] : {std::pair{0.999, 0}, {1.0, 1}, {2.2, 1}, {2.201, 0}}) {
        Script script;
        script.swipe_left(at_s);
        GestureScorer scorer;
        scorer.add(script.events, labels, kLength);
        EXPECT_EQ(scorer.all().correct, hits) << at_s;
        EXPECT_EQ(scorer.all().false_events(), 1 - hits) << at_s;
    }
}

TEST(Scorer, EachLabelOnce) {
    Script script;
    script.swipe_left(1.2);
    script.swipe_left(1.8);
    GestureScorer scorer;
    const auto judged =
        scorer.add(script.events, std::vector{label("swipe_left", 1.0, 2.0)}, kLength);
    EXPECT_EQ(judged[0].verdict, Verdict::correct);
    EXPECT_EQ(judged[1].verdict, Verdict::overlap);
    const GestureScore s = scorer.all();
    EXPECT_EQ(s.false_events(), 1);
    EXPECT_EQ(s.false_without_overlaps(), 0);
    EXPECT_DOUBLE_EQ(s.jaccard(), 0.5);
}

TEST(Scorer, EverythingElseIsFalse) {
    Script script;
    script.swipe_left(1.5);  // in a label that is not ours
    script.swipe_left(3.5);  // in a label of ours, of another direction
    script.swipe_left(5.5);  // between
    GestureScorer scorer;
    const auto judged = scorer.add(
        script.events, std::vector{label("x_three", 1.0, 2.0), label("swipe_right", 3.0, 4.0)},
        kLength);
    EXPECT_EQ(judged[0].during, "x_three");
    EXPECT_EQ(judged[1].during, "swipe_right");
    EXPECT_EQ(judged[2].during, "");
    EXPECT_EQ(scorer.all().labelled, 1);
    EXPECT_EQ(scorer.all().correct, 0);
    EXPECT_EQ(scorer.gestures().at("swipe_left").stray, 3);
    EXPECT_DOUBLE_EQ(scorer.all().false_per_label().value, 3.0);
}

TEST(Scorer, ALabelWithoutADirectionMatchesAny) {
    Script script;
    script.swipe_left(1.5);
    script.one_shot(GestureType::swipe, Direction::up, 3.5);
    GestureScorer scorer;
    const auto judged = scorer.add(
        script.events, std::vector{label("swipe", 1, 2), label("swipe_down", 3, 4)}, kLength);
    EXPECT_EQ(judged[0].verdict, Verdict::correct);
    EXPECT_EQ(judged[1].verdict, Verdict::stray);
    EXPECT_EQ(scorer.gestures().at("swipe").labelled, 1);
    EXPECT_EQ(scorer.gestures().at("swipe").correct, 1);
    EXPECT_EQ(scorer.gestures().count("swipe_left"), 0U);
    EXPECT_EQ(scorer.all().labelled, 2);
}

TEST(Scorer, LabelsOfOtherGesturesAskForNothing) {
    GestureSettings settings;
    settings.circle = settings.grab = false;
    GestureScorer scorer(settings);
    scorer.add({}, std::vector{label("circle", 1, 2), label("grab", 3, 4), label("x_one", 5, 6)},
               kLength);
    EXPECT_EQ(scorer.all().labelled, 0);
}

TEST(Scorer, APinchDuringAnOkSignIsOne) {
    Script script;
    script.pinch(1.5, 1.8);
    script.pinch(1.9, 2.0);
    GestureScorer scorer;
    const auto judged = scorer.add(script.events, std::vector{label("x_ok", 1.0, 2.0)}, kLength);
    EXPECT_EQ(judged[0].verdict, Verdict::allowed);
    EXPECT_EQ(judged[1].verdict, Verdict::overlap);
    EXPECT_EQ(scorer.all().labelled, 0);
    EXPECT_EQ(scorer.all().false_events(), 1);
}

TEST(Scorer, CancelledOnesAreNone) {
    Script script;
    script.pinch(1.5, 1.8, EventPhase::cancel);
    script.pinch(4.0, 4.5, EventPhase::cancel);
    script.events.back().cancel_reason = CancelReason::lost;
    GestureScorer scorer;
    const auto judged = scorer.add(script.events, std::vector{label("pinch", 1.0, 2.0)}, kLength);
    ASSERT_EQ(judged.size(), 2U);
    EXPECT_EQ(judged[0].verdict, Verdict::cancelled);
    EXPECT_FALSE(is_false(judged[0].verdict));
    EXPECT_EQ(judged[0].last.us(), 1'800'000);
    EXPECT_EQ(judged[1].verdict, Verdict::cancelled);
    EXPECT_EQ(scorer.all().correct, 0);
    EXPECT_EQ(scorer.all().false_events(), 0);
    EXPECT_EQ(scorer.all().cancelled, 2);
    EXPECT_EQ(scorer.all().cancelled_in_label, 1);
    EXPECT_DOUBLE_EQ(scorer.all().right_cancels().value, 0.5);
    EXPECT_EQ(scorer.all().without_reason, 1);
    EXPECT_EQ(scorer.all().unclosed, 0);
}

TEST(Scorer, ACancelledOneOfAStreamWithoutLabelsIsNoEvent) {
    Script script;
    script.pinch(1.5, 1.8, EventPhase::cancel);
    script.pinch(4.0, 4.5);
    GestureScorer scorer;
    scorer.add(script.events, {}, std::chrono::hours{1});
    EXPECT_EQ(scorer.unlabelled_events(), 1);
}

TEST(Scorer, WhatIsNeverClosedIsCounted) {
    Script script;
    script.pinch(1.5, 1.8, EventPhase::update);
    GestureScorer scorer;
    const auto judged = scorer.add(script.events, std::vector{label("pinch", 1, 2)}, kLength);
    EXPECT_EQ(scorer.all().unclosed, 1);
    EXPECT_EQ(judged.at(0).label, 0U);
}

TEST(Scorer, AddsWhatAnotherFound) {
    Script script;
    script.swipe_left(1.5);
    GestureScorer first, second, third;
    first.add(script.events, std::vector{label("swipe_left", 1, 2)}, kLength);
    second.add(script.events, std::vector{label("x_one", 1, 2)}, kLength);
    third.add(script.events, {}, std::chrono::hours{2});
    GestureScorer sum;
    for (const GestureScorer& one : {first, second, third}) {
        sum.add(one);
    }
    EXPECT_EQ(sum.all().labelled, 1);
    EXPECT_EQ(sum.all().correct, 1);
    EXPECT_EQ(sum.all().stray, 2);
    EXPECT_EQ(sum.unlabelled_events(), 1);
    EXPECT_DOUBLE_EQ(sum.false_per_hour().value, 0.5);
}

TEST(Scorer, TheWrongHandIsCounted) {
    Script script;
    script.swipe_left(1.5, Chirality::left);
    GestureScorer strict;
    strict.add(script.events, std::vector{label("swipe_left", 1, 2, Chirality::right)}, kLength);
    EXPECT_EQ(strict.all().wrong_hand, 1);
    EXPECT_EQ(strict.all().correct, 0);
    EXPECT_DOUBLE_EQ(strict.all().wrong_hands().value, 1.0);
    GestureScorer either;
    either.add(script.events, std::vector{label("swipe_left", 1, 2, Chirality::unknown)}, kLength);
    EXPECT_EQ(either.all().correct, 1);
}

TEST(Scorer, MeasuresLatency) {
    Script script;
    script.swipe_left(1.4);
    GestureScorer scorer;
    GestureLabel told = label("swipe_left", 1.0, 2.0);
    told.commit = Stamp::from_us(1'350'000);
    scorer.add(script.events, std::vector{told}, kLength);
    const GestureScore s = scorer.all();
    EXPECT_DOUBLE_EQ(s.from_commit_ms.at(0), 50.0);
    EXPECT_DOUBLE_EQ(s.from_start_ms.at(0), 400.0);
    EXPECT_DOUBLE_EQ(s.from_onset_ms.at(0), 150.0);
    EXPECT_DOUBLE_EQ(s.from_end_ms.at(0), -600.0);
}

TEST(Scorer, StreamsWithoutLabelsGiveARatePerHour) {
    Script script;
    script.swipe_left(1.0);
    GestureScorer scorer;
    scorer.add(script.events, {}, std::chrono::minutes{30});
    scorer.add({}, {}, std::chrono::minutes{30});
    EXPECT_DOUBLE_EQ(scorer.false_per_hour().value, 1.0);
    EXPECT_NEAR(scorer.false_per_hour().high, 5.572, 1e-3);
}

TEST(Scorer, CountsWavesWhereTheyAreRecognised) {
    Script script;
    script.one_shot(GestureType::wave, Direction::none, 2.5);
    const std::vector<GestureLabel> labels{label("wave", 2.0, 4.0)};
    GestureSettings settings;
    for (const bool wave : {true, false}) {
        settings.wave = wave;
        GestureScorer scorer(settings);
        scorer.add(script.events, labels, kLength);
        EXPECT_EQ(scorer.all().labelled, wave ? 1 : 0);
        EXPECT_EQ(scorer.all().correct, wave ? 1 : 0);
        EXPECT_EQ(scorer.all().false_events(), wave ? 0 : 1);
    }
}

}  // namespace
}  // namespace xtrack::test
