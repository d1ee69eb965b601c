// SPDX-License-Identifier: Apache-2.0
//
// What a session says of callbacks, sources and systems that fail.
#include <xtrack/session.hpp>

#include <gtest/gtest.h>
#ifdef __linux__
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>
#endif

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <utility>

#include <xtrack/null_source.hpp>

#include "tests/gestures/pipeline/session_sources.hpp"

namespace xtrack {
namespace {

using test::callers_session;
using test::swiping_session;
using test::SwipingHand;

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
    EXPECT_NE(too_many.error().message.find("at most " + std::to_string(kMaxHands)),
              std::string::npos);
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

TEST(Session, RefusesARigOfDepthThatIsNotValid) {
    // On the heap: GCC 12 for arm64 believes that empty optionals of a local are copied.
    const auto rig = std::make_unique<Rig>();
    rig->camera.matrix << 580.0, 0.0, 320.0, 0.0, 580.0, 240.0, 0.0, 0.0, 1.0;
    rig->camera.size = {640, 480};
    EXPECT_TRUE(Session::create(null_depth_source(*rig), {}));
    rig->interaction_from_camera = Mat4d::Zero();
    const auto session = Session::create(null_depth_source(*rig), {});
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

/// Emulators of another processor do not keep the limit.
bool can_take_memory_away() {
    rlimit before{};
    getrlimit(RLIMIT_AS, &before);
    take_memory_away();
    constexpr std::size_t kMuch = std::size_t{64} << 20U;
    void* const much = mmap(nullptr, kMuch, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    setrlimit(RLIMIT_AS, &before);
    return much == MAP_FAILED || munmap(much, kMuch) != 0;
}

#define SKIP_WHERE_MEMORY_HAS_NO_LIMIT()                   \
    if (!can_take_memory_away()) {                         \
        GTEST_SKIP() << "no limit of memory is kept here"; \
    }

/// Says how it went.
template <typename T>
[[noreturn]] void leave_with(const Result<T>& result) {
    std::fputs(result ? "there was enough" : result.error().message.c_str(), stderr);
    std::exit(result ? 1 : 0);  // NOLINT(concurrency-mt-unsafe): one thread
}

TEST(SessionDeathTest, OpenSaysThatThereIsNoMemory) {
    SKIP_WHERE_MEMORY_HAS_NO_LIMIT();
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    const auto open = [] {
        take_memory_away();
        leave_with(Session::open("sim"));
    };
    EXPECT_EXIT(open(), testing::ExitedWithCode(0), "^[A-Za-z:]+: not enough");
}

TEST(SessionDeathTest, RunAndStartSayThatThereIsNoThread) {
    SKIP_WHERE_MEMORY_HAS_NO_LIMIT();
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
