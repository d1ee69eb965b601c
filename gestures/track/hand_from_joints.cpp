// SPDX-License-Identifier: Apache-2.0
#include "gestures/track/hand_from_joints.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <Eigen/Geometry>

namespace xtrack {

namespace {

using std::chrono::milliseconds;

constexpr milliseconds kVelocityWindow{100};  // between 80 and 120 ms: noise against lag
constexpr milliseconds kForgetAfter{300};     // a hand that is back later starts anew

// Chord over bone length of a finger, from its knuckle: a straight finger has 0.95 and more, one
// that is folded away 0.4..0.6 (measured on joints of three trackers).
constexpr float kFoldedRatio = 0.50F;
constexpr float kStraightRatio = 0.95F;
constexpr float kExtendedFrom = 0.70F;

constexpr float kDegrees = 57.29578F;

// Flexion of a finger that grabs: none in an open hand at rest, all in one that is closed (measured
// on joints of two trackers: open 0..60, half closed at rest 110..150, closed 165..240).
constexpr float kOpenDeg = 40.0F;
constexpr float kFistDeg = 195.0F;

constexpr float kPinchOpenMm = 60.0F;  // value 0
constexpr float kPinchShutMm = 15.0F;  // value 1

// Hand breadth over the distance of the outer knuckles' centres is 1.33; the radius is half of it.
constexpr float kRadiusOfKnuckleSpan = 0.67F;
// Middle finger over hand length: 0.43 (adult anthropometry, both sexes within 0.01).
constexpr float kMiddleFingerOfHand = 0.43F;

struct Chain {
    Joint first;
    int count;
};
// From the knuckle outward; metacarpals do not bend.
constexpr std::array<Chain, kFingerCount> kChains{{{Joint::thumb_metacarpal, 4},
                                                   {Joint::index_proximal, 4},
                                                   {Joint::middle_proximal, 4},
                                                   {Joint::ring_proximal, 4},
                                                   {Joint::little_proximal, 4}}};
constexpr std::array<Joint, kFingerCount> kTips{
    Joint::thumb_tip, Joint::index_tip, Joint::middle_tip, Joint::ring_tip, Joint::little_tip};

bool known(const Hand& hand, Joint j) {
    return hand.joint(j).valid && hand.joint(j).position_mm.allFinite();
}

struct Bones {
    float chord_mm = 0.0F;
    float length_mm = 0.0F;
    int joints = 0;
};

Bones bones_of(const Hand& hand, const Chain& chain) {
    Bones bones;
    Vec3f first = Vec3f::Zero();
    Vec3f last = Vec3f::Zero();
    for (int i = 0; i < chain.count; ++i) {
        const auto j = static_cast<Joint>(static_cast<int>(chain.first) + i);
        if (!known(hand, j)) {
            continue;
        }
        const Vec3f p = hand.joint(j).position_mm;
        if (bones.joints == 0) {
            first = p;
        } else {
            bones.length_mm += (p - last).norm();
        }
        last = p;
        ++bones.joints;
    }
    bones.chord_mm = (last - first).norm();
    return bones;
}

bool find_palm(Hand& hand) {
    if (known(hand, Joint::palm)) {
        hand.palm_mm = hand.joint(Joint::palm).position_mm;
        return true;
    }
    if (known(hand, Joint::wrist) && known(hand, Joint::middle_proximal)) {
        hand.palm_mm = 0.5F * (hand.joint(Joint::wrist).position_mm +
                               hand.joint(Joint::middle_proximal).position_mm);
        return true;
    }
    return false;
}

}  // namespace

Vec3f palm_facing(const Hand& hand) noexcept {
    const Joint root = known(hand, Joint::wrist) ? Joint::wrist : Joint::palm;
    const Joint knuckle =
        known(hand, Joint::middle_proximal) ? Joint::middle_proximal : Joint::index_proximal;
    if (!known(hand, root) || !known(hand, knuckle) || !known(hand, Joint::index_proximal) ||
        !known(hand, Joint::little_proximal)) {
        return Vec3f::Zero();
    }
    const Vec3f across = hand.joint(Joint::little_proximal).position_mm -
                         hand.joint(Joint::index_proximal).position_mm;
    const Vec3f along = hand.joint(knuckle).position_mm - hand.joint(root).position_mm;
    Vec3f front = along.cross(across);
    const float norm = front.norm();
    if (norm < 1.0F) {
        return Vec3f::Zero();
    }
    front /= norm;
    return hand.chirality == Chirality::left ? Vec3f(-front) : front;
}

Flexion flexion_of(const Hand& hand, Finger finger) noexcept {
    const auto first = static_cast<int>(kChains[static_cast<std::size_t>(finger)].first);
    const auto joint = [&](int i) { return static_cast<Joint>(first + i); };
    const Joint root = known(hand, Joint::wrist) ? Joint::wrist : Joint::palm;
    const Vec3f front = palm_facing(hand);
    if (finger == Finger::thumb || front.isZero() || !known(hand, Joint::middle_proximal) ||
        !known(hand, joint(0)) || !known(hand, joint(1)) || !known(hand, joint(2)) ||
        !known(hand, joint(3))) {
        return {};
    }
    const Vec3f along =
        (hand.joint(Joint::middle_proximal).position_mm - hand.joint(root).position_mm)
            .normalized();
    const auto bone = [&](int i) {
        return Vec3f(hand.joint(joint(i + 1)).position_mm - hand.joint(joint(i)).position_mm);
    };
    const auto between = [](const Vec3f& a, const Vec3f& b) {
        return std::atan2(a.cross(b).norm(), a.dot(b));
    };
    const float up = bone(0).dot(front);
    const float knuckle_rad =
        std::atan2(hand.chirality == Chirality::unknown ? std::abs(up) : up, bone(0).dot(along));
    const float inner_rad = knuckle_rad + between(bone(0), bone(1));
    return {kDegrees * (inner_rad + between(bone(1), bone(2))), kDegrees * inner_rad};
}

float hand_length_mm(const Hand& hand) noexcept {
    const Bones middle = bones_of(hand, kChains[static_cast<std::size_t>(Finger::middle)]);
    return middle.joints == 4 ? middle.length_mm / kMiddleFingerOfHand : 0.0F;
}

bool complete_from_joints(Hand& hand) noexcept {
    if (!find_palm(hand)) {
        hand.confidence = 0.0F;  // nothing can be said of where it is
        return false;
    }
    hand.articulated = true;
    hand.palm_normal = palm_facing(hand);
    // A wrist bends, yet nothing else says where the elbow is.
    hand.forearm = Vec3f::Zero();
    if (known(hand, Joint::wrist)) {
        const Vec3f back = hand.joint(Joint::wrist).position_mm - hand.palm_mm;
        hand.forearm = back.norm() > 1.0F ? Vec3f(back.normalized()) : hand.forearm;
    }
    if (known(hand, Joint::index_proximal) && known(hand, Joint::little_proximal)) {
        hand.palm_radius_mm =
            kRadiusOfKnuckleSpan * (hand.joint(Joint::little_proximal).position_mm -
                                    hand.joint(Joint::index_proximal).position_mm)
                                       .norm();
    }
    int extended = 0;
    int known_fingers = 0;
    float curl = 0.0F;
    int curl_fingers = 0;
    for (std::size_t f = 0; f < kFingerCount; ++f) {
        hand.fingertips[f].valid = known(hand, kTips[f]);
        if (hand.fingertips[f].valid) {
            hand.fingertips[f].position_mm = hand.joint(kTips[f]).position_mm;
        }
        const Bones bones = bones_of(hand, kChains[f]);
        hand.finger_extension[f] = -1.0F;
        if (bones.joints < 3 || bones.length_mm < 1.0F) {
            continue;  // two points are straight whatever the finger does
        }
        const float ratio = bones.chord_mm / bones.length_mm;
        hand.finger_extension[f] =
            std::clamp((ratio - kFoldedRatio) / (kStraightRatio - kFoldedRatio), 0.0F, 1.0F);
        ++known_fingers;
        extended += hand.finger_extension[f] >= kExtendedFrom ? 1 : 0;
        const float deg = flexion_of(hand, static_cast<Finger>(f)).whole_deg;
        if (deg > kFlexionUnknown) {
            curl += std::clamp((deg - kOpenDeg) / (kFistDeg - kOpenDeg), 0.0F, 1.0F);
            ++curl_fingers;
        }
    }
    hand.extended_fingers = known_fingers > 0 ? extended : -1;
    hand.grab_value = curl_fingers > 0 ? curl / static_cast<float>(curl_fingers) : 0.0F;

    const TrackedPoint& thumb = hand.fingertip(Finger::thumb);
    const TrackedPoint& index = hand.fingertip(Finger::index);
    hand.pinch_aperture_mm = -1.0F;
    hand.pinch_value = 0.0F;
    if (thumb.valid && index.valid) {
        hand.pinch_aperture_mm = (thumb.position_mm - index.position_mm).norm();
        hand.pinch_value = std::clamp(
            (kPinchOpenMm - hand.pinch_aperture_mm) / (kPinchOpenMm - kPinchShutMm), 0.0F, 1.0F);
    }
    return true;
}

void HandFromJoints::reset() noexcept { motions_ = {}; }

HandFromJoints::Motion& HandFromJoints::motion_of(int id, Stamp now) noexcept {
    Motion* oldest = motions_.data();
    for (Motion& m : motions_) {
        if (m.used && m.id == id) {
            if (m.count > 0 && now - m.stamp[m.newest] > kForgetAfter) {
                m.count = 0;
            }
            return m;
        }
        const bool older =
            !m.used || m.count == 0 || m.stamp[m.newest] < oldest->stamp[oldest->newest];
        if (oldest->used && older) {
            oldest = &m;
        }
    }
    *oldest = Motion{};
    oldest->used = true;
    oldest->id = id;
    return *oldest;
}

void HandFromJoints::add(Motion& m, Stamp now, const Vec3f& palm_mm) noexcept {
    if (m.count > 0 && now <= m.stamp[m.newest]) {
        return;
    }
    m.newest = m.count == 0 ? 0 : (m.newest + 1) % kSamples;
    m.count = std::min(m.count + 1, kSamples);
    m.stamp[m.newest] = now;
    m.palm_mm[m.newest] = palm_mm;

    // Least squares of position over time; two samples at least, however slow the camera.
    double n = 0.0;
    double sum_t = 0.0;
    double sum_tt = 0.0;
    Vec3d sum_p = Vec3d::Zero();
    Vec3d sum_tp = Vec3d::Zero();
    for (std::size_t back = 0; back < m.count; ++back) {
        const std::size_t i = (m.newest + kSamples - back) % kSamples;
        if (back >= 2 && now - m.stamp[i] > kVelocityWindow) {
            break;
        }
        const double t = -to_seconds(now - m.stamp[i]);
        const Vec3d p = (m.palm_mm[i] - palm_mm).cast<double>();
        n += 1.0;
        sum_t += t;
        sum_tt += t * t;
        sum_p += p;
        sum_tp += t * p;
    }
    const double spread = n * sum_tt - sum_t * sum_t;
    m.velocity_mmps = n >= 2.0 && spread > 0.0
                          ? Vec3f(((n * sum_tp - sum_t * sum_p) / spread).cast<float>())
                          : Vec3f(Vec3f::Zero());
}

void HandFromJoints::complete(HandFrame& frame) noexcept {
    for (Hand& hand : frame.all()) {
        if (!complete_from_joints(hand)) {
            continue;
        }
        Motion& motion = motion_of(hand.id, frame.stamp);
        add(motion, frame.stamp, hand.palm_mm);
        hand.palm_velocity_mmps = motion.velocity_mmps;
    }
}

}  // namespace xtrack
