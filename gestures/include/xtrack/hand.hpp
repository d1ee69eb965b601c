// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <xtrack/geometry.hpp>
#include <xtrack/stamp.hpp>

namespace xtrack {

/// The 26 joints of OpenXR's XR_EXT_hand_tracking, in its order.
/// @since 0.1
enum class Joint : std::uint8_t {
    palm,
    wrist,
    thumb_metacarpal,
    thumb_proximal,
    thumb_distal,
    thumb_tip,
    index_metacarpal,
    index_proximal,
    index_intermediate,
    index_distal,
    index_tip,
    middle_metacarpal,
    middle_proximal,
    middle_intermediate,
    middle_distal,
    middle_tip,
    ring_metacarpal,
    ring_proximal,
    ring_intermediate,
    ring_distal,
    ring_tip,
    little_metacarpal,
    little_proximal,
    little_intermediate,
    little_distal,
    little_tip,
};
inline constexpr std::size_t kJointCount = 26;

/// In the order of every array of fingers.
/// @since 0.1
enum class Finger : std::uint8_t { thumb, index, middle, ring, little };
inline constexpr std::size_t kFingerCount = 5;

/// Which hand of the user it is.
/// @since 0.1
enum class Chirality : std::uint8_t { unknown, left, right };

/// A position that may not be known.
/// @since 0.1
struct TrackedPoint {
    Vec3f position_mm = Vec3f::Zero();
    bool valid = false;
};

/// One hand at one moment. Positions are mm in the frame that the HandFrame names.
/// @since 0.1
struct Hand {
    int id = 0;  ///< the same while the hand is tracked, and if it is back within 300 ms and 100 mm
    Chirality chirality = Chirality::unknown;
    float chirality_confidence = 0.0F;  ///< 0..1
    float confidence = 0.0F;            ///< 0..1; below 0.6 the hand is not to be trusted
    bool touches_border = false;        ///< the hand beyond its wrist is cut by the image's border

    Vec3f palm_mm = Vec3f::Zero();      ///< centre of the largest inscribed circle, at the skin
    float palm_radius_mm = 0.0F;        ///< of that circle; 0 = unknown
    Vec3f palm_normal = Vec3f::Zero();  ///< unit, out of the palm's seen side; 0 = unknown
    Vec3f palm_velocity_mmps = Vec3f::Zero();
    Vec3f forearm = Vec3f::Zero();  ///< unit, from the palm toward the elbow; 0 = unknown
    /// The palm through a 1-euro filter: calm at rest, little lag in motion, and of a moving hand
    /// where it is by now rather than in the depth image (SessionOptions::pointer_ahead). For
    /// cursors; set by the Session, in the interaction frame alone.
    Vec3f pointer_mm = Vec3f::Zero();

    /// Distal extremes, thumb to little. Which finger is which is a guess where a finger hides.
    std::array<TrackedPoint, kFingerCount> fingertips{};
    /// 0 folded .. 1 straight; meaningful where known, else -1.
    std::array<float, kFingerCount> finger_extension{-1.0F, -1.0F, -1.0F, -1.0F, -1.0F};
    int extended_fingers = -1;  ///< how many fingers stand out; -1 = unknown

    float pinch_aperture_mm = -1.0F;  ///< pad of the thumb to pad of the index, 3-D; -1 = unknown
    float pinch_value = 0.0F;         ///< 0 open (60 mm) .. 1 closed (15 mm); 0 when not known
    float grab_value = 0.0F;          ///< 0 open .. 1 fist

    /// Valid where they are known. Joints lie inside the hand; fingertips and palm_mm at its skin.
    std::array<TrackedPoint, kJointCount> joints{};
    /// A tracker of joints has measured each joint by itself. False: they follow from what depth
    /// shows and from the proportions of hands; a finger's are valid only where it is straight.
    bool articulated = false;

    [[nodiscard]] const TrackedPoint& joint(Joint j) const noexcept {
        return joints[static_cast<std::size_t>(j)];
    }
    [[nodiscard]] TrackedPoint& joint(Joint j) noexcept {
        return joints[static_cast<std::size_t>(j)];
    }
    [[nodiscard]] const TrackedPoint& fingertip(Finger f) const noexcept {
        return fingertips[static_cast<std::size_t>(f)];
    }
    [[nodiscard]] TrackedPoint& fingertip(Finger f) noexcept {
        return fingertips[static_cast<std::size_t>(f)];
    }
};

/// Hands that are followed at once.
inline constexpr std::size_t kMaxHands = 4;

/// All hands of one moment; none is a frame without a hand.
/// @since 0.1
struct HandFrame {
    Stamp stamp;
    Duration span = Duration::zero();  ///< of the depth frame that they were seen in; 0 = not known
    CoordinateFrame coordinates = CoordinateFrame::camera;
    /// False: seen without a calibration; lengths are in units of which a palm's width has 80.
    bool metric = true;
    std::array<Hand, kMaxHands> hands{};
    std::size_t count = 0;

    [[nodiscard]] std::span<const Hand> all() const noexcept { return {hands.data(), count}; }
    [[nodiscard]] std::span<Hand> all() noexcept { return {hands.data(), count}; }
};

/// The same hands in the user's coordinates. A reflection in `interaction_from_camera` means a
/// mirrored image: left and right hands swap here, and nowhere else.
/// @param interaction_from_camera 4x4 rigid (or reflected) transform, mm
/// @thread any
/// @since 0.1
[[nodiscard]] HandFrame to_interaction(const HandFrame& camera,
                                       const Mat4d& interaction_from_camera);

// As labels and recordings write them. Static storage. @thread any

/// @since 0.1
[[nodiscard]] const char* to_string(Chirality c) noexcept;
[[nodiscard]] const char* to_string(Joint j) noexcept;

}  // namespace xtrack
