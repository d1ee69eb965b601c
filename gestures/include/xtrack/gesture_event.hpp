// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include <xtrack/geometry.hpp>
#include <xtrack/hand.hpp>
#include <xtrack/stamp.hpp>

namespace xtrack {

/// What an event is about. `hand` reports hands coming and going, `engage` whose session it is; the
/// rest are gestures.
/// @since 0.1
enum class GestureType : std::uint8_t {
    hand,
    engage,
    swipe,
    push,
    pull,
    pinch,
    double_pinch,
    grab,
    tap,
    double_tap,
    circle,
    wave,
    raise,
    dwell,
    press,  ///< in the air, by a virtual force
    touch,  ///< of a plane before the screen
    drag,   ///< a pinch, grab or press that moves
    open_palm,
    fist,
    point,
    victory,
    thumb_up,
    thumb_down,
    two_hand_zoom,
    two_hand_rotate,
};
inline constexpr std::size_t kGestureTypeCount = 25;

/// Begins and ends in its deciding frame; the others have a life. @thread any
/// @since 0.1
[[nodiscard]] constexpr bool is_one_shot(GestureType t) noexcept {
    switch (t) {
        case GestureType::swipe:
        case GestureType::push:
        case GestureType::pull:
        case GestureType::double_pinch:
        case GestureType::tap:
        case GestureType::double_tap:
        case GestureType::circle:
        case GestureType::wave:
        case GestureType::raise: return true;
        case GestureType::hand:
        case GestureType::engage:
        case GestureType::pinch:
        case GestureType::grab:
        case GestureType::dwell:
        case GestureType::press:
        case GestureType::touch:
        case GestureType::drag:
        case GestureType::open_palm:
        case GestureType::fist:
        case GestureType::point:
        case GestureType::victory:
        case GestureType::thumb_up:
        case GestureType::thumb_down:
        case GestureType::two_hand_zoom:
        case GestureType::two_hand_rotate: break;
    }
    return false;
}

/// As the user sees it; turns as the user sees them, too.
/// @since 0.1
enum class Direction : std::uint8_t { none, left, right, up, down, clockwise, counterclockwise };

/// Those that events of a type can have; none for most. @ownership static @thread any
/// @since 0.1
[[nodiscard]] std::span<const Direction> directions_of(GestureType t) noexcept;

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
    timeout,     ///< it lasted longer than it may
    disengaged,  ///< the hand lost the session, or all was stopped from outside: Session::stop(),
                 ///< GestureRecogniser::abandon(), a gesture that was switched off
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
    int other_hand_id = 0;  ///< the second of a two-hand gesture; else 0
    Chirality hand = Chirality::unknown;
    float hand_confidence = 0.0F;
    Stamp onset;                        ///< when the motion began
    Stamp sensor;                       ///< the newest frame of the decision
    Stamp emit;                         ///< when the callback ran; in replay the same as `sensor`
    Vec3f position_mm = Vec3f::Zero();  ///< palm; pinch: between the fingertips. Interaction frame.
    Vec3f velocity_mmps = Vec3f::Zero();
    float progress = 0.0F;  ///< 0..1 of what the gesture needs
    /// swipe, push, pull: mean speed mm/s; tap: peak deg/s; pinch, grab: 0..1; press: force 0..1;
    /// touch: mm before the plane; wave, circle: turns; raise: mm; drag: mm from its begin; poses:
    /// score 0..1; two_hand_zoom: scale since its begin; two_hand_rotate: deg since its begin,
    /// clockwise as the user sees it.
    float value = 0.0F;
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
