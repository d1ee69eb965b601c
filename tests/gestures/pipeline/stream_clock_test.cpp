// SPDX-License-Identifier: Apache-2.0
#include "gestures/pipeline/stream_clock.hpp"

#include <gtest/gtest.h>

namespace xtrack {
namespace {

TEST(StreamClock, ReplayHasNoTimeButTheStream) {
    StreamClock clock(Pace::replay);
    clock.begin(Stamp::from_us(5));
    EXPECT_EQ(clock.now(Stamp::from_us(77), {}), Stamp::from_us(77));
    EXPECT_LE(clock.due(Stamp::from_us(1'000'000'000)), StreamClock::Wall::now());
}

TEST(StreamClock, OwnPaceCountsFromTheFirstStamp) {
    StreamClock clock(Pace::own_pace);
    const Stamp first = Stamp::from_us(9'000'000);
    const auto before = StreamClock::Wall::now();
    clock.begin(first);
    clock.begin(Stamp::from_us(1));  // only the first counts
    const auto after = StreamClock::Wall::now();
    const auto due = clock.due(first + std::chrono::milliseconds(250));
    EXPECT_GE(due, before + std::chrono::milliseconds(250));
    EXPECT_LE(due, after + std::chrono::milliseconds(250));
    EXPECT_GE(clock.now(first, before), first);
    EXPECT_LT(clock.now(first, before), first + std::chrono::seconds(10));
}

TEST(StreamClock, OwnPaceWaitsUntilACameraWouldHaveDelivered) {
    StreamClock clock(Pace::own_pace, std::chrono::seconds(20));
    clock.begin({});
    const auto after = StreamClock::Wall::now();
    EXPECT_GT(clock.due({}), after);
    EXPECT_LE(clock.due({}), after + std::chrono::seconds(20));
}

TEST(StreamClock, StandsStillForASourceThatIsSlow) {
    using std::chrono::milliseconds;
    StreamClock clock(Pace::own_pace);
    clock.begin({});
    const Stamp stamp = Stamp{} + milliseconds(20);
    const auto due = clock.due(stamp);
    clock.note_read(stamp, milliseconds(10), due - milliseconds(5));  // in time
    EXPECT_EQ(clock.due(stamp), due);
    clock.note_read(stamp, milliseconds(22), due + milliseconds(7));  // made for too long
    EXPECT_EQ(clock.due(stamp), due + milliseconds(7));
    // Asked for too late; that it took 2 ms to make is all the source can be blamed for.
    clock.note_read(stamp, milliseconds(2), due + milliseconds(102));
    EXPECT_EQ(clock.due(stamp), due + milliseconds(9));
    StreamClock live(Pace::live);
    live.begin({});
    live.note_read({}, milliseconds(7), due + milliseconds(7));
    EXPECT_EQ(live.due({}), StreamClock::Wall::time_point::min());
}

TEST(StreamClock, LiveIsTheMonotonicClock) {
    const StreamClock clock(Pace::live);
    const auto wall = StreamClock::Wall::now().time_since_epoch();
    const Stamp now = clock.now({}, {});
    EXPECT_GE(now.ns, std::chrono::duration_cast<Duration>(wall).count());
    EXPECT_LT(now.ns, std::chrono::duration_cast<Duration>(wall).count() + 1'000'000'000);
}

}  // namespace
}  // namespace xtrack
