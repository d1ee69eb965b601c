// SPDX-License-Identifier: Apache-2.0
#include "gestures/track/hand_track.hpp"

#include <algorithm>
#include <cmath>

#include "gestures/segment/ramp.hpp"
#include "gestures/track/hand_joints.hpp"

namespace xtrack::track {

namespace {

/// A palm is predicted along its velocity for at most this long, s: hands turn.
constexpr double kPredictMaxS = 0.1;
/// A line needs this many samples; slow cameras get a longer window for them, but no longer than:
constexpr std::size_t kVelocitySamplesMin = 3;
constexpr Duration kVelocityWindowMax = std::chrono::milliseconds{210};
/// A gap longer than this breaks the path: a velocity across it would be no velocity.
constexpr Duration kPathGapMax = std::chrono::milliseconds{150};

// Extension: a tip this many palm radii from the centre is folded, that many straight.
constexpr float kFoldedRadii = 1.3F;
constexpr float kStraightRadii = 2.4F;
constexpr float kThumbFoldedRadii = 1.1F;
constexpr float kThumbStraightRadii = 1.8F;
constexpr float kExtended = 0.35F;
/// Surface of the fingers in squared palm radii: fist, and open hand.
constexpr float kFistArea = 0.25F;
constexpr float kOpenArea = 1.9F;
// Pinch value: 0 at this aperture, 1 at that, mm.
constexpr float kPinchOpenMm = 60.0F;
constexpr float kPinchClosedMm = 15.0F;

// Chirality. Evidence is added a second of clear sight, and forgotten at the rate of the limit.
constexpr float kSidePerSecond = 12.0F;
constexpr float kSideLimit = 3.5F;
constexpr float kPalmPerSecond = 3.0F;
constexpr float kPalmLimit = 2.0F;
/// Fingers bend toward the palm: tips this high above its plane show a palm, this deep a back, mm.
constexpr float kCurlMm = 25.0F;
/// A hand held up to a screen shows its palm more often than its back.
constexpr float kPalmPrior = 1.2F;
/// The right hand's forearm comes from the right more often than not.
constexpr float kEntryWeight = 0.4F;
constexpr float kChiralityMax = 0.95F;
constexpr float kChiralityMin = 0.55F;
/// Time constants of slow properties, s.
constexpr float kArmSmoothS = 0.1F;
constexpr float kConfidenceSmoothS = 0.1F;

float logistic(float x) { return 1.0F / (1.0F + std::exp(-x)); }

}  // namespace

Vec3f line_slope(std::span<const Stamp> stamps, std::span<const Vec3f> points) {
    const std::size_t n = stamps.size();
    if (n < 2) {
        return Vec3f::Zero();
    }
    double mean_t = 0.0;
    Vec3d mean_p = Vec3d::Zero();
    for (std::size_t k = 0; k < n; ++k) {
        mean_t += to_seconds(stamps[k] - stamps[0]);
        mean_p += points[k].cast<double>();
    }
    mean_t /= static_cast<double>(n);
    mean_p /= static_cast<double>(n);
    double tt = 0.0;
    Vec3d tp = Vec3d::Zero();
    for (std::size_t k = 0; k < n; ++k) {
        const double t = to_seconds(stamps[k] - stamps[0]) - mean_t;
        tt += t * t;
        tp += t * (points[k].cast<double>() - mean_p);
    }
    return tt > 0.0 ? Vec3f((tp / tt).cast<float>()) : Vec3f(Vec3f::Zero());
}

void HandTrack::begin(int id) {
    *this = {};
    id_ = id;
    palm_log_odds_ = kPalmPrior;
}

Vec3f HandTrack::predict(Stamp at) const {
    if (samples_ == 0) {
        return Vec3f::Zero();
    }
    const double t = std::clamp(to_seconds(at - last_seen_), 0.0, kPredictMaxS);
    return history_[newest_].palm_mm + static_cast<float>(t) * velocity_mmps_;
}

int HandTrack::thumb_side() const noexcept {
    constexpr float kKnown = 0.8F;
    return side_log_odds_ > kKnown ? 1 : (side_log_odds_ < -kKnown ? -1 : 0);
}

Vec3f HandTrack::fit_velocity(Duration window) const {
    std::array<Stamp, kHistory> stamps;
    std::array<Vec3f, kHistory> points;
    std::size_t n = 0;
    for (std::size_t k = 0; k < samples_; ++k) {
        const Sample& s = history_[(newest_ + kHistory - k) % kHistory];
        const Duration age = last_seen_ - s.stamp;
        // Half a frame's tolerance: 100 ms of a 30 Hz camera are four frames, not three.
        const bool in_window = age <= window + window / 20;
        if (!in_window && (n >= kVelocitySamplesMin || age > kVelocityWindowMax)) {
            break;
        }
        stamps[n] = s.stamp;
        points[n] = s.palm_mm;
        ++n;
    }
    return line_slope({stamps.data(), n}, {points.data(), n});
}

void HandTrack::update(Stamp stamp, const HandRegion& region, const Vec3f& normal,
                       FingerReading& fingers, const TrackerSettings& settings, Hand& hand) {
    const bool fresh = samples_ == 0;
    const float seconds = fresh ? 0.0F : static_cast<float>(to_seconds(stamp - last_seen_));
    if (!fresh && stamp - last_seen_ > kPathGapMax) {
        samples_ = 0;
    }
    newest_ = (newest_ + 1) % kHistory;
    history_[newest_] = {stamp, region.palm_mm};
    samples_ = std::min(samples_ + 1, kHistory);
    last_seen_ = stamp;
    velocity_mmps_ = fit_velocity(settings.velocity_window);

    const float arm_share = fresh ? 1.0F : 1.0F - std::exp(-seconds / kArmSmoothS);
    arm_direction_ = (arm_direction_ + arm_share * (region.arm_direction - arm_direction_));
    if (arm_direction_.norm() > 0.0F) {
        arm_direction_.normalize();
    }
    palm_radius_mm_ = region.palm_radius_mm;
    const float confidence_share = fresh ? 1.0F : 1.0F - std::exp(-seconds / kConfidenceSmoothS);
    confidence_ += confidence_share * (region.score - confidence_);

    hand = {};
    hand.id = id_;
    hand.confidence = confidence_;
    hand.touches_border = region.touches_border;
    hand.palm_mm = region.palm_mm;
    hand.palm_radius_mm = region.palm_radius_mm;
    hand.palm_normal = normal;
    hand.palm_velocity_mmps = velocity_mmps_;
    hand.forearm = arm_direction_;
    const int side = thumb_side();
    weigh_chirality(region, fingers, seconds, hand);
    finger_tracks_.update(stamp, region, side, fingers);
    fill_fingers(region, fingers, hand);
    fill_pinch(hand);
    infer_joints(region, side, hand);
}

void HandTrack::fill_fingers(const HandRegion& region, const FingerReading& fingers, Hand& hand) {
    hand.finger_extension.fill(0.0F);
    hand.extended_fingers = 0;
    const float r = region.palm_radius_mm;
    for (std::size_t f = 0; f < kFingerCount; ++f) {
        const FingerState& finger = finger_tracks_.finger(static_cast<Finger>(f));
        if (!finger.known) {
            continue;
        }
        // A finger that has no tip of its own in this frame lies beside another: the outline still
        // reaches out where it was, or it is folded.
        const float reach =
            finger.fresh ? finger.tip_mm.norm()
                         : std::min(finger.tip_mm.norm(), fingers.reach_toward(finger.tip_mm));
        const float extension = f == static_cast<std::size_t>(Finger::thumb)
                                    ? ramp(reach / r, kThumbFoldedRadii, kThumbStraightRadii)
                                    : ramp(reach / r, kFoldedRadii, kStraightRadii);
        hand.finger_extension[f] = extension;
        hand.extended_fingers += extension >= kExtended ? 1 : 0;
        if (finger.fresh) {
            hand.fingertips[f] = {region.palm_mm + finger.tip_mm, true};
        }
    }
    hand.grab_value = 1.0F - ramp(fingers.finger_area_mm2 / (r * r), kFistArea, kOpenArea);
}

void HandTrack::fill_pinch(Hand& hand) const {
    hand.pinch_aperture_mm = finger_tracks_.aperture_mm();
    if (hand.pinch_aperture_mm >= 0.0F) {
        hand.pinch_value = ramp(-hand.pinch_aperture_mm, -kPinchOpenMm, -kPinchClosedMm);
    }
}

void HandTrack::weigh_chirality(const HandRegion& region, const FingerReading& fingers,
                                float seconds, Hand& hand) {
    // A first frame counts for what it shows, as a thirtieth of a second.
    constexpr float kFirstFrameS = 1.0F / 30.0F;
    constexpr float kStepMaxS = 0.1F;
    const float t = seconds > 0.0F ? std::min(seconds, kStepMaxS) : kFirstFrameS;
    // Thumb and index together show no thumb: what then sticks out to a side is none.
    if (fingers.thumb_side != 0 && !finger_tracks_.touching() && !fingers.ring) {
        const float turn = static_cast<float>(fingers.thumb_side) * fingers.thumb_score;
        side_log_odds_ =
            std::clamp(side_log_odds_ + kSidePerSecond * t * turn, -kSideLimit, kSideLimit);
    }
    if (fingers.count >= 2) {
        palm_log_odds_ =
            std::clamp(palm_log_odds_ + kPalmPerSecond * t * std::tanh(fingers.curl_mm / kCurlMm),
                       -kPalmLimit, kPalmLimit);
    }
    // A camera that faces the user sees their right on its left: -x.
    if (region.arm_seen) {
        const float wanted = -kEntryWeight * region.arm_direction.x();
        entry_log_odds_ += std::min(1.0F, 3.0F * t) * (wanted - entry_log_odds_);
    }
    const float side = logistic(side_log_odds_);
    const float palm = logistic(palm_log_odds_);
    const float right = side * palm + (1.0F - side) * (1.0F - palm);
    const float p = logistic(std::log(right / (1.0F - right)) + entry_log_odds_);
    const float sure = std::min(kChiralityMax, std::max(p, 1.0F - p));
    if (sure < kChiralityMin) {
        hand.chirality = Chirality::unknown;
        hand.chirality_confidence = 0.0F;
        return;
    }
    hand.chirality = p > 0.5F ? Chirality::right : Chirality::left;
    hand.chirality_confidence = sure;
}

}  // namespace xtrack::track
