// SPDX-License-Identifier: Apache-2.0
#include "gestures/track/hand_joints.hpp"

#include <array>

#include <Eigen/Geometry>

#include "gestures/track/hand_from_joints.hpp"

namespace xtrack::track {

namespace {

// Of the hands that were measured, wrist to the middle finger's tip.
constexpr float kMeasuredHandMm = 187.0F;
// Skin to the middle of the palm, the wrist, a finger.
constexpr float kPalmHalfMm = 13.0F;
constexpr float kFingerHalfMm = 7.5F;
constexpr float kStraight = 0.75F;  // extension
constexpr float kLeastUp = 0.3F;    // sine of the angle between the fingers and the palm's normal

/// Lengths of bones, mm; the pulp is what the tip's joint lies before the bone's end.
struct Bones {
    float metacarpal, proximal, intermediate, distal;
};
// Thumb: metacarpal, proximal, distal; the distal ones with the pulp.
constexpr std::array<Bones, kFingerCount> kBones{{{46.2F, 31.6F, 0.0F, 27.3F},
                                                  {68.1F, 39.8F, 22.4F, 19.7F},
                                                  {64.6F, 44.6F, 26.3F, 21.4F},
                                                  {58.0F, 41.4F, 25.7F, 21.3F},
                                                  {53.7F, 32.7F, 18.1F, 19.7F}}};
// Where knuckles lie from the middle of the palm: toward the fingers, toward the thumb, mm.
constexpr std::array<float, kFingerCount> kKnuckleUp{0.0F, 36.0F, 37.0F, 33.0F, 26.0F};
constexpr std::array<float, kFingerCount> kKnuckleAside{0.0F, 25.0F, 5.0F, -14.0F, -30.0F};
constexpr float kWristMm = 49.0F;  // below the middle of the palm
// The thumb's first joint, from the wrist.
constexpr float kThumbUpMm = 18.0F;
constexpr float kThumbAsideMm = 22.0F;

constexpr std::array<Joint, kFingerCount> kMetacarpals{
    Joint::thumb_metacarpal, Joint::index_metacarpal, Joint::middle_metacarpal,
    Joint::ring_metacarpal, Joint::little_metacarpal};

Joint after(Joint joint, int steps) { return static_cast<Joint>(static_cast<int>(joint) + steps); }

/// A hand's own axes at its middle.
struct Axes {
    Vec3f middle_mm;
    Vec3f up;     ///< to the fingers
    Vec3f aside;  ///< to the thumb
    Vec3f in;     ///< from the skin that is seen into the hand
    float scale;

    [[nodiscard]] Vec3f at(float up_mm, float aside_mm) const {
        return middle_mm + scale * (up_mm * up + aside_mm * aside);
    }
};

/// Where straight fingers point, on the whole; zero where none is. A wrist bends sideways, so that
/// the forearm tells less.
Vec3f to_fingers(const Hand& hand) {
    Vec3f sum = Vec3f::Zero();
    for (const Finger finger : {Finger::index, Finger::middle, Finger::ring, Finger::little}) {
        const auto f = static_cast<std::size_t>(finger);
        if (hand.fingertips[f].valid && hand.finger_extension[f] >= kStraight) {
            sum += (hand.fingertips[f].position_mm - hand.palm_mm).normalized();
        }
    }
    return sum;
}

/// A finger with its tip in view: the joints between it and the root lie on a line, if it is
/// straight.
void fill_finger(std::size_t f, const Axes& axes, const Vec3f& root_mm, Hand& hand) {
    const bool thumb = f == static_cast<std::size_t>(Finger::thumb);
    const Bones& bones = kBones[f];
    const Vec3f tip_mm = hand.fingertips[f].position_mm + axes.scale * kFingerHalfMm * axes.in;
    const Joint first = thumb ? Joint::thumb_metacarpal : after(kMetacarpals[f], 1);
    const std::array<float, 3> lengths =
        thumb ? std::array{bones.metacarpal, bones.proximal, bones.distal}
              : std::array{bones.proximal, bones.intermediate, bones.distal};
    const float whole = lengths[0] + lengths[1] + lengths[2];
    float so_far = 0.0F;
    for (int k = 0; k < 3; ++k) {
        hand.joint(after(first, k)) = {root_mm + so_far / whole * (tip_mm - root_mm), true};
        so_far += lengths[static_cast<std::size_t>(k)];
    }
    hand.joint(after(first, 3)) = {tip_mm, true};
}

}  // namespace

void infer_joints(const HandRegion& region, int thumb_side, Hand& hand) {
    hand.articulated = false;
    for (TrackedPoint& joint : hand.joints) {
        joint = {};
    }
    if (hand.palm_normal.isZero() || region.palm_radius_mm <= 0.0F) {
        return;
    }
    Axes axes;
    axes.scale = region.palm_radius_mm / (kPalmRadiusOfLength * kMeasuredHandMm);
    axes.in = -hand.palm_normal;
    axes.middle_mm = region.palm_mm + axes.scale * kPalmHalfMm * axes.in;
    hand.joint(Joint::palm) = {axes.middle_mm, true};

    Vec3f up = to_fingers(hand);
    const bool pointing = !up.isZero();
    if (!pointing) {
        up = region.palm_mm - region.wrist_mm;
    }
    up.normalize();
    up -= up.dot(axes.in) * axes.in;
    if (up.norm() < kLeastUp) {
        return;  // it points at the camera
    }
    axes.up = up.normalized();
    // Where the forearm was cut off lies on its skin, and where it is thinnest: it tells the way to
    // the wrist only.
    const Vec3f wrist_mm = axes.middle_mm - axes.scale * kWristMm * axes.up;
    hand.joint(Joint::wrist) = {wrist_mm, true};
    // Of a hand without a straight finger it is not seen which way it is turned.
    if (thumb_side == 0 || !pointing) {
        return;
    }
    // Clockwise of the fingers as the camera sees them: its y goes down, its z away from it.
    axes.aside = static_cast<float>(thumb_side) * axes.up.cross(hand.palm_normal);
    for (std::size_t f = 0; f < kFingerCount; ++f) {
        const bool thumb = f == static_cast<std::size_t>(Finger::thumb);
        const Vec3f root_mm =
            thumb
                ? Vec3f(wrist_mm + axes.scale * (kThumbUpMm * axes.up + kThumbAsideMm * axes.aside))
                : axes.at(kKnuckleUp[f], kKnuckleAside[f]);
        if (!thumb) {
            // Metacarpals do not bend; they converge toward the wrist.
            const Vec3f back = (wrist_mm - root_mm).normalized();
            hand.joint(kMetacarpals[f]) = {root_mm + axes.scale * kBones[f].metacarpal * back,
                                           true};
            hand.joint(after(kMetacarpals[f], 1)) = {root_mm, true};
        }
        if (hand.fingertips[f].valid && hand.finger_extension[f] >= kStraight) {
            fill_finger(f, axes, root_mm, hand);
        } else if (hand.fingertips[f].valid) {
            hand.joint(after(kMetacarpals[f], thumb ? 3 : 4)) = {
                hand.fingertips[f].position_mm + axes.scale * kFingerHalfMm * axes.in, true};
        }
    }
}

}  // namespace xtrack::track
