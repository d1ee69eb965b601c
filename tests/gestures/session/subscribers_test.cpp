// SPDX-License-Identifier: Apache-2.0
#include "gestures/session/subscribers.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

namespace xtrack {
namespace {

TEST(Subscribers, CallsEachInOrderOfSubscription) {
    Subscribers<int> subscribers;
    std::string heard;
    subscribers.add(1, [&](int v) { heard += "a" + std::to_string(v); });
    subscribers.add(2, [&](int v) { heard += "b" + std::to_string(v); });
    subscribers.call(7);
    EXPECT_EQ(heard, "a7b7");
}

TEST(Subscribers, RemovesItselfInsideItsOwnCall) {
    Subscribers<int> subscribers;
    int calls = 0;
    subscribers.add(1, [&](int) {
        ++calls;
        subscribers.remove(1);
    });
    subscribers.call(0);
    subscribers.call(0);
    EXPECT_EQ(calls, 1);
    EXPECT_TRUE(subscribers.empty());
}

TEST(Subscribers, OneAddedInsideACallHearsTheNextOnly) {
    Subscribers<int> subscribers;
    int late = 0;
    subscribers.add(1, [&](int v) {
        if (v == 0) {
            subscribers.add(2, [&](int) { ++late; });
        }
    });
    subscribers.call(0);
    EXPECT_EQ(late, 0);
    subscribers.call(1);
    EXPECT_EQ(late, 1);
}

TEST(Subscribers, MayChangeInOneThreadWhileAnotherCalls) {
    Subscribers<int> subscribers;
    std::atomic<bool> done{false};
    std::atomic<int> heard{0};
    subscribers.add(1, [&](int) { ++heard; });
    std::thread changer([&] {
        for (int i = 2; i < 500; ++i) {
            subscribers.add(i, [&](int) { ++heard; });
            subscribers.remove(i);
        }
        done = true;
    });
    int calls = 0;
    while (!done) {
        subscribers.call(0);
        ++calls;
    }
    changer.join();
    EXPECT_GE(heard, calls);
}

TEST(Subscribers, WhatACallbackHoldsMayCallBackAsItDies) {
    Subscribers<int> subscribers;
    struct Token {
        Subscribers<int>& subscribers;
        ~Token() { subscribers.remove(2); }
    };
    int calls = 0;
    subscribers.add(1, [token = std::make_shared<Token>(Token{subscribers})](int) {});
    subscribers.add(2, [&](int) { ++calls; });
    subscribers.remove(1);
    subscribers.call(0);
    EXPECT_EQ(calls, 0);
}

}  // namespace
}  // namespace xtrack
