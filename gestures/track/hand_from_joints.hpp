// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <xtrack/hand.hpp>

namespace xtrack {

/// Fills what a joint tracker does not say: palm, its normal and velocity, fingertips, extension,
/// pinch and grab. Needs the joints, id, chirality and confidence of each hand to be set; joints
/// that are not valid or not finite are tolerated, and what depends on them stays unknown.
/// Stateful, because the velocity is a line fit over the last 100 ms of each hand.
/// @thread one thread at a time
/// @since 0.1
class HandFromJoints {
 public:
    /// @param frame any coordinates, mm; stamps must not decrease. A repeated stamp keeps the
    ///        velocity of the one before.
    void complete(HandFrame& frame) noexcept;

    /// Forgets all motion.
    void reset() noexcept;

 private:
    static constexpr std::size_t kSamples = 32;  // 100 ms at up to 320 fps
    struct Motion {
        bool used = false;
        int id = 0;
        std::size_t newest = 0;
        std::size_t count = 0;
        Vec3f velocity_mmps = Vec3f::Zero();
        std::array<Stamp, kSamples> stamp{};
        std::array<Vec3f, kSamples> palm_mm{};
    };

    Motion& motion_of(int id, Stamp now) noexcept;
    static void add(Motion& motion, Stamp now, const Vec3f& palm_mm) noexcept;

    std::array<Motion, kMaxHands> motions_{};
};

/// The part that needs no history: everything but the velocity. @return whether a palm is known
bool complete_from_joints(Hand& hand) noexcept;

/// Unit vector out of the palm (the side that a fist closes over), zero where the knuckles are not
/// known. Needs the index and little proximal joints, and the wrist or the palm. For a hand of
/// unknown chirality the sign is a guess.
Vec3f palm_facing(const Hand& hand) noexcept;

/// Less than any finger bends.
inline constexpr float kFlexionUnknown = -360.0F;

/// How far a finger (not the thumb) bends, degrees: in all its three joints together, and without
/// the outermost, which trackers guess. 0 in line with the palm, 170 to 240 (150 to 190) in a fist,
/// negative bent back; for a hand of unknown chirality the knuckle's part is never negative.
/// kFlexionUnknown where joints are missing.
struct Flexion {
    float whole_deg = kFlexionUnknown;
    float inner_deg = kFlexionUnknown;
};
Flexion flexion_of(const Hand& hand, Finger finger) noexcept;

/// Wrist to middle fingertip of the straight hand, mm, from the middle finger's bones; 0 = unknown.
float hand_length_mm(const Hand& hand) noexcept;
/// The widest circle in a palm that faces the camera, as a share of that length; measured.
inline constexpr float kPalmRadiusOfLength = 0.23F;

}  // namespace xtrack
