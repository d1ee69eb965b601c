// SPDX-License-Identifier: Apache-2.0
#include "gestures/recognise/body.hpp"

#include <algorithm>
#include <cmath>

#include "gestures/track/hand_from_joints.hpp"

namespace xtrack::recognise {

namespace {

// Wrist to middle fingertip of an adult, of a large one, and from that adult's palm to the elbow.
// Other bodies are taken in proportion.
constexpr float kAdultHandMm = 187.0F;
constexpr float kLargeHandMm = 220.0F;
constexpr float kPalmToElbowMm = 330.0F;
// A palm that is turned farther off shows too little of its width.
constexpr float kFacing = 0.7F;
// Of the mean: as long as it takes to forget a hand whose id another got; and from when on it is
// one.
constexpr double kForgetS = 2.0;
constexpr double kEnoughS = 0.1;
constexpr double kLongestStepS = 0.1;

constexpr float kSureOfSide = 0.8F;
// The longer over the shorter hand, of one person: of bones that a tracker of joints measures (up
// to 1.06 in recordings of both hands), and of palms, which look up to 7 % too narrow in motion.
// Beyond the last they are of two people.
constexpr float kAlikeBones = 1.08F;
constexpr float kAlikePalms = 1.15F;
constexpr float kUnlike = 1.3F;
// Who joins is well within the limits, aside as well as in height and depth, and has elbows no
// nearer to each other than an adult's by so much.
constexpr double kWithinAside = 0.8;
constexpr double kWithinLevel = 0.6;
constexpr float kElbowsApartMm = 187.0F;
// Who has joined may stretch.
constexpr double kStretch = 1.25;

float ratio(float a, float b) { return std::max(a, b) / std::min(a, b); }

}  // namespace

void HandSize::add(const Hand& hand, Stamp now) noexcept {
    float length_mm = 0.0F;
    if (hand.articulated) {
        length_mm = hand_length_mm(hand);
    } else if (hand.palm_radius_mm > 0.0F) {
        // A tilted palm's circle is narrower. The camera is near the origin, and what that is wrong
        // by is the same for two hands.
        const float facing = -hand.palm_normal.dot(hand.palm_mm.normalized());
        if (facing >= kFacing) {
            length_mm = hand.palm_radius_mm / (kPalmRadiusOfLength * std::sqrt(facing));
        }
    }
    const double step_s = std::clamp(to_seconds(now - last_), 0.0, kLongestStepS);
    last_ = now;
    if (!(length_mm > 0.0F) || !std::isfinite(length_mm) || step_s == 0.0) {
        return;
    }
    seconds_ = std::min(seconds_ + step_s, kForgetS);
    mean_mm_ += step_s / seconds_ * (static_cast<double>(length_mm) - mean_mm_);
}

float HandSize::length_mm() const noexcept {
    return seconds_ > kEnoughS ? static_cast<float>(mean_mm_) : 0.0F;
}

Arm arm_of(const Hand& hand, float length_mm) noexcept {
    Arm arm;
    arm.palm_mm = hand.palm_mm;
    // Of joints it is the wrist's direction, which bends.
    arm.forearm = hand.articulated ? Vec3f(Vec3f::Zero()) : hand.forearm;
    arm.guess = hand.chirality;
    arm.side = hand.chirality_confidence >= kSureOfSide ? hand.chirality : Chirality::unknown;
    arm.length_mm = length_mm;
    arm.bones = hand.articulated;
    return arm;
}

SameBody same_body(const GestureSettings& s, const Arm& a, const Arm& b, bool together) noexcept {
    const bool sided = a.side != Chirality::unknown || b.side != Chirality::unknown;
    if (sided && a.side == b.side) {
        return SameBody::same_side;
    }
    const bool sized = a.length_mm > 0.0F && b.length_mm > 0.0F;
    const float unlike = sized ? ratio(a.length_mm, b.length_mm) : 1.0F;
    if (unlike > kUnlike) {
        return SameBody::no;
    }
    const bool arms = !a.forearm.isZero() && !b.forearm.isZero();
    if (!arms && !(a.side != Chirality::unknown && b.side != Chirality::unknown)) {
        return SameBody::unsure;
    }
    // From the left to the right one.
    const float mean_mm = 0.5F * (a.length_mm + b.length_mm);
    const float arm_mm = kPalmToElbowMm * (sized ? mean_mm / kAdultHandMm : 1.0F);
    const float turn = a.side == Chirality::right || b.side == Chirality::left ? -1.0F : 1.0F;
    const Vec3f palms = turn * (b.palm_mm - a.palm_mm);
    const Vec3f ends = arms ? Vec3f(palms + turn * arm_mm * (b.forearm - a.forearm)) : palms;
    // The limits are an adult's; who knows no size allows for the largest.
    const double body = static_cast<double>((sized ? mean_mm : kLargeHandMm) / kAdultHandMm);
    const auto share = [&](float way_mm, double limit_mm) {
        return static_cast<double>(std::abs(way_mm)) / (body * limit_mm);
    };
    const double aside = share(ends.x(), s.body_width_mm);
    const double level =
        std::max(share(ends.y(), s.body_height_mm), share(ends.z(), s.body_depth_mm));
    const double out = std::max(aside, level);
    // Arms may cross, elbows do not.
    if (arms && (out > (together ? kStretch : 1.0) || (sided && ends.x() < 0.0F))) {
        return SameBody::no;
    }
    if (!arms && out > 1.0) {
        return SameBody::far;
    }
    const bool crossed = sided && palms.x() < 0.0F;
    const bool narrow = arms && static_cast<double>(std::abs(ends.x())) <
                                    body * static_cast<double>(kElbowsApartMm);
    const bool alike = unlike <= (a.bones && b.bones ? kAlikeBones : kAlikePalms);
    const bool within = aside <= kWithinAside && level <= kWithinLevel;
    return alike && within && !crossed && !narrow ? SameBody::yes : SameBody::unsure;
}

bool same_build(const Arm& was, const Arm& is) noexcept {
    const bool other_side =
        was.side != Chirality::unknown && is.guess != Chirality::unknown && was.side != is.guess;
    const bool other_size =
        was.length_mm > 0.0F && is.length_mm > 0.0F && ratio(was.length_mm, is.length_mm) > kUnlike;
    return !other_side && !other_size;
}

bool same_hand(const GestureSettings& s, const Arm& was, const Arm& is) noexcept {
    const auto near = [&](const Vec3f& a, const Vec3f& b) {
        return static_cast<double>((a - b).norm()) <= s.engage_return_mm;
    };
    if (!same_build(was, is) || !near(was.palm_mm, is.palm_mm)) {
        return false;
    }
    return was.forearm.isZero() || is.forearm.isZero() ||
           near(was.palm_mm + kPalmToElbowMm * was.forearm,
                is.palm_mm + kPalmToElbowMm * is.forearm);
}

}  // namespace xtrack::recognise
