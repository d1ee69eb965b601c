// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <xtrack/geometry.hpp>
#include <xtrack/sim.hpp>

#include "core/sim/mesh.hpp"

namespace xtrack::sim {

/// Bones that carry skin. Each finger has three, thumb first: the thumb's are metacarpal, proximal,
/// distal, the others' proximal, intermediate, distal.
inline constexpr std::size_t kUpperArm = 0;
inline constexpr std::size_t kForearm = 1;
inline constexpr std::size_t kHandBone = 2;
inline constexpr std::size_t kFirstFingerBone = 3;
inline constexpr std::size_t kBonesPerFinger = 3;
inline constexpr std::size_t kBoneCount = kFirstFingerBone + kBonesPerFinger * kSimFingerCount;
inline constexpr std::size_t kThumb = 0;
inline constexpr std::size_t kIndex = 1;

[[nodiscard]] constexpr std::size_t finger_bone(std::size_t finger, std::size_t segment) noexcept {
    return kFirstFingerBone + finger * kBonesPerFinger + segment;
}

inline constexpr float kModelHandLengthMm = 185.0F;
inline constexpr float kForearmLengthMm = 255.0F;
inline constexpr float kUpperArmLengthMm = 290.0F;

/// A right arm at rest. The hand's own axes, mm: origin in the wrist, x toward the thumb, y along
/// the middle finger, z out of the palm; the arm goes down -y.
struct HandModel {
    struct Vertex {
        Vec3f position_mm = Vec3f::Zero();
        Vec3f normal = Vec3f::Zero();
        float albedo = 1.0F;  ///< relative to the person's skin (or sleeve)
        SimPart part = SimPart::hand;
        std::array<std::uint8_t, 4> bones{};
        std::array<float, 4> weights{};  ///< sum 1, largest first
    };
    std::vector<Vertex> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::array<std::uint32_t, kSimFingerCount> tip_vertex{};  ///< distal extreme
    std::array<std::uint32_t, kSimFingerCount> pad_vertex{};  ///< what touches in a pinch
};

/// Joints of the fingers at rest: where each segment begins, and the tip (three and one).
using FingerRest = std::array<Vec3f, kBonesPerFinger + 1>;
[[nodiscard]] const std::array<FingerRest, kSimFingerCount>& finger_rest();
/// Where the pad of a finger looks at rest.
[[nodiscard]] Vec3f pad_direction(std::size_t finger, std::size_t segment);
/// Radius of the flesh at the joints above.
[[nodiscard]] const std::array<std::array<float, kBonesPerFinger + 1>, kSimFingerCount>&
finger_radius();

/// One smooth skin over all bones, no seams. Made at the first call, the same for everybody.
/// @thread any
[[nodiscard]] const HandModel& hand_model();

}  // namespace xtrack::sim
