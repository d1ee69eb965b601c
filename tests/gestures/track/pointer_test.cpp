// SPDX-License-Identifier: Apache-2.0
#include "gestures/track/pointer.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <random>
#include <vector>

namespace xtrack {
namespace {

constexpr Duration kFrame = std::chrono::microseconds(16667);

HandFrame hand_at(int id, float x_mm, int frame) {
    HandFrame hands;
    hands.stamp = Stamp{} + kFrame * frame;
    hands.coordinates = CoordinateFrame::interaction;
    hands.count = 1;
    hands.hands[0].id = id;
    hands.hands[0].palm_mm = {x_mm, 0.0F, 500.0F};
    return hands;
}

/// Hands that move evenly, with the velocity that a line fit over 100 ms of noisy palms gives.
struct Course {
    double mmps = 0.0;
    double noise_mm = 0.0;
    Duration ahead = Duration::zero();

    /// Pointer minus the true palm at the frame, after two seconds. mm, x
    [[nodiscard]] std::vector<double> errors() const {
        std::mt19937 random(17);
        std::normal_distribution<double> noise(0.0, 1.0);
        Pointer pointer;
        std::vector<double> xs;
        std::vector<double> out;
        const double dt_s = to_seconds(kFrame);
        for (int i = 0; i < 1320; ++i) {
            const double truth_mm = mmps * dt_s * i;
            xs.push_back(truth_mm + noise_mm * noise(random));
            HandFrame hands = hand_at(1, static_cast<float>(xs.back()), i);
            hands.hands[0].palm_velocity_mmps.x() = static_cast<float>(slope(xs, dt_s));
            pointer.update(hands, ahead);
            if (i >= 120) {
                out.push_back(static_cast<double>(hands.hands[0].pointer_mm.x()) - truth_mm);
            }
        }
        return out;
    }

    static double slope(const std::vector<double>& xs, double dt_s) {
        const int n = static_cast<int>(std::min<std::size_t>(xs.size(), 7));
        double sum = 0.0;
        double norm = 0.0;
        for (int k = 0; k < n; ++k) {
            const double t = (k - 0.5 * (n - 1)) * dt_s;
            sum += t * xs[xs.size() - static_cast<std::size_t>(n - k)];
            norm += t * t;
        }
        return norm > 0.0 ? sum / norm : 0.0;
    }
};

double mean_of(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double rms_of(const std::vector<double>& values) {
    const double mean = mean_of(values);
    double sum = 0.0;
    for (const double v : values) {
        sum += (v - mean) * (v - mean);
    }
    return std::sqrt(sum / static_cast<double>(values.size()));
}

TEST(Pointer, OfAStillHandJittersByHalfAMillimetre) {
    for (const int ahead_ms : {0, 60}) {
        const double rms_mm =
            rms_of(Course{0.0, 2.0, std::chrono::milliseconds{ahead_ms}}.errors());
        std::printf("still, 2 mm in, %d ms ahead: %.2f mm rms\n", ahead_ms, rms_mm);
        EXPECT_LE(rms_mm, 0.5) << ahead_ms;
    }
}

TEST(Pointer, LagsBy12MsAt300Mmps) {
    const double lag_ms = -mean_of(Course{300.0, 0.0}.errors()) / 0.3;
    std::printf("300 mm/s: %.1f ms behind\n", lag_ms);
    EXPECT_LE(lag_ms, 12.0);
    EXPECT_GT(lag_ms, 0.0);
}

TEST(Pointer, GoesAheadOfAHandThatMoves) {
    const double ahead_ms =
        mean_of(Course{300.0, 0.0, std::chrono::milliseconds{60}}.errors()) / 0.3;
    EXPECT_NEAR(ahead_ms, 60.0, 12.0);
    const double most_ms = mean_of(Course{300.0, 0.0, std::chrono::seconds{5}}.errors()) / 0.3;
    EXPECT_LE(most_ms, 150.0);
}

TEST(Pointer, IsCalmWhereThePalmTrembles) {
    Pointer pointer;
    float low = 1e9F;
    float high = -1e9F;
    for (int i = 0; i < 240; ++i) {
        HandFrame hands = hand_at(1, i % 2 == 0 ? 2.0F : -2.0F, i);
        pointer.update(hands);
        if (i > 60) {
            low = std::min(low, hands.hands[0].pointer_mm.x());
            high = std::max(high, hands.hands[0].pointer_mm.x());
        }
    }
    EXPECT_LT(high - low, 1.5F);  // the palm: 4 mm
}

TEST(Pointer, FollowsAMovingPalmWithin20ms) {
    Pointer pointer;
    HandFrame hands;
    for (int i = 0; i < 120; ++i) {
        hands = hand_at(1, 5.0F * static_cast<float>(i), i);  // 300 mm/s
        pointer.update(hands);
    }
    EXPECT_NEAR(hands.hands[0].pointer_mm.x(), hands.hands[0].palm_mm.x(), 300.0F * 0.020F);
}

TEST(Pointer, ANewHandStartsWhereItIs) {
    Pointer pointer;
    HandFrame hands;
    for (int i = 0; i < 30; ++i) {
        hands = hand_at(1, -200.0F, i);
        pointer.update(hands);
    }
    hands = hand_at(2, 200.0F, 30);
    pointer.update(hands);
    EXPECT_FLOAT_EQ(hands.hands[0].pointer_mm.x(), 200.0F);
}

TEST(Pointer, TwoHandsDoNotMix) {
    Pointer pointer;
    HandFrame hands;
    for (int i = 0; i < 60; ++i) {
        hands = hand_at(1, -100.0F, i);
        hands.count = 2;
        hands.hands[1].id = 2;
        hands.hands[1].palm_mm = {100.0F, 0.0F, 500.0F};
        if (i % 2 == 1) {
            std::swap(hands.hands[0], hands.hands[1]);
        }
        pointer.update(hands);
    }
    for (const Hand& hand : hands.all()) {
        EXPECT_FLOAT_EQ(hand.pointer_mm.x(), hand.palm_mm.x());
    }
}

TEST(Pointer, ANewHandTakesNoneFromOneThatStays) {
    Pointer pointer;
    HandFrame both;
    const auto show = [&](int first, int second, int frame) {
        both = hand_at(first, -100.0F, frame);
        both.count = 2;
        both.hands[1].id = second;
        // Where hand 1 stays a filter lags behind its palm, and a new one would not.
        both.hands[1].palm_mm = {5.0F * static_cast<float>(frame), 0.0F, 500.0F};
        pointer.update(both);
        return both.hands[1].palm_mm.x() - both.hands[1].pointer_mm.x();
    };
    float lag = 0.0F;
    for (int i = 0; i < 30; ++i) {
        HandFrame hands = hand_at(1, 5.0F * static_cast<float>(i), i);
        hands.count = 2;
        hands.hands[1].id = 2;
        hands.hands[1].palm_mm = {-100.0F, 0.0F, 500.0F};
        pointer.update(hands);
        lag = hands.hands[0].palm_mm.x() - hands.hands[0].pointer_mm.x();
    }
    ASSERT_GT(lag, 1.0F);
    EXPECT_NEAR(show(3, 1, 30), lag, 0.5F);  // as 2 leaves 3 comes, and is told of first
}

}  // namespace
}  // namespace xtrack
