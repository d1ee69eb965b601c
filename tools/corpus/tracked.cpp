// SPDX-License-Identifier: Apache-2.0
#include "tools/corpus/tracked.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "gestures/track/hand_track.hpp"

namespace xtrack::tools::corpus {

namespace {

constexpr double kMovesMmps = 100.0;
// The same id within these, as the HandTracker promises.
constexpr double kReacquireS = 0.3;
constexpr float kReacquireMm = 100.0F;
// A hand must be before the body by the first, and is not doubted from the second on.
constexpr double kBeforeBodyMm = 60.0;
constexpr double kClearOfBodyMm = 120.0;
constexpr double kNearestMm = 150.0;
constexpr double kFarthestMm = 1500.0;
constexpr double kConfidenceSmoothS = 0.1;
constexpr double kLongLossesPerS = 1.0 / 60.0;
constexpr double kVelocityWindowS = 0.105;
constexpr double kLongestWindowS = 0.21;

double normal(sim::Random& random) {
    // Box, Muller 1958.
    const double radius = std::sqrt(-2.0 * std::log(1.0 - random.unit()));
    return radius * std::cos(2.0 * std::numbers::pi * random.unit());
}

Vec3f scaled(const auto& drift, double x, double y, double z) {
    return {static_cast<float>(drift[0].value * x), static_cast<float>(drift[1].value * y),
            static_cast<float>(drift[2].value * z)};
}

}  // namespace

void Tracked::Drift::step(sim::Random& random, double dt_s, double tau_s) {
    const double keep = std::exp(-dt_s / tau_s);
    value = keep * value + std::sqrt(1.0 - keep * keep) * normal(random);
}

void Tracked::Mood::step(sim::Random& random, double dt_s, double tau_s) {
    const double chance = random.unit();
    const double fresh = random.unit();
    if (chance < 1.0 - std::exp(-dt_s / tau_s)) {
        value = fresh;
    }
}

Tracked::Tracked(View view, double frame_hz, std::uint64_t seed,
                 std::span<const Movement* const> hands)
    : view_(view),
      noise_(noise_of(view)),
      frame_s_(1.0 / frame_hz),
      random_(sim::mix(seed, 31U)),
      follows_(hands.size()) {
    for (std::size_t i = 0; i < hands.size(); ++i) {
        follows_[i].movement = hands[i];
        step(follows_[i], 1e9);  // as after a long time
    }
    frame_.coordinates = CoordinateFrame::interaction;
    if (view != View::joints) {
        // What a depth image is measured over: three patterns, or two of a slower camera that are
        // each held for two frames.
        frame_.span = Duration{std::llround((view == View::fine ? 2.0 : 3.0) * frame_s_ * 1e9)};
    }
}

void Tracked::step(Follow& f, double dt_s) {
    const double quick = noise_.quick_s;
    const double slow = noise_.slow_s;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        f.palm[axis].step(random_, dt_s, quick);
        f.normal[axis].step(random_, dt_s, slow);
    }
    const std::size_t points = view_ == View::joints ? kJointCount : kFingerCount;
    for (std::size_t p = 0; p < points; ++p) {
        for (Drift& axis : f.points[p]) {
            axis.step(random_, dt_s, quick);
        }
    }
    for (std::size_t finger = 0; finger < kFingerCount; ++finger) {
        f.extension[finger].step(random_, dt_s, slow);
        f.tip_mood[finger].step(random_, dt_s, slow);
        f.finger_mood[finger].step(random_, dt_s, slow);
    }
    f.aperture.step(random_, dt_s, quick);
    f.grab.step(random_, dt_s, slow);
    f.wild.step(random_, dt_s, slow);
    f.known.step(random_, dt_s, slow);
    f.side.step(random_, dt_s, slow);
    f.outlier.step(random_, dt_s, quick);
}

const HandFrame& Tracked::at(double t_s) {
    const double dt_s = last_s_ < 0.0 ? frame_s_ : t_s - last_s_;
    last_s_ = t_s;
    frame_.stamp = Stamp{std::llround(t_s * 1e9)};
    frame_.count = 0;
    for (Follow& f : follows_) {
        step(f, dt_s);
        if (frame_.count < kMaxHands) {
            Hand& hand = frame_.hands[frame_.count];
            hand = {};
            frame_.count += see(f, t_s, dt_s, hand) ? 1 : 0;
        }
    }
    if (view_ == View::joints) {
        from_joints_.complete(frame_);
    }
    pointer_.update(frame_);
    return frame_;
}

/// How far a palm is before its owner's body; a face is 100 mm before the chest.
double Tracked::clearance_mm(const Follow& f, const SeenHand& seen) const {
    const Person& p = f.movement->person();
    const double scale = p.scale();
    const double x = seen.palm_mm.x() - p.to_side_mm;
    const double shoulders = -35.0 - p.tall_mm;
    if (std::hypot(x, seen.palm_mm.y() - (shoulders - 200.0 * scale)) < 115.0 * scale) {
        return p.chest_mm - 100.0 * scale - seen.palm_mm.z();
    }
    const bool before_torso = std::abs(x) < 230.0 * scale && seen.palm_mm.y() > shoulders - 30.0;
    return before_torso ? p.chest_mm - seen.palm_mm.z() : INFINITY;
}

bool Tracked::see(Follow& f, double t_s, double dt_s, Hand& hand) {
    const sim::HandPose pose = f.movement->at(t_s);
    // Most hands that are out of sight are so by far: they need no look.
    const SeenHand seen =
        look_at(pose, f.movement->hand(), f.movement->person().scale(), corpus_camera());
    const double clearance = view_ == View::joints ? INFINITY : clearance_mm(f, seen);
    bool visible = seen.in_view && seen.palm_mm.z() > kNearestMm &&
                   seen.palm_mm.z() < kFarthestMm && clearance > kBeforeBodyMm;
    const Vec3f before = f.movement->at(t_s - 0.03).palm_mm;
    const bool moves = (pose.palm_mm - before).norm() > kMovesMmps * 0.03;
    if (visible && t_s >= f.lost_until_s) {
        // Lost so often and so long that it is not seen for its share of the time.
        const double share = noise_.lost_share[moves];
        const double lost_s = noise_.lost_ms * 1e-3;
        if (random_.unit() < share / (1.0 - share) * dt_s / lost_s) {
            f.lost_until_s = t_s - lost_s * std::log(1.0 - random_.unit());
        }
        // And now and then for longer, which no simulated rig has shown, but every real one does.
        if (random_.unit() < kLongLossesPerS * dt_s) {
            f.lost_until_s = t_s + random_.between(0.1, 0.4);
        }
    }
    visible = visible && t_s >= f.lost_until_s;
    if (!visible) {
        return false;
    }
    const bool same =
        t_s - f.last_seen_s <= kReacquireS && (seen.palm_mm - f.last_mm).norm() <= kReacquireMm;
    if (f.id == 0 || !same) {
        owners_.push_back(static_cast<std::size_t>(&f - follows_.data()));
        f.id = static_cast<int>(owners_.size());
        f.first_seen_s = t_s;
        f.path = 0;
        f.confidence = 0.0;
        f.taken_for_other = random_.unit() < noise_.chirality_wrong;
    } else if (t_s - f.last_seen_s > 1.5 * frame_s_ + 0.15) {
        f.path = 0;  // a velocity across a gap would be none
    }
    f.last_seen_s = t_s;
    f.last_mm = seen.palm_mm;

    hand.id = f.id;
    hand.touches_border = seen.touches_border && view_ != View::joints;
    const double wanted =
        noise_.confidence *
        std::clamp((clearance - kBeforeBodyMm) / (kClearOfBodyMm - kBeforeBodyMm), 0.0, 1.0);
    f.confidence += (1.0 - std::exp(-dt_s / kConfidenceSmoothS)) * (wanted - f.confidence);
    if (t_s == f.first_seen_s) {
        f.confidence = wanted;
    }
    hand.confidence = static_cast<float>(f.confidence);
    name_side(f, t_s, hand);
    if (view_ == View::joints) {
        see_joints(f, seen, moves, hand);
    } else {
        see_depth(f, seen, moves, hand);
        measure_velocity(f, frame_.stamp, hand);
    }
    return true;
}

/// Left or right: not at once, mostly right, and sometimes not at all.
void Tracked::name_side(Follow& f, double t_s, Hand& hand) {
    constexpr double kUnsureS = 0.15;
    if (t_s - f.first_seen_s < kUnsureS || f.side.value < noise_.chirality_unknown) {
        return;
    }
    // Who is taken for the other hand at first is seen to be none within a second or so.
    constexpr double kRightedPerS = 1.0;
    if (f.taken_for_other && random_.unit() < kRightedPerS * frame_s_) {
        f.taken_for_other = false;
    }
    const bool right = (f.movement->hand() == SimHand::right) != f.taken_for_other;
    hand.chirality = right ? Chirality::right : Chirality::left;
    hand.chirality_confidence =
        static_cast<float>(std::clamp(0.6 + (t_s - f.first_seen_s) * 0.5, 0.6, 0.95));
}

void Tracked::see_depth(Follow& f, const SeenHand& seen, bool moves, Hand& hand) {
    const auto to_user = [](const Vec3f& p) { return Vec3f(-p.x(), -p.y(), p.z()); };
    const Noise& n = noise_;
    Vec3f off =
        scaled(f.palm, n.palm_aside_mm[moves], n.palm_aside_mm[moves], n.palm_deep_mm[moves]);
    if (f.outlier.value < n.outlier_share[moves]) {
        // Toward the arm: a wrist is taken for the palm.
        const Vec3f to_arm = (seen.joints_mm[1] - seen.joints_mm[0]).normalized();
        const double much = 1.0 - f.outlier.value / n.outlier_share[moves];
        off += to_arm * static_cast<float>(n.outlier_mm * (0.5 + much));
    }
    hand.palm_mm = to_user(seen.palm_mm + off);
    hand.palm_radius_mm = seen.palm_radius_mm;
    const Vec3f tilt = scaled(f.normal, n.normal_rad, n.normal_rad, n.normal_rad);
    hand.palm_normal = to_user(Vec3f(seen.palm_normal + tilt)).normalized();
    hand.forearm = to_user(Vec3f(seen.forearm + tilt)).normalized();
    hand.extended_fingers = 0;
    for (std::size_t i = 0; i < kFingerCount; ++i) {
        const double share =
            seen.tip_seen[i] || seen.tip_gap_mm[i] <= kTipGaps_mm[1]
                ? n.tip_valid[bin_of(seen.tip_gap_mm[i] / f.movement->person().scale(),
                                     kTipGaps_mm)]
                : n.hidden_tip_valid;
        const bool valid = f.tip_mood[i].value < share;
        double extension = seen.extension[i];
        if (f.finger_mood[i].value < n.finger_lost[moves]) {
            extension = 0.0;
        } else if (extension > 0.0 && extension < 1.0) {
            extension += n.bent_off + n.bent * f.extension[i].value;
        }
        hand.finger_extension[i] = static_cast<float>(std::clamp(extension, 0.0, 1.0));
        constexpr float kExtended = 0.35F;
        hand.extended_fingers += hand.finger_extension[i] >= kExtended ? 1 : 0;
        if (valid) {
            const double jitter = n.tip_mm[moves];
            hand.fingertips[i] = {
                to_user(seen.tips_mm[i] + scaled(f.points[i], jitter, jitter, jitter)), true};
        }
    }
    hand.grab_value = std::clamp(seen.grab + static_cast<float>(n.grab * f.grab.value), 0.0F, 1.0F);
    const std::size_t bin = bin_of(seen.aperture_mm, kApertures_mm);
    if (f.known.value < n.aperture_known[bin]) {
        const double aperture =
            seen.aperture_mm + n.aperture_off_mm[bin] + n.aperture_mm[bin] * f.aperture.value;
        hand.pinch_aperture_mm = static_cast<float>(std::max(0.0, aperture));
        constexpr float kOpenMm = 60.0F;
        constexpr float kClosedMm = 15.0F;
        hand.pinch_value =
            std::clamp((kOpenMm - hand.pinch_aperture_mm) / (kOpenMm - kClosedMm), 0.0F, 1.0F);
    }
}

void Tracked::see_joints(Follow& f, const SeenHand& seen, bool moves, Hand& hand) {
    // All joints go astray together, and each a little by itself.
    const double common = noise_.palm_aside_mm[moves];
    const double own = noise_.tip_mm[moves];
    const Vec3f off = scaled(f.palm, common, common, noise_.palm_deep_mm[moves]);
    for (std::size_t j = 0; j < kJointCount; ++j) {
        const Vec3f p = seen.joints_mm[j] + off + scaled(f.points[j], own, own, own);
        hand.joints[j] = {Vec3f(-p.x(), -p.y(), p.z()), true};
    }
}

void Tracked::measure_velocity(Follow& f, Stamp stamp, Hand& hand) {
    const std::size_t kept = std::min(f.path, f.stamps.size() - 1);
    std::copy_backward(f.stamps.begin(), f.stamps.begin() + static_cast<std::ptrdiff_t>(kept),
                       f.stamps.begin() + static_cast<std::ptrdiff_t>(kept) + 1);
    std::copy_backward(f.path_mm.begin(), f.path_mm.begin() + static_cast<std::ptrdiff_t>(kept),
                       f.path_mm.begin() + static_cast<std::ptrdiff_t>(kept) + 1);
    f.stamps[0] = stamp;
    f.path_mm[0] = hand.palm_mm;
    f.path = kept + 1;
    std::size_t used = 0;
    while (used < f.path) {
        const double age = to_seconds(stamp - f.stamps[used]);
        if (age > kVelocityWindowS && (used >= 3 || age > kLongestWindowS)) {
            break;
        }
        ++used;
    }
    hand.palm_velocity_mmps = track::line_slope({f.stamps.data(), used}, {f.path_mm.data(), used});
}

}  // namespace xtrack::tools::corpus
