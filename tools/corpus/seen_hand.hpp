// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include <xtrack/geometry.hpp>
#include <xtrack/hand.hpp>
#include <xtrack/rig.hpp>
#include <xtrack/sim.hpp>

#include "core/sim/hand_pose.hpp"

namespace xtrack::tools::corpus {

/// What a camera without noise would say of one hand: geometry alone, in the words of Hand. Camera
/// frame, mm.
struct SeenHand {
    bool in_view = false;         ///< its palm is in the image
    bool touches_border = false;  ///< some of it is not
    Vec3f palm_mm = Vec3f::Zero();
    float palm_radius_mm = 0.0F;
    Vec3f palm_normal = Vec3f::Zero();
    Vec3f forearm = Vec3f::Zero();  ///< unit, toward the elbow
    std::array<Vec3f, kFingerCount> tips_mm{};
    std::array<bool, kFingerCount> tip_seen{};     ///< stands out of the outline, by itself
    std::array<float, kFingerCount> tip_gap_mm{};  ///< in the image, to the nearest other tip
    std::array<float, kFingerCount> extension{};   ///< by how far a tip stands from the palm
    float aperture_mm = 0.0F;
    float grab = 0.0F;  ///< by how much of the fingers is in sight
    std::array<Vec3f, kJointCount> joints_mm{};
};

/// @param pose camera frame
/// @param scale hand length / sim::kModelHandLengthMm
/// @param camera that the hand is seen with
[[nodiscard]] SeenHand look_at(const sim::HandPose& pose, SimHand hand, float scale,
                               const Pinhole& camera);

}  // namespace xtrack::tools::corpus
