// SPDX-License-Identifier: Apache-2.0
#include "gestures/recognise/motion_history.hpp"

#include <algorithm>
#include <cmath>

#include "gestures/track/hand_from_joints.hpp"

namespace xtrack::recognise {

float MotionSample::outer_extension() const noexcept {
    float sum = 0.0F;
    int known = 0;
    for (const Finger f : {Finger::middle, Finger::ring, Finger::little}) {
        const float e = extension[static_cast<std::size_t>(f)];
        if (e >= 0.0F) {
            sum += e;
            ++known;
        }
    }
    return known > 0 ? sum / static_cast<float>(known) : -1.0F;
}

MotionSample sample_of(const Hand& hand, Stamp stamp) noexcept {
    MotionSample s;
    s.stamp = stamp;
    s.palm_mm = hand.palm_mm;
    const TrackedPoint& index = hand.fingertip(Finger::index);
    const TrackedPoint& thumb = hand.fingertip(Finger::thumb);
    const TrackedPoint& middle = hand.fingertip(Finger::middle);
    s.index_tip_known = index.valid && index.position_mm.allFinite();
    if (s.index_tip_known) {
        s.index_tip_mm = index.position_mm;
    }
    // Joints alone say where the palm points: a depth camera sees one side, and calls it the
    // normal.
    s.facing = palm_facing(hand);
    s.facing_signed = hand.chirality != Chirality::unknown;
    if (std::isfinite(hand.pinch_aperture_mm)) {
        s.aperture_mm = hand.pinch_aperture_mm;
    }
    s.hand_length_mm = hand_length_mm(hand);
    s.extension = hand.finger_extension;
    if (thumb.valid && middle.valid && thumb.position_mm.allFinite() &&
        middle.position_mm.allFinite()) {
        s.thumb_to_middle_mm = (thumb.position_mm - middle.position_mm).norm();
    }
    const TrackedPoint& knuckle = hand.joint(Joint::index_proximal);
    s.knuckle_known = knuckle.valid && knuckle.position_mm.allFinite() && s.index_tip_known &&
                      thumb.valid && thumb.position_mm.allFinite();
    if (s.knuckle_known) {
        s.thumb_from_knuckle_mm = thumb.position_mm - knuckle.position_mm;
        s.index_from_knuckle_mm = index.position_mm - knuckle.position_mm;
    }
    return s;
}

bool MotionHistory::add(const MotionSample& sample) noexcept {
    if (count_ > 0 && sample.stamp - newest().stamp < kMinSpacing) {
        return false;
    }
    newest_ = count_ == 0 ? 0 : (newest_ + 1) % kCapacity;
    count_ = std::min(count_ + 1, kCapacity);
    samples_[newest_] = sample;
    return true;
}

Vec3f MotionHistory::velocity(Duration window, std::size_t back) const noexcept {
    if (back + 1 >= count_) {
        return Vec3f::Zero();
    }
    const Stamp end = at(back).stamp;
    const Vec3f origin_mm = at(back).palm_mm;
    double n = 0.0;
    double sum_t = 0.0;
    double sum_tt = 0.0;
    Vec3d sum_p = Vec3d::Zero();
    Vec3d sum_tp = Vec3d::Zero();
    for (std::size_t i = back; i < count_; ++i) {
        const MotionSample& s = at(i);
        if (i >= back + 2 && end - s.stamp > window) {
            break;
        }
        const double t = -to_seconds(end - s.stamp);
        const Vec3d p = (s.palm_mm - origin_mm).cast<double>();
        n += 1.0;
        sum_t += t;
        sum_tt += t * t;
        sum_p += p;
        sum_tp += t * p;
    }
    const double spread = n * sum_tt - sum_t * sum_t;
    if (spread <= 0.0) {
        return Vec3f::Zero();
    }
    return ((n * sum_tp - sum_t * sum_p) / spread).cast<float>();
}

std::size_t MotionHistory::count_within(Duration age) const noexcept {
    std::size_t n = 0;
    while (n < count_ && newest().stamp - at(n).stamp <= age) {
        ++n;
    }
    return n;
}

}  // namespace xtrack::recognise
