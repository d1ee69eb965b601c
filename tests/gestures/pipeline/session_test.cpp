// SPDX-License-Identifier: Apache-2.0
#include <xtrack/session.hpp>

#include <gtest/gtest.h>
#ifdef __linux__
#include <sys/resource.h>
#include <unistd.h>
#endif

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <memory>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <xtrack/null_source.hpp>

namespace xtrack {
namespace {

using namespace std::chrono_literals;

constexpr Duration kFrame = std::chrono::microseconds(16667);
constexpr float kSwipeSpeed_mmps = 800.0F;
constexpr double kRest_s = 0.6;
constexpr double kStroke_s = 0.35;

/// A right hand held up, flat side to the left, that rests, strokes to the left and rests again.
class SwipingHand final : public HandSource {
 public:
    explicit SwipingHand(int frames, SourceStatus after = SourceStatus::end,
                         Duration spacing = kFrame)
        : frames_(frames), after_(after), spacing_(spacing) {}

    SourceStatus next(Duration timeout, HandFrame& out, std::string& message) override {
        if (next_ == frames_) {
            message = "the hand is gone";
            if (after_ == SourceStatus::timeout) {
                std::this_thread::sleep_for(timeout);
            }
            return after_;
        }
        const double t = to_seconds(kFrame) * next_;
        const double moved = std::clamp(t - kRest_s, 0.0, kStroke_s);
        out = HandFrame{};
        out.stamp = Stamp{} + spacing_ * next_++;
        out.coordinates = CoordinateFrame::interaction;
        out.count = 1;
        Hand& hand = out.hands[0];
        hand.id = 1;
        hand.chirality = Chirality::right;
        hand.chirality_confidence = 1.0F;
        hand.confidence = 1.0F;
        const Vec3f palm(150.0F - kSwipeSpeed_mmps * static_cast<float>(moved), 0.0F, 500.0F);
        const auto put = [&](Joint j, float x, float y, float z) {
            hand.joint(j) = {palm + Vec3f(x, y, z), true};
        };
        put(Joint::palm, 0, 0, 0);
        put(Joint::wrist, 0, -90, 0);
        const Joint firsts[4] = {Joint::index_proximal, Joint::middle_proximal,
                                 Joint::ring_proximal, Joint::little_proximal};
        for (int f = 0; f < 4; ++f) {
            for (int k = 0; k < 4; ++k) {
                const auto joint = static_cast<Joint>(static_cast<int>(firsts[f]) + k);
                put(joint, 0.0F, 20.0F + 28.0F * static_cast<float>(k),
                    -30.0F + 20.0F * static_cast<float>(f));
            }
        }
        put(Joint::thumb_proximal, 0, 0, -40);
        put(Joint::thumb_distal, 0, 20, -60);
        put(Joint::thumb_tip, 0, 40, -75);
        return SourceStatus::ok;
    }

 private:
    int frames_;
    SourceStatus after_;
    Duration spacing_;
    int next_ = 0;
};

Result<Session> swiping_session(Pace pace = Pace::replay, int frames = 100,
                                SourceStatus after = SourceStatus::end) {
    SessionOptions options;
    options.pace = pace;
    return Session::create(std::unique_ptr<HandSource>(new SwipingHand(frames, after)), options);
}

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

TEST(Session, ACallbackThatThrowsEndsItWithAnError) {
    for (const Pace pace : {Pace::replay, Pace::own_pace}) {
        auto session = swiping_session(pace);
        ASSERT_TRUE(session);
        session->subscribe_hands([](const HandFrame&) { throw std::runtime_error("no more"); });
        const auto result = session->run();
        ASSERT_FALSE(result);
        EXPECT_NE(result.error().message.find("no more"), std::string::npos);
    }
}

TEST(Session, ACallbackThatFindsNoMemoryIsTheOneToBlame) {
    auto session = swiping_session();
    ASSERT_TRUE(session);
    session->subscribe_hands([](const HandFrame&) { throw std::bad_alloc(); });
    const auto result = session->run();
    ASSERT_FALSE(result);
    EXPECT_TRUE(result.error().message.starts_with("a callback threw: ")) << result.error().message;
}

TEST(Session, ASourceThatFailsEndsItWithTheSourcesWords) {
    auto session = swiping_session(Pace::replay, 5, SourceStatus::failed);
    ASSERT_TRUE(session);
    const auto result = session->run();
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().message, "the hand is gone");
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

TEST(Session, StaysFailed) {
    for (const Pace pace : {Pace::replay, Pace::own_pace}) {
        auto session = swiping_session(pace, 3);
        ASSERT_TRUE(session);
        int calls = 0;
        session->subscribe_hands([&](const HandFrame&) {
            ++calls;
            throw std::runtime_error("no more");
        });
        const auto first = session->run();
        ASSERT_FALSE(first);
        const auto again = session->run();
        ASSERT_FALSE(again);
        EXPECT_EQ(again.error().message, first.error().message);
        const auto step = session->step();
        ASSERT_FALSE(step);
        EXPECT_EQ(step.error().message, first.error().message);
        ASSERT_TRUE(session->start());
        EXPECT_FALSE(session->wait());
        EXPECT_EQ(calls, 1);
    }
}

/// A tracker of the caller's whose next() does what the test says.
class CallersSource final : public HandSource {
 public:
    using Next = std::function<SourceStatus(HandFrame&)>;
    explicit CallersSource(Next next) : next_(std::move(next)) {}
    SourceStatus next(Duration /*timeout*/, HandFrame& out, std::string& /*message*/) override {
        return next_(out);
    }

 private:
    Next next_;
};

Result<Session> callers_session(CallersSource::Next next, Pace pace) {
    SessionOptions options;
    options.pace = pace;
    return Session::create(std::unique_ptr<HandSource>(new CallersSource(std::move(next))),
                           options);
}

TEST(Session, ASourceThatThrowsHasFailed) {
    for (const Pace pace : {Pace::replay, Pace::own_pace}) {
        auto session = callers_session(
            [](HandFrame&) -> SourceStatus { throw std::runtime_error("out of light"); }, pace);
        ASSERT_TRUE(session);
        const auto result = session->run();
        ASSERT_FALSE(result);
        EXPECT_EQ(result.error().message, "the source threw: out of light");
    }
}

TEST(Session, HandsThatBreakTheirPromiseAreRefused) {
    HandFrame camera;
    auto session = callers_session(
        [&](HandFrame& out) {
            out = camera;
            return SourceStatus::ok;
        },
        Pace::replay);
    ASSERT_TRUE(session);
    const auto in_camera_frame = session->run();
    ASSERT_FALSE(in_camera_frame);
    EXPECT_NE(in_camera_frame.error().message.find("to_interaction()"), std::string::npos);

    session = callers_session(
        [](HandFrame& out) {
            out.coordinates = CoordinateFrame::interaction;
            out.count = kMaxHands + 1;
            return SourceStatus::ok;
        },
        Pace::replay);
    ASSERT_TRUE(session);
    const auto too_many = session->run();
    ASSERT_FALSE(too_many);
    EXPECT_NE(too_many.error().message.find("at most 2"), std::string::npos);
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

TEST(Session, AWaitInACallbackIsRefused) {
    auto session = swiping_session(Pace::replay, 3);
    ASSERT_TRUE(session);
    std::string message;
    session->subscribe_hands([&](const HandFrame&) {
        const auto waited = session->wait();
        message = waited ? "no error" : waited.error().message;
    });
    ASSERT_TRUE(session->start());
    ASSERT_TRUE(session->wait());
    EXPECT_NE(message.find("callback cannot wait()"), std::string::npos) << message;
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

TEST(Session, RefusesARigOfDepthThatIsNotValid) {
    Rig rig;
    rig.camera.matrix << 580.0, 0.0, 320.0, 0.0, 580.0, 240.0, 0.0, 0.0, 1.0;
    rig.camera.size = {640, 480};
    EXPECT_TRUE(Session::create(null_depth_source(rig), {}));
    rig.interaction_from_camera = Mat4d::Zero();
    const auto session = Session::create(null_depth_source(rig), {});
    ASSERT_FALSE(session);
    EXPECT_NE(session.error().message.find("interaction_from_camera"), std::string::npos);
}

/// Depth of a caller's whose rig() does what the test says.
class BrokenDepth final : public DepthSource {
 public:
    explicit BrokenDepth(std::function<void()> act) : act_(std::move(act)) {}
    [[nodiscard]] const Rig& rig() const override {
        act_();
        return rig_;
    }
    SourceStatus next(Duration, DepthFrame&, std::string&) override { return SourceStatus::end; }

 private:
    std::function<void()> act_;
    Rig rig_;
};

TEST(Session, NothingThatIsThrownLeavesCreate) {
    const auto error_of = [](std::function<void()> act) {
        const auto session =
            Session::create(std::unique_ptr<DepthSource>(new BrokenDepth(std::move(act))), {});
        return session ? "" : session.error().message;
    };
    EXPECT_EQ(error_of([] { throw std::runtime_error("not plugged in"); }),
              "Session::create: the source threw: not plugged in");
    EXPECT_NE(error_of([] { throw std::bad_alloc(); }).find("not enough memory"),
              std::string::npos);
}

#if defined(__linux__) && !defined(XTRACK_SANITIZED)
/// From now on the process gets a megabyte more and that is all. For a process of its own, whose
/// heap holds nothing that was given back.
void take_memory_away() {
    rlim_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    rlimit tight{};
    getrlimit(RLIMIT_AS, &tight);
    tight.rlim_cur = pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE)) + (rlim_t{1} << 20U);
    setrlimit(RLIMIT_AS, &tight);
}

/// Says how it went.
template <typename T>
[[noreturn]] void leave_with(const Result<T>& result) {
    std::fputs(result ? "there was enough" : result.error().message.c_str(), stderr);
    std::exit(result ? 1 : 0);
}

TEST(SessionDeathTest, OpenSaysThatThereIsNoMemory) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    const auto open = [] {
        take_memory_away();
        leave_with(Session::open("sim"));
    };
    EXPECT_EXIT(open(), testing::ExitedWithCode(0), "^[A-Za-z:]+: not enough");
}

TEST(SessionDeathTest, RunAndStartSayThatThereIsNoThread) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    const auto play = [](auto how) {
        auto session = swiping_session(Pace::live, 3);
        take_memory_away();  // a thread's stack has more
        leave_with(((*session).*how)());
    };
    EXPECT_EXIT(play(&Session::run), testing::ExitedWithCode(0), "^the system gives no thread");
    EXPECT_EXIT(play(&Session::start), testing::ExitedWithCode(0), "^the system gives no thread");
}
#endif

TEST(Session, RefusesNoSourceAndWrongSettings) {
    EXPECT_FALSE(Session::create(std::unique_ptr<HandSource>(), {}));
    SessionOptions options;
    options.gestures.swipe_speed_mmps = -1.0;
    const auto session = Session::create(std::unique_ptr<HandSource>(new SwipingHand(1)), options);
    ASSERT_FALSE(session);
    EXPECT_NE(session.error().message.find("swipe_speed_mmps"), std::string::npos);
}

}  // namespace
}  // namespace xtrack
