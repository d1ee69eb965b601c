// SPDX-License-Identifier: Apache-2.0
#include "gestures/session/event_queue.hpp"

#include <gtest/gtest.h>

namespace xtrack {
namespace {

GestureEvent event_of(int id) {
    GestureEvent e;
    e.gesture_id = id;
    return e;
}

TEST(EventQueue, GivesEventsInOrder) {
    EventQueue queue;
    queue.push(event_of(1));
    queue.push(event_of(2));
    GestureEvent e;
    ASSERT_TRUE(queue.pop(e));
    EXPECT_EQ(e.gesture_id, 1);
    ASSERT_TRUE(queue.pop(e));
    EXPECT_EQ(e.gesture_id, 2);
    EXPECT_FALSE(queue.pop(e));
    EXPECT_EQ(queue.dropped(), 0U);
}

TEST(EventQueue, KeepsTheNewestWhenFull) {
    EventQueue queue;
    GestureEvent e;
    EXPECT_FALSE(queue.pop(e));  // there is a reader
    const int pushed = static_cast<int>(EventQueue::kCapacity) + 10;
    for (int i = 0; i < pushed; ++i) {
        queue.push(event_of(i));
    }
    EXPECT_EQ(queue.dropped(), 10U);
    ASSERT_TRUE(queue.pop(e));
    EXPECT_EQ(e.gesture_id, 10);
    int last = e.gesture_id;
    while (queue.pop(e)) {
        EXPECT_EQ(e.gesture_id, last + 1);
        last = e.gesture_id;
    }
    EXPECT_EQ(last, pushed - 1);
}

TEST(EventQueue, ThatNobodyReadsLosesNothing) {
    EventQueue queue;
    for (int i = 0; i < static_cast<int>(EventQueue::kCapacity) + 10; ++i) {
        queue.push(event_of(i));
    }
    EXPECT_EQ(queue.dropped(), 0U);
    GestureEvent e;
    ASSERT_TRUE(queue.pop(e));
    EXPECT_EQ(e.gesture_id, 10);
}

}  // namespace
}  // namespace xtrack
