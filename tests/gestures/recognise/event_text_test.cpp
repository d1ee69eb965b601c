// SPDX-License-Identifier: Apache-2.0
#include <xtrack/gesture_event.hpp>

#include <clocale>
#include <limits>

#include <gtest/gtest.h>

namespace xtrack::test {
namespace {

GestureEvent swipe() {
    GestureEvent e;
    e.type = GestureType::swipe;
    e.direction = Direction::left;
    e.phase = EventPhase::end;
    e.gesture_id = 7;
    e.hand_id = 3;
    e.hand = Chirality::right;
    e.hand_confidence = 0.9F;
    e.onset = Stamp::from_us(1'000'000);
    e.sensor = Stamp::from_us(1'233'333);
    e.emit = Stamp::from_us(1'234'000);
    e.position_mm = Vec3f{-12.34F, 56.0F, 400.06F};
    e.velocity_mmps = Vec3f{-512.0F, -0.01F, 3.25F};
    e.progress = 1.0F;
    e.value = 512.5F;
    e.confidence = 0.93F;
    return e;
}

constexpr const char* kSwipe =
    R"({"type":"swipe","direction":"left","phase":"end","gesture_id":7,"hand_id":3,)"
    R"("hand":"right","hand_confidence":0.900,"t_onset_us":1000000,"t_sensor_us":1233333,)"
    R"("t_emit_us":1234000,"position_mm":[-12.3,56.0,400.1],"velocity_mmps":[-512.0,0.0,3.2],)"
    R"("progress":1.000,"value":512.500,"confidence":0.930,"cancel_reason":null,"metric":true})";

TEST(EventText, IsTheDocumentedObject) { EXPECT_EQ(to_json(swipe()), kSwipe); }

TEST(EventText, WhatIsNotKnownIsNull) {
    GestureEvent e;  // a hand that comes
    e.hand_id = 1;
    const std::string json = to_json(e);
    EXPECT_NE(json.find(R"("type":"hand","direction":null,"phase":"begin","gesture_id":null)"),
              std::string::npos);
    EXPECT_NE(json.find(R"("hand":"unknown")"), std::string::npos);
    e.value = std::numeric_limits<float>::quiet_NaN();
    EXPECT_NE(to_json(e).find(R"("value":null)"), std::string::npos);
}

TEST(EventText, ACancelHasItsReason) {
    GestureEvent e = swipe();
    e.phase = EventPhase::cancel;
    for (const auto& [reason, text] : {std::pair{CancelReason::lost, "lost"},
                                       {CancelReason::edge, "edge"},
                                       {CancelReason::superseded, "superseded"},
                                       {CancelReason::disengaged, "disengaged"}}) {
        e.cancel_reason = reason;
        EXPECT_NE(to_json(e).find(std::string{R"("cancel_reason":")"} + text + "\""),
                  std::string::npos);
    }
}

TEST(EventText, NamesAreThoseOfLabels) {
    GestureEvent e = swipe();
    EXPECT_EQ(name_of(e), "swipe_left");
    e.direction = Direction::down;
    EXPECT_EQ(name_of(e), "swipe_down");
    e.type = GestureType::push;
    e.direction = Direction::none;
    EXPECT_EQ(name_of(e), "push");
}

TEST(EventText, IgnoresTheLocale) {
    const char* const german =
        std::setlocale(LC_ALL, "de_DE.UTF-8");  // NOLINT(concurrency-mt-unsafe): one thread
    EXPECT_EQ(to_json(swipe()), kSwipe);
    std::setlocale(LC_ALL, "C");  // NOLINT(concurrency-mt-unsafe): one thread
    if (german == nullptr) {
        GTEST_SKIP() << "the locale de_DE.UTF-8 is not installed";
    }
}

}  // namespace
}  // namespace xtrack::test
