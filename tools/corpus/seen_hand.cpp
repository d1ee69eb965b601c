// SPDX-License-Identifier: Apache-2.0
#include "tools/corpus/seen_hand.hpp"

#include <algorithm>
#include <cmath>

#include "core/sim/hand_model.hpp"

namespace xtrack::tools::corpus {

namespace {

// Of the model's hand, mm; measured (`xtrack corpus --measure-noise` prints what is left of it).
constexpr float kPalmSkinMm = 16.5F;    // from the palm joint to the skin before it
constexpr float kPalmToThumbMm = 4.8F;  // the widest circle lies nearer to the ball of the thumb
constexpr float kPalmToWristMm = 5.2F;  // and to the wrist than the joint
constexpr float kPalmRadiusMm = 43.3F;  // square to the camera
constexpr float kPalmSideMm = 15.0F;    // half the thickness: what an edge-on hand shows
constexpr float kFingerWidthMm = 17.0F;

// What a tip must do to be one in an outline: leave the palm's circle, and its neighbours.
constexpr float kStandsOutRadii = 1.3F;
constexpr float kApartMm = 14.0F;

// The meaning of Hand::finger_extension and grab_value for a depth camera, as their users know it:
// 0 at the first reach (area), 1 at the second, in palm radii (squared).
constexpr float kFoldedRadii = 1.3F;
constexpr float kStraightRadii = 2.4F;
constexpr float kThumbFoldedRadii = 1.1F;
constexpr float kThumbStraightRadii = 1.8F;
constexpr float kFistArea = 0.25F;
constexpr float kOpenArea = 1.9F;

float ramp(float v, float from, float to) {
    return std::clamp((v - from) / (to - from), 0.0F, 1.0F);
}

/// Where a point is seen, as mm in the plane of the palm.
Vec2f seen_at(const Vec3f& p, float z_mm) { return {p.x() / p.z() * z_mm, p.y() / p.z() * z_mm}; }

}  // namespace

SeenHand look_at(const sim::HandPose& pose, SimHand hand, float scale, const Pinhole& camera) {
    const sim::HandModel& model = sim::hand_model();
    const sim::PosedBones bones = sim::pose_bones(pose, hand, scale);
    SeenHand seen;
    seen.joints_mm = bones.joints_mm;
    const auto at_vertex = [&](std::uint32_t v) { return skin_point(model.vertices[v], bones); };
    for (std::size_t f = 0; f < kFingerCount; ++f) {
        seen.tips_mm[f] = at_vertex(model.tip_vertex[f]);
    }
    seen.aperture_mm = sim::aperture_mm(model, bones);

    const Vec3f centre = bones.joints_mm[0];
    const Vec3f to_camera = -centre.normalized();
    Vec3f normal = bones.bones[sim::kHandBone].rotation.col(2).normalized();
    float facing = normal.dot(to_camera);
    if (facing < 0.0F) {
        normal = -normal;
        facing = -facing;
    }
    seen.palm_normal = normal;
    seen.forearm = -bones.bones[sim::kForearm].rotation.col(1).normalized();
    seen.palm_radius_mm = scale * std::max(kPalmRadiusMm * std::sqrt(facing), kPalmSideMm);
    const auto& turned = bones.bones[sim::kHandBone].rotation;  // and scaled
    seen.palm_mm = centre + to_camera * (scale * kPalmSkinMm) + turned.col(0) * kPalmToThumbMm -
                   turned.col(1) * kPalmToWristMm;

    float finger_area = 0.0F;
    const float z = seen.palm_mm.z();
    const Vec2f palm = seen_at(seen.palm_mm, z);
    for (std::size_t f = 0; f < kFingerCount; ++f) {
        const Vec2f tip = seen_at(seen.tips_mm[f], z);
        float gap = INFINITY;
        for (std::size_t other = 0; other < kFingerCount; ++other) {
            if (other != f) {
                gap = std::min(gap, (seen_at(seen.tips_mm[other], z) - tip).norm());
            }
        }
        const float reach = (tip - palm).norm() / seen.palm_radius_mm;
        seen.tip_gap_mm[f] = gap;
        seen.tip_seen[f] = reach > kStandsOutRadii && gap > scale * kApartMm;
        seen.extension[f] = f == static_cast<std::size_t>(Finger::thumb)
                                ? ramp(reach, kThumbFoldedRadii, kThumbStraightRadii)
                                : ramp(reach, kFoldedRadii, kStraightRadii);
        finger_area += std::max(0.0F, reach - 1.0F) * scale * kFingerWidthMm / seen.palm_radius_mm;
    }
    seen.grab = 1.0F - ramp(finger_area, kFistArea, kOpenArea);

    const auto inside = [&](const Vec3f& p) {
        const double x = p.x() / p.z() * camera.matrix(0, 0) + camera.matrix(0, 2);
        const double y = p.y() / p.z() * camera.matrix(1, 1) + camera.matrix(1, 2);
        return p.z() > 1.0F && x >= 0.0 && y >= 0.0 && x <= camera.size.width - 1.0 &&
               y <= camera.size.height - 1.0;
    };
    seen.in_view = inside(seen.palm_mm);
    seen.touches_border =
        !inside(seen.palm_mm) || !std::all_of(seen.tips_mm.begin(), seen.tips_mm.end(), inside);
    return seen;
}

}  // namespace xtrack::tools::corpus
