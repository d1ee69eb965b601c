// SPDX-License-Identifier: Apache-2.0
#include "gestures/recognise/motion_history.hpp"

#include <algorithm>
#include <cmath>

#include "gestures/recognise/line_fit.hpp"

namespace xtrack::recognise {

namespace {

constexpr int kOpenFingers = 3;
constexpr float kHalfClosed = 0.5F;
constexpr float kStraight = 0.5F;     // extension: half-way out
constexpr float kShortestMm = 10.0F;  // palm to fingertips; less has no direction
// Thumb and index tip of an adult come no farther apart (0.85 of a hand of 205 mm; 3.7 times the
// circle in the palm, which is 0.23 of the length), and no faster (finger taps peak at 1 m/s, plus
// three sigma of the difference of two apertures): more is another finger, or the wrist, taken for
// one of them.
constexpr float kSpanMm = 175.0F;
constexpr float kSpanOfRadius = 3.7F;
constexpr float kFastestMmps = 1500.0F;
constexpr float kApertureNoiseMm = 12.0F;
// What is averaged to lower its noise: one sample at 20 fps, five at 120 fps, so that nothing is
// late where frames are few.
constexpr Duration kRecent = std::chrono::milliseconds{40};
constexpr Duration kUnseenMost = std::chrono::milliseconds{50};
// Five images at 60 Hz, or a depth camera at 15 Hz.
constexpr Duration kUsualSpan = std::chrono::nanoseconds{1'000'000'000 / 15};

/// Where the hand points: from the wrist where joints say it, else to the straight fingers.
Vec3f distal_of(const Hand& hand) {
    Vec3f along = Vec3f::Zero();
    const TrackedPoint& wrist = hand.joint(Joint::wrist);
    if (wrist.valid && wrist.position_mm.allFinite()) {
        along = hand.palm_mm - wrist.position_mm;
    } else {
        float n = 0.0F;
        for (const Finger f : {Finger::index, Finger::middle, Finger::ring, Finger::little}) {
            const TrackedPoint& tip = hand.fingertip(f);
            if (tip.valid && tip.position_mm.allFinite() &&
                hand.finger_extension[static_cast<std::size_t>(f)] >= kStraight) {
                along += tip.position_mm - hand.palm_mm;
                n += 1.0F;
            }
        }
        along /= std::max(n, 1.0F);
    }
    return along.norm() >= kShortestMm ? Vec3f(along.normalized()) : Vec3f(Vec3f::Zero());
}

/// From the thumb's tip to the nearest joint of index, middle and ring finger beyond the knuckles.
float thumb_to_fingers(const Hand& hand, const TrackedPoint& thumb) {
    float nearest_mm = -1.0F;
    for (const Joint j : {Joint::index_intermediate, Joint::index_distal, Joint::index_tip,
                          Joint::middle_intermediate, Joint::middle_distal, Joint::middle_tip,
                          Joint::ring_intermediate, Joint::ring_distal, Joint::ring_tip}) {
        const TrackedPoint& point = hand.joint(j);
        if (thumb.valid && point.valid && thumb.position_mm.allFinite() &&
            point.position_mm.allFinite()) {
            const float mm = (point.position_mm - thumb.position_mm).norm();
            nearest_mm = nearest_mm < 0.0F ? mm : std::min(nearest_mm, mm);
        }
    }
    return nearest_mm;
}

}  // namespace

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

MotionSample sample_of(const Hand& seen, Stamp stamp, Duration span) noexcept {
    // Joints that follow from proportions tell nothing that the tips do not.
    Hand hand = seen;
    if (!seen.articulated) {
        hand.joints = {};
    }
    MotionSample s;
    s.stamp = stamp;
    s.span = span;
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
    s.side = hand.palm_normal;
    s.facing_signed = hand.chirality != Chirality::unknown;
    s.from_joints = seen.articulated;
    const float span_mm = s.from_joints || hand.palm_radius_mm <= 0.0F
                              ? kSpanMm
                              : std::min(kSpanMm, kSpanOfRadius * hand.palm_radius_mm);
    if (hand.pinch_aperture_mm <= span_mm) {
        s.aperture_mm = hand.pinch_aperture_mm;
    }
    s.hand_length_mm = hand_length_mm(hand);
    s.extension = hand.finger_extension;
    bool bends_known = false;
    for (const Finger f : {Finger::index, Finger::middle, Finger::ring, Finger::little}) {
        const Flexion flexion = flexion_of(hand, f);
        s.flexion[static_cast<std::size_t>(f)] = flexion;
        bends_known = bends_known || flexion.whole_deg > kFlexionUnknown;
    }
    // A camera that finds few fingers on a hand that is no fist does not see that hand well.
    if (bends_known || (!s.from_joints && (hand.extended_fingers >= kOpenFingers ||
                                           hand.grab_value >= kHalfClosed))) {
        s.grab = std::clamp(hand.grab_value, 0.0F, 1.0F);
    }
    s.thumb_to_fingers_mm = thumb_to_fingers(hand, thumb);
    if (thumb.valid && thumb.position_mm.allFinite()) {
        const TrackedPoint& root = hand.joint(Joint::thumb_proximal);
        const bool joints = root.valid && root.position_mm.allFinite();
        const Vec3f along = thumb.position_mm - (joints ? root.position_mm : hand.palm_mm);
        s.thumb_along =
            along.norm() >= kShortestMm ? Vec3f(along.normalized()) : Vec3f(Vec3f::Zero());
    }
    if (thumb.valid && middle.valid && thumb.position_mm.allFinite() &&
        middle.position_mm.allFinite()) {
        s.thumb_to_middle_mm = (thumb.position_mm - middle.position_mm).norm();
    }
    s.distal = distal_of(hand);
    float farthest_mm = 0.0F;
    for (const TrackedPoint& tip : hand.fingertips) {
        if (!tip.valid || !tip.position_mm.allFinite()) {
            continue;
        }
        const float mm = (tip.position_mm - hand.palm_mm).norm();
        if (mm > farthest_mm) {
            farthest_mm = mm;
            s.far_tip_mm = tip.position_mm;
            s.far_tip_known = true;
        }
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
    const bool believed = believable(sample);
    newest_ = count_ == 0 ? 0 : (newest_ + 1) % kCapacity;
    count_ = std::min(count_ + 1, kCapacity);
    samples_[newest_] = sample;
    if (!believed) {
        samples_[newest_].aperture_mm = -1.0F;
    }
    return true;
}

bool MotionHistory::believable(const MotionSample& sample) const noexcept {
    for (std::size_t i = 0; i < count_; ++i) {
        const MotionSample& before = at(i);
        if (before.aperture_mm >= 0.0F) {
            const auto since_s = static_cast<float>(to_seconds(sample.stamp - before.stamp));
            return std::abs(sample.aperture_mm - before.aperture_mm) <=
                   kApertureNoiseMm + kFastestMmps * since_s;
        }
    }
    return true;
}

Vec3f MotionHistory::velocity(Duration window, std::size_t back) const noexcept {
    if (back + 1 >= count_) {
        return Vec3f::Zero();
    }
    const Stamp end = at(back).stamp;
    LineFit fit(at(back).palm_mm);
    for (std::size_t i = back; i < count_; ++i) {
        const MotionSample& s = at(i);
        if (i >= back + 2 && end - s.stamp > window) {
            break;
        }
        fit.add(-to_seconds(end - s.stamp), s.palm_mm);
    }
    return fit.slope();
}

Vec3f MotionHistory::tip_velocity(Duration window) const noexcept {
    constexpr int kEnough = 3;
    if (count_ == 0) {
        return Vec3f::Zero();
    }
    LineFit fit(newest().far_tip_mm);
    for (std::size_t i = 0; i < count_within(window); ++i) {
        if (at(i).far_tip_known) {
            fit.add(-to_seconds(newest().stamp - at(i).stamp), at(i).far_tip_mm);
        }
    }
    return fit.count() >= kEnough ? fit.slope() : velocity(window);
}

double MotionHistory::recent(float MotionSample::*what) const noexcept {
    double sum = 0.0;
    int n = 0;
    const std::size_t newest = count_within(kRecent);
    for (std::size_t i = 0; i < newest; ++i) {
        if (at(i).*what >= 0.0F) {
            sum += static_cast<double>(at(i).*what);
            ++n;
        }
    }
    return n > 0 ? sum / n : -1.0;
}

double MotionHistory::smear_mm(Duration window, std::size_t back) const noexcept {
    const MotionSample& sample = at(back);
    if (sample.from_joints) {
        return 0.0;
    }
    const Duration span = sample.span > Duration::zero() ? sample.span : kUsualSpan;
    return static_cast<double>(velocity(std::max(span, window), back).norm()) * to_seconds(span);
}

Duration MotionHistory::unseen() const noexcept {
    return count_ > 1 ? std::min((newest().stamp - at(1).stamp) / 2, kUnseenMost)
                      : Duration::zero();
}

std::size_t MotionHistory::count_within(Duration age) const noexcept {
    std::size_t n = 0;
    while (n < count_ && newest().stamp - at(n).stamp <= age) {
        ++n;
    }
    return n;
}

}  // namespace xtrack::recognise
