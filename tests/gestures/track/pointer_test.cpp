// SPDX-License-Identifier: Apache-2.0
#include "gestures/track/pointer.hpp"

#include <gtest/gtest.h>

#include <cmath>

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
