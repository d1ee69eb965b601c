// SPDX-License-Identifier: Apache-2.0
//
// Sessions and the clock: paces, time-outs, what is slow.
#include <xtrack/session.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "tests/gestures/pipeline/session_sources.hpp"

namespace xtrack {
namespace {

using namespace std::chrono_literals;
using test::callers_session;
using test::kFrame;
using test::swiping_session;
using test::SwipingHand;

TEST(Session, OwnPaceTakesAsLongAsTheRecording) {
    constexpr int kFrames = 12;
    auto session = swiping_session(Pace::own_pace, kFrames);
    ASSERT_TRUE(session);
    const auto begin = std::chrono::steady_clock::now();
    ASSERT_TRUE(session->run());
    EXPECT_GE(std::chrono::steady_clock::now() - begin, kFrame * (kFrames - 1));
}

TEST(Session, AStepThatIsNotDueWaitsNoLongerThanAsked) {
    SessionOptions options;
    options.pace = Pace::own_pace;
    auto session = Session::create(
        std::unique_ptr<HandSource>(new SwipingHand(3, SourceStatus::end, 1h)), options);
    ASSERT_TRUE(session);
    auto status = session->step();
    ASSERT_TRUE(status);
    EXPECT_EQ(*status, StepStatus::processed);
    status = session->step(1ms);
    ASSERT_TRUE(status);
    EXPECT_EQ(*status, StepStatus::waiting);
}

TEST(Session, ALoopThatStepsUntilItWaitsKeepsUp) {
    constexpr auto kTurn = 50ms;  // three items
    constexpr int kFrames = 30;
    auto session = swiping_session(Pace::own_pace, kFrames);
    ASSERT_TRUE(session);
    std::optional<std::chrono::steady_clock::time_point> begin;
    Duration behind{};
    session->subscribe_hands([&](const HandFrame& hands) {
        const auto now = std::chrono::steady_clock::now();
        begin = begin.value_or(now);
        behind = now - *begin - (hands.stamp - Stamp{});
    });
    while (session->statistics().items < kFrames) {
        auto status = session->step();
        while (status && *status == StepStatus::processed) {
            status = session->step();
        }
        ASSERT_TRUE(status);
        std::this_thread::sleep_for(kTurn);
    }
    EXPECT_LT(behind, 4 * kTurn);
}

TEST(Session, AStepWaitsForWhatIsDueSoon) {
    auto session = swiping_session(Pace::own_pace, 3);
    ASSERT_TRUE(session);
    for (int i = 0; i < 3; ++i) {
        const auto status = session->step(1s);
        ASSERT_TRUE(status);
        EXPECT_EQ(*status, StepStatus::processed);
    }
}

TEST(Session, ASourceThatHasNothingIsAskedAgainAndNotAllTheTime) {
    for (const SourceStatus nothing : {SourceStatus::lost, SourceStatus::timeout}) {
        for (const Pace pace : {Pace::replay, Pace::own_pace, Pace::live}) {
            int asked = 0;
            auto session = callers_session(
                [&](HandFrame&) { return ++asked < 5 ? nothing : SourceStatus::end; }, pace);
            ASSERT_TRUE(session);
            const auto begin = std::chrono::steady_clock::now();
            ASSERT_TRUE(session->start());
            EXPECT_TRUE(session->wait());
            EXPECT_EQ(asked, 5);
            EXPECT_GE(std::chrono::steady_clock::now() - begin, 4 * 20ms);
            EXPECT_EQ(session->statistics().dropped, 0U);
        }
    }
}

/// A hand that is held up for a while before one of its frames: within the call, or as a source
/// that keeps its time-outs says it.
class StallingHand final : public HandSource {
 public:
    static constexpr int kFrames = 23;

    StallingHand(int before, Duration stall, bool keeps_timeouts)
        : before_(before), stall_(stall), keeps_timeouts_(keeps_timeouts) {}

    SourceStatus next(Duration timeout, HandFrame& out, std::string& message) override {
        if (given_ == before_) {
            const auto now = std::chrono::steady_clock::now();
            const auto until = until_.value_or(now + stall_);
            until_ = until;
            const auto left = until - now;
            if (keeps_timeouts_ && left > timeout) {
                std::this_thread::sleep_for(timeout);
                return SourceStatus::timeout;
            }
            std::this_thread::sleep_for(left);
        }
        ++given_;
        return hand_.next(timeout, out, message);
    }

 private:
    int before_;
    Duration stall_;
    bool keeps_timeouts_;
    SwipingHand hand_{kFrames};
    int given_ = 0;
    std::optional<std::chrono::steady_clock::time_point> until_;
};

/// Plays a hand that stalls, at its own pace.
void play_stalling(bool in_steps, bool keeps_timeouts, int before, Duration stall,
                   const Session::EventCallback& callback) {
    SessionOptions options;
    options.pace = Pace::own_pace;
    auto session = Session::create(
        std::unique_ptr<HandSource>(new StallingHand(before, stall, keeps_timeouts)), options);
    ASSERT_TRUE(session);
    session->subscribe(callback);
    if (!in_steps) {
        EXPECT_TRUE(session->run());
        return;
    }
    while (true) {
        const auto status = session->step(1s);
        ASSERT_TRUE(status);
        if (*status == StepStatus::end) {
            return;
        }
    }
}

/// Calls `play` for all four ways at once, since each takes its time.
void in_all_ways(const std::function<void(bool in_steps, bool keeps_timeouts)>& play) {
    std::vector<std::jthread> ways;
    for (const bool in_steps : {false, true}) {
        for (const bool keeps_timeouts : {false, true}) {
            ways.emplace_back([=] { play(in_steps, keeps_timeouts); });
        }
    }
}

TEST(Session, ASourceThatIsSlowLosesNoHand) {
    in_all_ways([](bool in_steps, bool keeps_timeouts) {
        std::vector<EventPhase> phases;
        Stamp newest;
        // Longer than a hand may be unseen, after it was told of.
        play_stalling(in_steps, keeps_timeouts, 20, 400ms, [&](const GestureEvent& e) {
            phases.push_back(e.phase);
            newest = e.sensor;
        });
        EXPECT_EQ(phases, (std::vector<EventPhase>{EventPhase::begin, EventPhase::end}))
            << in_steps << keeps_timeouts;
        EXPECT_EQ(newest, Stamp{} + kFrame * (StallingHand::kFrames - 1));  // the stream's end
    });
}

TEST(Session, ImagesThatComeLateLoseNoHand) {
    constexpr auto kLate = 400ms;  // more than a hand may be unseen before it is gone
    constexpr int kFrames = 15;
    SwipingHand hand(kFrames);
    std::string message;
    auto session = callers_session(
        [&](HandFrame& out) {
            std::this_thread::sleep_for(30ms);  // longer than the 20 ms between looks at the clock
            const auto status = hand.next(Duration::zero(), out, message);
            const auto seen = std::chrono::steady_clock::now() - kLate;
            out.stamp =
                Stamp{std::chrono::duration_cast<Duration>(seen.time_since_epoch()).count()};
            return status;
        },
        Pace::live);
    ASSERT_TRUE(session);
    std::vector<EventPhase> phases;
    session->subscribe(GestureType::hand,
                       [&](const GestureEvent& e) { phases.push_back(e.phase); });
    ASSERT_TRUE(session->run());
    EXPECT_EQ(phases, (std::vector<EventPhase>{EventPhase::begin, EventPhase::end}));
}

TEST(Session, ASlowSourceIsNoLatency) {
    constexpr auto kStall = 300ms;
    constexpr int kBefore = 3;  // the hand is told of some frames later
    in_all_ways([&](bool in_steps, bool keeps_timeouts) {
        Duration latency{};
        play_stalling(in_steps, keeps_timeouts, kBefore, kStall, [&](const GestureEvent& e) {
            if (e.phase == EventPhase::begin) {
                latency = e.emit - e.sensor;
            }
        });
        EXPECT_GT(latency, Duration::zero());
        EXPECT_LT(latency, kStall / 2) << in_steps << keeps_timeouts;
    });
}

TEST(Session, ASlowProgramIsLatency) {
    constexpr auto kStall = 300ms;
    auto session = swiping_session(Pace::own_pace, 15);
    ASSERT_TRUE(session);
    Duration latency{};
    session->subscribe([&](const GestureEvent& e) {
        if (e.phase == EventPhase::begin) {
            latency = e.emit - e.sensor;
        }
    });
    for (int i = 0; i < 15; ++i) {
        ASSERT_TRUE(session->step(1s));
        if (i == 3) {
            std::this_thread::sleep_for(kStall);
        }
    }
    EXPECT_GT(latency, kStall / 2);
}

TEST(Session, AStepFetchesWhatIsReadySoon) {
    constexpr int kItems = 10;
    SessionOptions options;
    options.pace = Pace::own_pace;
    int items = 0;
    /// Ready 2 ms after it is asked for.
    class Soon final : public HandSource {
     public:
        SourceStatus next(Duration timeout, HandFrame& out, std::string&) override {
            std::this_thread::sleep_for(std::min<Duration>(timeout, 2ms));
            out = HandFrame{};
            out.coordinates = CoordinateFrame::interaction;
            return timeout < 2ms ? SourceStatus::timeout : SourceStatus::ok;
        }
    };
    auto session = Session::create(std::unique_ptr<HandSource>(new Soon), options);
    ASSERT_TRUE(session);
    const auto begin = std::chrono::steady_clock::now();
    while (items < kItems && std::chrono::steady_clock::now() - begin < 2s) {
        const auto status = session->step(1s);
        ASSERT_TRUE(status);
        items += *status == StepStatus::processed ? 1 : 0;
    }
    EXPECT_EQ(items, kItems);
    EXPECT_LT(std::chrono::steady_clock::now() - begin, kItems * 15ms);
}

TEST(Session, StopEndsALongStepSoon) {
    for (const Pace pace : {Pace::replay, Pace::own_pace, Pace::live}) {
        auto session = swiping_session(pace, 0, SourceStatus::timeout);
        ASSERT_TRUE(session);
        const auto begin = std::chrono::steady_clock::now();
        std::jthread stopper([&] {
            std::this_thread::sleep_for(50ms);
            session->stop();
        });
        const auto status = session->step(5s);
        ASSERT_TRUE(status);
        EXPECT_EQ(*status, StepStatus::stopped);
        EXPECT_LT(std::chrono::steady_clock::now() - begin, 2s);
    }
}

TEST(Session, ALongStepLooksAtTheClock) {
    auto session = swiping_session(Pace::live, 30, SourceStatus::timeout);
    ASSERT_TRUE(session);
    std::vector<std::chrono::steady_clock::time_point> told;
    session->subscribe(GestureType::hand, [&](const GestureEvent&) {
        told.push_back(std::chrono::steady_clock::now());
    });
    for (int i = 0; i < 30; ++i) {
        ASSERT_TRUE(session->step());
    }
    EXPECT_EQ(told.size(), 1U);
    const auto status = session->step(1s);  // a hand that is not seen for 300 ms is gone
    ASSERT_TRUE(status);
    EXPECT_EQ(*status, StepStatus::waiting);
    ASSERT_EQ(told.size(), 2U);
    EXPECT_GT(std::chrono::steady_clock::now() - told[1], 200ms);
}

TEST(Session, AStepMayWaitForEver) {
    auto session = swiping_session(Pace::own_pace, 3);
    ASSERT_TRUE(session);
    for (int i = 0; i < 3; ++i) {
        const auto status = session->step(Duration::max());
        ASSERT_TRUE(status);
        EXPECT_EQ(*status, StepStatus::processed);
    }
}

}  // namespace
}  // namespace xtrack
