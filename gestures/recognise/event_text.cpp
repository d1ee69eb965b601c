// SPDX-License-Identifier: Apache-2.0
#include <xtrack/gesture_event.hpp>

#include <array>
#include <charconv>
#include <cmath>

#include "core/base/text.hpp"

namespace xtrack {

namespace {

constexpr int kLengthDigits = 1;  // 0.1 mm and 0.1 mm/s: below anything that is measured
constexpr int kShareDigits = 3;

void append(std::string& out, std::int64_t value) {
    std::array<char, 24> buffer{};
    const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
    out.append(buffer.data(), end.ptr);
}

/// JSON has no infinities.
void append(std::string& out, float value, int digits) {
    if (std::isfinite(value)) {
        base::append_fixed(out, value, digits);
    } else {
        out += "null";
    }
}

void append(std::string& out, const Vec3f& v) {
    out += '[';
    for (Eigen::Index i = 0; i < 3; ++i) {
        out += i == 0 ? "" : ",";
        append(out, v[i], kLengthDigits);
    }
    out += ']';
}

void append_quoted_or_null(std::string& out, bool known, const char* text) {
    if (!known) {
        out += "null";
        return;
    }
    out += '"';
    out += text;
    out += '"';
}

}  // namespace

const char* to_string(GestureType t) noexcept {
    switch (t) {
        case GestureType::hand: return "hand";
        case GestureType::engage: return "engage";
        case GestureType::swipe: return "swipe";
        case GestureType::push: return "push";
        case GestureType::pull: return "pull";
        case GestureType::pinch: return "pinch";
        case GestureType::double_pinch: return "double_pinch";
        case GestureType::grab: return "grab";
        case GestureType::tap: return "tap";
        case GestureType::double_tap: return "double_tap";
        case GestureType::circle: return "circle";
        case GestureType::wave: return "wave";
        case GestureType::raise: return "raise";
        case GestureType::dwell: return "dwell";
        case GestureType::press: return "press";
        case GestureType::touch: return "touch";
        case GestureType::drag: return "drag";
        case GestureType::open_palm: return "open_palm";
        case GestureType::fist: return "fist";
        case GestureType::point: return "point";
        case GestureType::victory: return "victory";
        case GestureType::thumb_up: return "thumb_up";
        case GestureType::thumb_down: return "thumb_down";
        case GestureType::two_hand_zoom: return "two_hand_zoom";
        case GestureType::two_hand_rotate: return "two_hand_rotate";
    }
    return "unknown";
}

const char* to_string(Direction d) noexcept {
    switch (d) {
        case Direction::none: return "none";
        case Direction::left: return "left";
        case Direction::right: return "right";
        case Direction::up: return "up";
        case Direction::down: return "down";
        case Direction::clockwise: return "clockwise";
        case Direction::counterclockwise: return "counterclockwise";
    }
    return "unknown";
}

const char* to_string(EventPhase p) noexcept {
    switch (p) {
        case EventPhase::begin: return "begin";
        case EventPhase::update: return "update";
        case EventPhase::end: return "end";
        case EventPhase::cancel: return "cancel";
    }
    return "unknown";
}

const char* to_string(CancelReason r) noexcept {
    switch (r) {
        case CancelReason::none: return "none";
        case CancelReason::lost: return "lost";
        case CancelReason::edge: return "edge";
        case CancelReason::superseded: return "superseded";
        case CancelReason::timeout: return "timeout";
        case CancelReason::disengaged: return "disengaged";
    }
    return "unknown";
}

std::span<const Direction> directions_of(GestureType t) noexcept {
    static constexpr std::array kSwipes{Direction::left, Direction::right, Direction::up,
                                        Direction::down};
    static constexpr std::array kTurns{Direction::clockwise, Direction::counterclockwise};
    if (t == GestureType::swipe) {
        return kSwipes;
    }
    return t == GestureType::circle ? std::span<const Direction>{kTurns}
                                    : std::span<const Direction>{};
}

std::string name_of(const GestureEvent& event) {
    std::string name = to_string(event.type);
    if (event.direction != Direction::none) {
        name += '_';
        name += to_string(event.direction);
    }
    return name;
}

std::string to_json(const GestureEvent& e) {
    std::string out;
    out.reserve(512);
    out += R"({"type":")";
    out += to_string(e.type);
    out += R"(","direction":)";
    append_quoted_or_null(out, e.direction != Direction::none, to_string(e.direction));
    out += R"(,"phase":")";
    out += to_string(e.phase);
    out += R"(","gesture_id":)";
    if (e.gesture_id > 0) {
        append(out, std::int64_t{e.gesture_id});
    } else {
        out += "null";
    }
    out += R"(,"hand_id":)";
    append(out, std::int64_t{e.hand_id});
    if (e.other_hand_id != 0) {
        out += R"(,"other_hand_id":)";
        append(out, std::int64_t{e.other_hand_id});
    }
    out += R"(,"hand":")";
    out += to_string(e.hand);
    out += R"(","hand_confidence":)";
    append(out, e.hand_confidence, kShareDigits);
    out += R"(,"t_onset_us":)";
    append(out, e.onset.us());
    out += R"(,"t_sensor_us":)";
    append(out, e.sensor.us());
    out += R"(,"t_emit_us":)";
    append(out, e.emit.us());
    out += R"(,"position_mm":)";
    append(out, e.position_mm);
    out += R"(,"velocity_mmps":)";
    append(out, e.velocity_mmps);
    out += R"(,"progress":)";
    append(out, e.progress, kShareDigits);
    out += R"(,"value":)";
    append(out, e.value, kShareDigits);
    out += R"(,"confidence":)";
    append(out, e.confidence, kShareDigits);
    out += R"(,"cancel_reason":)";
    append_quoted_or_null(out, e.cancel_reason != CancelReason::none, to_string(e.cancel_reason));
    out += e.metric ? R"(,"metric":true)" : R"(,"metric":false)";
    out += '}';
    return out;
}

}  // namespace xtrack
