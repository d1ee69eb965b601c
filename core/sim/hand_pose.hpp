// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <xtrack/geometry.hpp>
#include <xtrack/sim.hpp>

#include "core/sim/hand_model.hpp"

namespace xtrack::sim {

/// Bends of the fingers, as SimPose has them.
inline constexpr std::size_t kAnglesPerFinger = 4;
using FingerAngles = std::array<float, kAnglesPerFinger * kSimFingerCount>;

/// Where a hand is and how it is held, camera frame.
struct HandPose {
    Vec3f palm_mm = Vec3f::Zero();   ///< the OpenXR palm joint: in the middle of the hand
    Vec3f turn_rad = Vec3f::Zero();  ///< pitch, yaw, roll away from palm to camera, fingers up;
                                     ///< for a right hand: a left one turns as in a mirror
    FingerAngles fingers{};
    Vec3f shoulder_mm = Vec3f::Zero();
};

struct Affine {
    Eigen::Matrix<float, 3, 3, Eigen::DontAlign> rotation =
        Eigen::Matrix<float, 3, 3, Eigen::DontAlign>::Identity();
    Vec3f offset = Vec3f::Zero();
    [[nodiscard]] Vec3f operator*(const Vec3f& p) const { return rotation * p + offset; }
};

/// Transforms of every bone from the model's rest to the camera frame.
struct PosedBones {
    std::array<Affine, kBoneCount> bones;
    std::array<Vec3f, kSimJointCount> joints_mm{};
};

/// @param scale hand length / kModelHandLengthMm
[[nodiscard]] PosedBones pose_bones(const HandPose& pose, SimHand hand, float scale);

/// Linear-blend skinning of one vertex.
[[nodiscard]] Vec3f skin_point(const HandModel::Vertex& vertex, const PosedBones& bones);

/// All vertices, positions and normals, into arrays of the model's size.
void skin(const HandModel& model, const PosedBones& bones, std::vector<Vec3f>& positions_mm,
          std::vector<Vec3f>& normals);

[[nodiscard]] FingerAngles relaxed_open();
/// Thumb and index apart, the other fingers relaxed: a pinch before it closes.
[[nodiscard]] FingerAngles pinch_open();
/// The pads of thumb and index finger meet; solved on the model.
[[nodiscard]] FingerAngles solve_pinch_closed(const HandModel& model);
/// Pad to pad, mm.
[[nodiscard]] float aperture_mm(const HandModel& model, const PosedBones& bones);

}  // namespace xtrack::sim
