// SPDX-License-Identifier: Apache-2.0
#include "core/sim/hand_pose.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace xtrack::sim {
namespace {

using Mat3 = Eigen::Matrix<float, 3, 3, Eigen::DontAlign>;

const Vec3f kPalmJoint{-1.0F, 48.0F, 0.0F};
const Vec3f kAxisY{0.0F, 1.0F, 0.0F};
const Vec3f kAxisZ{0.0F, 0.0F, 1.0F};
// Where the metacarpals of index to little finger begin.
const std::array<Vec3f, 4> kMetacarpalBase{
    {{14.0F, 18.0F, 0.0F}, {4.0F, 19.0F, 0.0F}, {-6.0F, 18.0F, 0.0F}, {-15.0F, 16.0F, 0.0F}}};

Mat3 turn(const Vec3f& axis, float angle_rad) {
    return Eigen::AngleAxisf(angle_rad, Eigen::Vector3f(axis)).toRotationMatrix();
}

Affine about(const Mat3& rotation, const Vec3f& pivot) {
    return {rotation, pivot - rotation * pivot};
}

Affine compose(const Affine& outer, const Affine& inner) {
    return {outer.rotation * inner.rotation, outer.rotation * inner.offset + outer.offset};
}

/// Axes of a bone whose y is known and whose z should be near `z_wish`.
Mat3 axes_from(const Vec3f& y, const Vec3f& z_wish, const Vec3f& x_fallback) {
    constexpr float kParallel = 1e-3F;
    Vec3f z = z_wish - y * y.dot(z_wish);
    if (z.norm() < kParallel) {
        z = x_fallback.cross(y);
    }
    z.normalize();
    Mat3 axes;
    axes.col(0) = y.cross(z);
    axes.col(1) = y;
    axes.col(2) = z;
    return axes;
}

/// Elbow by the law of cosines, in the plane of shoulder, wrist and `pole`. A shoulder out of reach
/// comes along, as a leaning body does.
Vec3f place_elbow(Vec3f& shoulder, const Vec3f& wrist, const Vec3f& pole, float forearm,
                  float upper) {
    constexpr float kAlmostStraight = 0.985F;
    Vec3f to_shoulder = shoulder - wrist;
    const float reach = (forearm + upper) * kAlmostStraight;
    if (to_shoulder.norm() > reach) {
        to_shoulder *= reach / to_shoulder.norm();
        shoulder = wrist + to_shoulder;
    }
    const float d = std::max(to_shoulder.norm(), std::abs(upper - forearm) + 20.0F);
    const Vec3f axis = to_shoulder.normalized();
    const float along = (forearm * forearm - upper * upper + d * d) / (2.0F * d);
    const float off = std::sqrt(std::max(forearm * forearm - along * along, 0.0F));
    return wrist + axis * along + (pole - axis * pole.dot(axis)).normalized() * off;
}

/// Bones of the fingers in the hand's own frame.
void pose_fingers(const FingerAngles& angles, std::array<Affine, kBoneCount>& local) {
    for (std::size_t f = 0; f < kSimFingerCount; ++f) {
        const auto& joint = finger_rest()[f];
        const float* a = &angles[f * kAnglesPerFinger];
        const auto flexion = [&](std::size_t s, float angle) {
            const Vec3f axis = (joint[s + 1] - joint[s]).normalized().cross(pad_direction(f, s));
            return turn(axis, angle);
        };
        const Mat3 root = f == kThumb ? Mat3(turn(kAxisY, -a[0]) * turn(kAxisZ, -a[1]))
                                      : Mat3(turn(kAxisZ, -a[1]) * flexion(0, a[0]));
        Affine bone = compose(local[kHandBone], about(root, joint[0]));
        local[finger_bone(f, 0)] = bone;
        for (std::size_t s = 1; s < kBonesPerFinger; ++s) {
            bone = compose(bone, about(flexion(s, a[s + 1]), joint[s]));
            local[finger_bone(f, s)] = bone;
        }
    }
}

}  // namespace

PosedBones pose_bones(const HandPose& pose, SimHand hand, float scale) {
    // A left hand is a right one seen in a mirror, from its own frame outward.
    const float side = hand == SimHand::right ? 1.0F : -1.0F;
    const Vec3f mirror{side, 1.0F, 1.0F};
    Mat3 facing = Mat3::Zero();  // x to the image's right, fingers up, palm to the camera
    facing.diagonal() = Vec3f(1.0F, -1.0F, -1.0F);
    const Mat3 rotation = turn({0.0F, 1.0F, 0.0F}, side * pose.turn_rad.y()) *
                          turn({1.0F, 0.0F, 0.0F}, pose.turn_rad.x()) *
                          turn({0.0F, 0.0F, 1.0F}, side * pose.turn_rad.z()) * facing;
    Affine camera_from_local;
    camera_from_local.rotation = rotation * Vec3f(mirror * scale).asDiagonal();
    camera_from_local.offset = pose.palm_mm - camera_from_local.rotation * kPalmJoint;

    std::array<Affine, kBoneCount> local;
    const Vec3f wrist = camera_from_local.offset;
    Vec3f shoulder = pose.shoulder_mm;
    const Vec3f pole{-0.22F * side, 0.97F, 0.1F};
    const Vec3f elbow =
        place_elbow(shoulder, wrist, pole, kForearmLengthMm * scale, kUpperArmLengthMm * scale);
    const auto to_local = [&](const Vec3f& camera) {
        return Vec3f(camera_from_local.rotation.transpose() * (camera - wrist) / (scale * scale));
    };
    const Vec3f elbow_local = to_local(elbow);
    const Vec3f shoulder_local = to_local(shoulder);
    const Vec3f rest_elbow{0.0F, -kForearmLengthMm, 0.0F};
    const Mat3 forearm = axes_from(-elbow_local.normalized(), kAxisZ, {1.0F, 0.0F, 0.0F});
    local[kForearm] = {forearm, Vec3f::Zero()};
    const Mat3 upper =
        axes_from((elbow_local - shoulder_local).normalized(), forearm.col(2), forearm.col(0));
    local[kUpperArm] = {upper, elbow_local - upper * rest_elbow};
    pose_fingers(pose.fingers, local);

    PosedBones posed;
    for (std::size_t b = 0; b < kBoneCount; ++b) {
        posed.bones[b] = compose(camera_from_local, local[b]);
    }
    posed.joints_mm[0] = posed.bones[kHandBone] * kPalmJoint;
    posed.joints_mm[1] = posed.bones[kHandBone] * Vec3f(Vec3f::Zero());
    std::size_t j = 2;
    for (std::size_t f = 0; f < kSimFingerCount; ++f) {
        if (f != kThumb) {
            posed.joints_mm[j++] = posed.bones[kHandBone] * kMetacarpalBase[f - 1];
        }
        for (std::size_t s = 0; s < kBonesPerFinger; ++s) {
            posed.joints_mm[j++] = posed.bones[finger_bone(f, s)] * finger_rest()[f][s];
        }
        posed.joints_mm[j++] = posed.bones[finger_bone(f, 2)] * finger_rest()[f][3];
    }
    return posed;
}

Vec3f skin_point(const HandModel::Vertex& vertex, const PosedBones& bones) {
    Vec3f p = Vec3f::Zero();
    for (std::size_t i = 0; i < 4; ++i) {
        p += vertex.weights[i] * (bones.bones[vertex.bones[i]] * vertex.position_mm);
    }
    return p;
}

void skin(const HandModel& model, const PosedBones& bones, std::vector<Vec3f>& positions_mm,
          std::vector<Vec3f>& normals) {
    for (std::size_t v = 0; v < model.vertices.size(); ++v) {
        const HandModel::Vertex& vertex = model.vertices[v];
        const Affine& first = bones.bones[vertex.bones[0]];
        constexpr float kOneBone = 0.999F;
        if (vertex.weights[0] > kOneBone) {
            positions_mm[v] = first * vertex.position_mm;
            normals[v] = first.rotation * vertex.normal;
            continue;
        }
        Affine blend{first.rotation * vertex.weights[0], first.offset * vertex.weights[0]};
        for (std::size_t i = 1; i < 4 && vertex.weights[i] > 0.0F; ++i) {
            const Affine& bone = bones.bones[vertex.bones[i]];
            blend.rotation += bone.rotation * vertex.weights[i];
            blend.offset += bone.offset * vertex.weights[i];
        }
        positions_mm[v] = blend * vertex.position_mm;
        normals[v] = blend.rotation * vertex.normal;
    }
}

FingerAngles relaxed_open() {
    return {0.05F, 0.00F,  0.05F, 0.10F,   // thumb
            0.12F, -0.06F, 0.14F, 0.08F,   // index
            0.10F, 0.00F,  0.16F, 0.09F,   // middle
            0.12F, 0.05F,  0.18F, 0.10F,   // ring
            0.16F, 0.10F,  0.20F, 0.11F};  // little
}

FingerAngles pinch_open() {
    return {0.55F, 0.02F, 0.05F, 0.10F,   // thumb
            0.30F, 0.00F, 0.30F, 0.15F,   // index
            0.25F, 0.00F, 0.30F, 0.18F,   // middle
            0.30F, 0.04F, 0.35F, 0.20F,   // ring
            0.35F, 0.08F, 0.40F, 0.22F};  // little
}

float aperture_mm(const HandModel& model, const PosedBones& bones) {
    return (skin_point(model.vertices[model.pad_vertex[kThumb]], bones) -
            skin_point(model.vertices[model.pad_vertex[kIndex]], bones))
        .norm();
}

FingerAngles solve_pinch_closed(const HandModel& model) {
    // Coordinate descent over the bends of thumb and index finger: the pads at a touch, facing each
    // other, the bends as small as that allows.
    constexpr float kTouchMm = 3.0F;
    constexpr float kFacingMm2 = 60.0F;
    constexpr float kBendMm2 = 12.0F;
    const FingerAngles open = pinch_open();
    const HandModel::Vertex& thumb = model.vertices[model.pad_vertex[kThumb]];
    const HandModel::Vertex& index = model.vertices[model.pad_vertex[kIndex]];
    const auto cost = [&](const FingerAngles& angles) {
        HandPose pose;
        pose.palm_mm = {0.0F, 0.0F, 600.0F};
        pose.shoulder_mm = {0.0F, 0.0F, 1000.0F};
        pose.fingers = angles;
        const PosedBones bones = pose_bones(pose, SimHand::right, 1.0F);
        const float gap = aperture_mm(model, bones) - kTouchMm;
        const Vec3f n_thumb = bones.bones[thumb.bones[0]].rotation * thumb.normal;
        const Vec3f n_index = bones.bones[index.bones[0]].rotation * index.normal;
        float sum = gap * gap + kFacingMm2 * (1.0F + n_thumb.dot(n_index));
        for (std::size_t i = 0; i < 2 * kAnglesPerFinger; ++i) {
            const float bend = angles[i] - open[i];
            sum += kBendMm2 * bend * bend;
        }
        return sum;
    };
    // Limits of the joints, rad.
    constexpr std::array<float, 2 * kAnglesPerFinger> kLow{0.2F, -0.5F,  -0.1F, -0.1F,
                                                           0.1F, -0.25F, 0.1F,  0.05F};
    constexpr std::array<float, 2 * kAnglesPerFinger> kHigh{1.3F, 0.5F,  0.9F, 0.9F,
                                                            1.2F, 0.25F, 1.5F, 0.9F};
    FingerAngles best = open;
    float best_cost = cost(best);
    for (float step = 0.2F; step > 0.004F; step *= 0.7F) {
        for (int sweep = 0; sweep < 6; ++sweep) {
            for (std::size_t i = 0; i < 2 * kAnglesPerFinger; ++i) {
                for (const float sign : {-1.0F, 1.0F}) {
                    FingerAngles trial = best;
                    trial[i] = std::clamp(trial[i] + sign * step, kLow[i], kHigh[i]);
                    const float c = cost(trial);
                    if (c < best_cost) {
                        best_cost = c;
                        best = trial;
                    }
                }
            }
        }
    }
    return best;
}

}  // namespace xtrack::sim
