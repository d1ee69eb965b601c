// SPDX-License-Identifier: Apache-2.0
//
// The ways to run a session: callbacks, polling, steps, a thread.
#include <xtrack/session.hpp>

#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tests/gestures/pipeline/session_sources.hpp"

namespace xtrack {
namespace {

using namespace std::chrono_literals;
using test::callers_session;
using test::kRest_s;
using test::kSwipeSpeed_mmps;
using test::swiping_session;

TEST(Session, CallsBackForTheGestureSubscribedTo) {
    auto session = swiping_session();
    ASSERT_TRUE(session) << session.error().message;
    std::vector<GestureEvent> swipes;
    int pushes = 0;
    session->subscribe(GestureType::swipe, [&](const GestureEvent& e) { swipes.push_back(e); });
    session->subscribe(GestureType::push, [&](const GestureEvent&) { ++pushes; });
    ASSERT_TRUE(session->run());
    ASSERT_EQ(swipes.size(), 2U);
    EXPECT_EQ(swipes[0].phase, EventPhase::begin);
    EXPECT_EQ(swipes[1].phase, EventPhase::end);
    EXPECT_EQ(swipes[1].direction, Direction::left);
    EXPECT_EQ(swipes[1].hand, Chirality::right);
    EXPECT_EQ(pushes, 0);
    // It commits after 100 mm, and the replay's clock is the stream's.
    EXPECT_NEAR(to_seconds(swipes[1].sensor - Stamp{}), kRest_s + 100.0 / kSwipeSpeed_mmps, 0.08);
    EXPECT_EQ(swipes[1].emit, swipes[1].sensor);
}

TEST(Session, TheDecodersSettingsChangeWhileItRuns) {
    auto session = Session::open("sim");
    ASSERT_TRUE(session) << session.error().message;
    EXPECT_EQ(session->method(), DecodeMethod::pattern);
    int depths = 0;
    std::size_t known = 0;
    session->subscribe_pipeline([&](const PipelineView& view) {
        if (view.depth == nullptr) {
            return;
        }
        known = 0;
        for (int y = 0; y < view.depth->depth.height(); ++y) {
            for (int x = 0; x < view.depth->depth.width(); ++x) {
                known += view.depth->depth.at(x, y) != 0 ? 1U : 0U;
            }
        }
        ++depths;
        if (depths == 3) {
            DecodeSettings settings = session->decode_settings();
            settings.min_modulation = 127.0;
            EXPECT_TRUE(session->set_decode_settings(settings));
            settings.order = OrderSource::none;
            EXPECT_FALSE(session->set_decode_settings(settings)) << "a session needs depth";
        }
    });
    std::vector<std::size_t> seen;
    while (depths < 4) {
        ASSERT_TRUE(session->step());
        seen.push_back(known);
    }
    EXPECT_GT(seen[seen.size() - 2], 10000U);
    EXPECT_EQ(seen.back(), 0U);
    EXPECT_EQ(session->decode_settings().min_modulation, 127.0);

    auto hands = swiping_session();
    ASSERT_TRUE(hands);
    EXPECT_EQ(hands->method(), DecodeMethod::automatic);
    const auto refused = hands->set_decode_settings({});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::unsupported);
}

// What a callback was given stays there while another changes what the decoder is made of.
TEST(Session, ADecoderMadeAnewLeavesTheViewAlone) {
    auto session = Session::open("sim");
    ASSERT_TRUE(session) << session.error().message;
    int depths = 0;
    std::size_t before = 0;
    const auto known_in = [](const DepthFrame& depth) {
        std::size_t known = 0;
        for (int y = 0; y < depth.depth.height(); ++y) {
            for (int x = 0; x < depth.depth.width(); ++x) {
                known += depth.depth.at(x, y) != 0 ? 1U : 0U;
            }
        }
        return known;
    };
    session->subscribe_pipeline([&](const PipelineView& view) {
        if (view.depth == nullptr || ++depths != 3) {
            return;
        }
        before = known_in(*view.depth);
        for (const int threads : {2, 1, 3}) {
            DecodeSettings settings = session->decode_settings();
            settings.threads = threads;
            EXPECT_TRUE(session->set_decode_settings(settings));
        }
        EXPECT_EQ(known_in(*view.depth), before);
        EXPECT_EQ(known_in(view.decoder->depth()), before);
    });
    session->subscribe_pipeline([&](const PipelineView& view) {
        if (depths == 3 && view.depth != nullptr) {
            EXPECT_EQ(known_in(*view.depth), before);
        }
    });
    while (depths < 5) {
        ASSERT_TRUE(session->step());
    }
    EXPECT_GT(before, 10000U);
    DecodeSettings settings;
    settings.mode = CaptureMode::hold;
    EXPECT_FALSE(session->set_decode_settings(settings)) << "of the PaperDecoder alone";
}

TEST(Session, TwoReplaysGiveTheSameEvents) {
    std::string runs[2];
    for (std::string& text : runs) {
        auto session = swiping_session();
        ASSERT_TRUE(session);
        session->subscribe([&](const GestureEvent& e) { text += to_json(e) + "\n"; });
        ASSERT_TRUE(session->run());
    }
    EXPECT_FALSE(runs[0].empty());
    EXPECT_EQ(runs[0], runs[1]);
}

TEST(Session, PollsTheSameEvents) {
    auto session = swiping_session();
    ASSERT_TRUE(session);
    std::vector<std::string> called;
    session->subscribe([&](const GestureEvent& e) { called.push_back(to_json(e)); });
    ASSERT_TRUE(session->run());
    std::vector<std::string> polled;
    GestureEvent e;
    while (session->poll(e)) {
        polled.push_back(to_json(e));
    }
    EXPECT_FALSE(polled.empty());
    EXPECT_EQ(polled, called);
}

TEST(Session, StepsInTheCallersThread) {
    auto session = swiping_session();
    ASSERT_TRUE(session);
    const auto mine = std::this_thread::get_id();
    int swipes = 0;
    session->subscribe(GestureType::swipe, [&](const GestureEvent&) {
        EXPECT_EQ(std::this_thread::get_id(), mine);
        ++swipes;
    });
    int processed = 0;
    for (int i = 0; i < 100; ++i) {
        const auto status = session->step();
        ASSERT_TRUE(status);
        processed += *status == StepStatus::processed ? 1 : 0;
    }
    EXPECT_EQ(processed, 100);
    auto last = session->step();
    ASSERT_TRUE(last);
    EXPECT_EQ(*last, StepStatus::end);
    last = session->step();
    ASSERT_TRUE(last);
    EXPECT_EQ(*last, StepStatus::end);
    EXPECT_EQ(swipes, 2);
}

TEST(Session, StopsFromACallback) {
    auto session = swiping_session(Pace::replay, 10'000);
    ASSERT_TRUE(session);
    session->subscribe(GestureType::swipe, [&](const GestureEvent&) { session->stop(); });
    ASSERT_TRUE(session->run());
    EXPECT_LT(session->statistics().items, 100U);
    const auto after = session->step();
    ASSERT_TRUE(after);
    EXPECT_EQ(*after, StepStatus::stopped);
}

TEST(Session, StopsFromAnotherThreadWhileASourceIsSilent) {
    auto session = swiping_session(Pace::own_pace, 3, SourceStatus::timeout);
    ASSERT_TRUE(session);
    ASSERT_TRUE(session->start());
    EXPECT_FALSE(session->start());
    EXPECT_FALSE(session->run());
    while (session->statistics().items < 3) {
        std::this_thread::sleep_for(1ms);
    }
    session->stop();
    EXPECT_TRUE(session->wait());
    session->stop();  // again is harmless
}

TEST(Session, IsDestroyedWhileItRuns) {
    auto session = swiping_session(Pace::own_pace, 3, SourceStatus::timeout);
    ASSERT_TRUE(session);
    ASSERT_TRUE(session->start());
}

TEST(Session, PlaysItsSourceOnce) {
    for (const Pace pace : {Pace::replay, Pace::own_pace}) {
        auto session = swiping_session(pace, 3);
        ASSERT_TRUE(session);
        ASSERT_TRUE(session->run());
        EXPECT_EQ(session->statistics().items, 3U);
        EXPECT_TRUE(session->run());
        ASSERT_TRUE(session->start());
        EXPECT_TRUE(session->wait());
        EXPECT_EQ(session->statistics().items, 3U);
    }
}

TEST(Session, AssigningEndsTheSessionThatWasThere) {
    auto token = std::make_shared<int>(0);
    const std::weak_ptr<int> alive = token;
    auto first = callers_session(
        [token = std::move(token)](HandFrame&) {
            std::this_thread::sleep_for(1ms);
            return SourceStatus::timeout;
        },
        Pace::live);
    auto second = swiping_session(Pace::replay, 3);
    ASSERT_TRUE(first && second);
    ASSERT_TRUE(first->start());
    *first = std::move(*second);
    EXPECT_TRUE(alive.expired());
    EXPECT_TRUE(first->run());
    EXPECT_EQ(first->statistics().items, 3U);
}

TEST(Session, WhatAStepHasReadARunStillPlays) {
    auto session = swiping_session(Pace::own_pace, 3);
    ASSERT_TRUE(session);
    ASSERT_TRUE(session->step());
    ASSERT_TRUE(session->step());  // reads an item that is due 17 ms later
    ASSERT_TRUE(session->run());
    EXPECT_EQ(session->statistics().items, 3U);
}

TEST(Session, UnsubscribedCallbacksAreNotCalled) {
    auto session = swiping_session();
    ASSERT_TRUE(session);
    int calls = 0;
    const int a = session->subscribe([&](const GestureEvent&) { ++calls; });
    int frames = 0;
    session->subscribe_hands([&](const HandFrame&) { ++frames; });
    session->unsubscribe(a);
    ASSERT_TRUE(session->run());
    EXPECT_EQ(calls, 0);
    EXPECT_EQ(frames, 100);
}

}  // namespace
}  // namespace xtrack
