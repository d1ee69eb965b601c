// SPDX-License-Identifier: Apache-2.0
#include <xtrack/hand.hpp>

#include <Eigen/LU>

namespace xtrack {

namespace {

Vec3f rotate(const Mat4d& m, const Vec3f& v) {
    return (m.topLeftCorner<3, 3>() * v.cast<double>()).cast<float>();
}

Vec3f transform(const Mat4d& m, const Vec3f& p) {
    return (m.topLeftCorner<3, 3>() * p.cast<double>() + m.topRightCorner<3, 1>()).cast<float>();
}

Chirality mirrored(Chirality c) {
    switch (c) {
        case Chirality::left: return Chirality::right;
        case Chirality::right: return Chirality::left;
        case Chirality::unknown: break;
    }
    return Chirality::unknown;
}

}  // namespace

HandFrame to_interaction(const HandFrame& camera, const Mat4d& interaction_from_camera) {
    const Mat4d& m = interaction_from_camera;
    const bool reflects = m.topLeftCorner<3, 3>().determinant() < 0.0;
    HandFrame out = camera;
    out.coordinates = CoordinateFrame::interaction;
    for (Hand& hand : out.all()) {
        if (reflects) {
            hand.chirality = mirrored(hand.chirality);
        }
        hand.palm_mm = transform(m, hand.palm_mm);
        hand.palm_normal = rotate(m, hand.palm_normal);
        hand.palm_velocity_mmps = rotate(m, hand.palm_velocity_mmps);
        hand.forearm = rotate(m, hand.forearm);
        for (TrackedPoint& tip : hand.fingertips) {
            tip.position_mm = transform(m, tip.position_mm);
        }
        for (TrackedPoint& joint : hand.joints) {
            joint.position_mm = transform(m, joint.position_mm);
        }
    }
    return out;
}

const char* to_string(Chirality c) noexcept {
    switch (c) {
        case Chirality::left: return "left";
        case Chirality::right: return "right";
        case Chirality::unknown: break;
    }
    return "unknown";
}

const char* to_string(Joint j) noexcept {
    static constexpr const char* kNames[kJointCount] = {"palm",
                                                        "wrist",
                                                        "thumb_metacarpal",
                                                        "thumb_proximal",
                                                        "thumb_distal",
                                                        "thumb_tip",
                                                        "index_metacarpal",
                                                        "index_proximal",
                                                        "index_intermediate",
                                                        "index_distal",
                                                        "index_tip",
                                                        "middle_metacarpal",
                                                        "middle_proximal",
                                                        "middle_intermediate",
                                                        "middle_distal",
                                                        "middle_tip",
                                                        "ring_metacarpal",
                                                        "ring_proximal",
                                                        "ring_intermediate",
                                                        "ring_distal",
                                                        "ring_tip",
                                                        "little_metacarpal",
                                                        "little_proximal",
                                                        "little_intermediate",
                                                        "little_distal",
                                                        "little_tip"};
    return kNames[static_cast<std::size_t>(j)];
}

}  // namespace xtrack
