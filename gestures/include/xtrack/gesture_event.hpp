// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include <xtrack/geometry.hpp>
#include <xtrack/hand.hpp>
#include <xtrack/stamp.hpp>

namespace xtrack {

/// What an event is about. `hand` reports hands coming and going; the rest are gestures.
/// @since 0.1
enum class GestureType : std::uint8_t { hand, swipe, push, pinch, wave };
inline constexpr std::size_t kGestureTypeCount = 5;

/// As the user sees it.
/// @since 0.1
enum class Direction : std::uint8_t { none, left, right, up, down };

/// One-shot gestures give begin and end in the deciding frame; those with a life give begin,
/// update*, then end or cancel. What a gesture is never changes during its life.
/// @since 0.1
enum class EventPhase : std::uint8_t { begin, update, end, cancel };

/// Why a gesture that had begun is not to be acted on.
/// @since 0.1
enum class CancelReason : std::uint8_t {
    none,
    lost,        ///< the hand was not seen for 120 ms
    edge,        ///< the hand reached the image's border
    superseded,  ///< a stronger gesture of the same hand took over
    disengaged,  ///< stopped from outside: Session::stop(), GestureRecogniser::abandon()
};

/// Something that a hand did, or that a hand came or went. Interaction frame.
/// @since 0.1
struct GestureEvent {
    GestureType type = GestureType::hand;
    Direction direction = Direction::none;
    EventPhase phase = EventPhase::begin;
    CancelReason cancel_reason = CancelReason::none;
    int gesture_id = -1;  ///< the same from begin to end, never used again; -1 for hand events
    int hand_id = 0;
    Chirality hand = Chirality::unknown;
    float hand_confidence = 0.0F;
    Stamp onset;                        ///< when the motion began
    Stamp sensor;                       ///< the newest frame of the decision
    Stamp emit;                         ///< when the callback ran; in replay the same as `sensor`
    Vec3f position_mm = Vec3f::Zero();  ///< palm; pinch: between the fingertips. Interaction frame.
    Vec3f velocity_mmps = Vec3f::Zero();
    float progress = 0.0F;    ///< 0..1 of what the gesture needs
    float value = 0.0F;       ///< swipe, push: mean speed mm/s; pinch: 0..1; wave: turns
    float confidence = 0.0F;  ///< 0..1
    bool metric = true;       ///< false: mm are nominal (Session::metric())
};

// The words that events and labels are written with. Static storage. @thread any

/// @since 0.1
[[nodiscard]] const char* to_string(GestureType t) noexcept;
[[nodiscard]] const char* to_string(Direction d) noexcept;
[[nodiscard]] const char* to_string(EventPhase p) noexcept;
[[nodiscard]] const char* to_string(CancelReason r) noexcept;

/// The event's name as labels write it: `swipe_left`, `push`.
/// @thread any
/// @since 0.1
[[nodiscard]] std::string name_of(const GestureEvent& event);

/// One JSON object without a line break, the format that `--events jsonl` prints (docs/output.md).
/// @thread any
/// @since 0.1
[[nodiscard]] std::string to_json(const GestureEvent& event);

}  // namespace xtrack
