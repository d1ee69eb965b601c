// SPDX-License-Identifier: Apache-2.0
#include "gestures/segment/palm_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "gestures/segment/palm_score.hpp"
#include "gestures/segment/ramp.hpp"

namespace xtrack::segment {

namespace {

// Proportions of a hand in palm radii, from anthropometry (hand length 190 mm, breadth 85 mm, so a
// palm radius of 42 mm): the middle fingertip is 2.9 radii from the palm's centre.
constexpr float kReachRadii = 3.7F;
constexpr float kReachFloorMm = 105.0F;
constexpr float kReachCeilingMm = 175.0F;
/// A palm's centre is at most this far from the tip of its hand, mm.
constexpr float kTipToPalmMm = 135.0F;
/// A candidate farther than this loses so much of its weight a mm: a forearm is as thick as a fist.
constexpr float kTipToPalmFadeMm = 105.0F;
constexpr float kTipToPalmLoss = 0.5F / 60.0F;
/// A finger's middle is at most this far from it, mm.
constexpr float kFingerToPalmMm = 90.0F;
/// The thickest place that is so near to a finger may be on the way to the palm's centre; from it,
/// so many steps of so many of its radii find that.
constexpr int kStepsToPalm = 2;
constexpr float kStepRadii = 0.6F;
/// Hands before one body are one part with it at times; so many may show their fingers.
constexpr int kFingersOfHands = 2;
/// A finger is thinner than kFingerRadiusMm, thicker by the ramp is none, mm.
constexpr float kFingerRampMm = 5.0F;
/// Nothing closer to the palm's centre says where the arm is, in palm radii.
constexpr float kRingRadii = 1.25F;
/// Everything farther than a fingertip is arm, and says so with this weight.
constexpr float kArmWeight = 3.0F;
constexpr float kPriorWeight = 0.35F;
constexpr float kFingerWeight = 0.8F;
/// The wrist is the narrowest place between these, in palm radii.
constexpr float kWristFromRadii = 1.15F;
constexpr float kWristToRadii = 1.9F;
constexpr float kWristDefaultRadii = 1.5F;
constexpr int kWristBins = 9;
/// An expected palm explains a candidate this near, mm.
constexpr float kPriorReachMm = 90.0F;

}  // namespace

void PalmSearch::create(const Grid& grid, const TrackerSettings& settings) {
    radius_min_mm_ = static_cast<float>(settings.palm_radius_min_mm);
    radius_max_mm_ = static_cast<float>(settings.palm_radius_max_mm);
    ahead_mm_ = static_cast<float>(settings.ahead_of_body_mm);
    limb_.create(grid, kEdgeOnShare * radius_min_mm_);
}

/// Where the forearm is: thick surface outside the palm's circle pulls, fingers push.
void PalmSearch::find_arm(const Part& part, std::span<const PalmPrior> priors,
                          PalmCandidate& c) const {
    const auto of_other_hand = [&](const Vec3f& p_mm, float squared) {
        for (std::size_t m = 0; c.prior >= 0 && m < priors.size(); ++m) {
            if (static_cast<int>(m) != c.prior &&
                (p_mm - priors[m].palm_mm).squaredNorm() < squared) {
                return true;
            }
        }
        return false;
    };
    const float r = c.radius_mm;
    const float ring = kRingRadii * r;
    const float reach = reach_limit_mm(r);
    Vec3f thick = Vec3f::Zero();
    Vec3f thin = Vec3f::Zero();
    float arm_mass = 0.0F;
    float mass = 0.0F;
    for (const Limb::Sample& s : limb_.samples()) {
        mass += 1.0F;
        const Vec3f d = s.p_mm - c.centre_mm;
        const float n = d.norm();
        if (n < ring || n > 2.0F * reach || of_other_hand(s.p_mm, n * n)) {
            continue;
        }
        const Vec3f u = d / n;
        if (n > reach) {
            thick += kArmWeight * u;
            arm_mass += 1.0F;
            continue;
        }
        const float t = ramp(s.radius_mm, kFingerRadiusMm, kFingerRadiusMm + kFingerRampMm);
        thick += t * u;
        thin += (1.0F - t) * u;
    }
    Vec3f a = (thick - kFingerWeight * thin) / std::max(1.0F, mass);
    if (part.root_pixels > 0) {
        const Vec3f d = part.root_mm - c.centre_mm;
        a += 0.3F * d / std::max(1.0F, d.norm());
    }
    if (c.prior >= 0) {
        a += kPriorWeight * priors[static_cast<std::size_t>(c.prior)].arm_direction;
    }
    const float n = a.norm();
    // Nothing seen: a user's forearm comes from below and behind.
    c.arm_direction = n > 0.02F ? Vec3f(a / n) : Vec3f(0.0F, 0.7071F, 0.7071F);
    c.arm_seen = arm_mass > 0.05F * mass || part.root_pixels > 0;
}

void PalmSearch::find_wrist(PalmCandidate& c) const {
    const float r = c.radius_mm;
    std::array<float, kWristBins> width{};
    const float bin = (kWristToRadii - kWristFromRadii) * r / kWristBins;
    for (const Limb::Sample& s : limb_.samples()) {
        const Vec3f d = s.p_mm - c.centre_mm;
        const float along = d.dot(c.arm_direction);
        const float t = along - kWristFromRadii * r;
        // Across the arm: a thumb that hangs beside the wrist is not its width.
        if (t < 0.0F || d.squaredNorm() - along * along > 1.69F * r * r) {
            continue;
        }
        const auto b = static_cast<std::size_t>(t / bin);
        if (b < width.size()) {
            width[b] += s.area_mm2;
        }
    }
    float least = 1e9F;
    for (const float v : width) {
        least = v > 0.0F ? std::min(least, v) : least;
    }
    c.wrist_mm = kWristDefaultRadii * r;
    for (std::size_t b = 0; b < width.size(); ++b) {
        if (width[b] <= 1.15F * least) {
            c.wrist_mm = kWristFromRadii * r + (static_cast<float>(b) + 0.5F) * bin;
            break;
        }
    }
}

float reach_limit_mm(float palm_radius_mm) {
    return std::clamp(kReachRadii * palm_radius_mm, kReachFloorMm, kReachCeilingMm);
}

int PalmSearch::search(const Grid& grid, const Parts& parts, int part_index,
                       std::span<const PalmPrior> priors, std::span<PalmCandidate> out) {
    const Part& part = parts.parts()[static_cast<std::size_t>(part_index)];
    limb_.take(grid, parts, part);
    std::array<const Limb::Sample*, kCandidatesMax> palms{};
    const std::size_t found = find_palms(part, priors, palms);

    int written = 0;
    for (std::size_t k = 0; k < found && written < static_cast<int>(out.size()); ++k) {
        PalmCandidate c;
        c.part = part_index;
        c.pixel = palms[k]->pixel;
        c.centre_mm = palms[k]->p_mm;
        c.radius_mm = palms[k]->radius_mm;
        float nearest_prior = kPriorReachMm;
        for (std::size_t m = 0; m < priors.size(); ++m) {
            const float d = (priors[m].palm_mm - c.centre_mm).norm();
            if (d < nearest_prior) {
                nearest_prior = d;
                c.prior = static_cast<int>(m);
                c.agreement = 1.0F - d / kPriorReachMm;
                c.expected_mm = priors[m].palm_mm;
            }
        }
        bool known = false;
        for (int m = 0; m < written; ++m) {
            known |= (out[static_cast<std::size_t>(m)].centre_mm - c.centre_mm).norm() <
                     0.6F * c.radius_mm;
        }
        const bool small = c.prior < 0 && c.radius_mm < radius_min_mm_;
        if (known || small || c.radius_mm > radius_max_mm_) {
            continue;
        }
        find_arm(part, priors, c);
        find_wrist(c);
        score_palm(limb_, part, parts.bodies(), ahead_mm_, c);
        out[static_cast<std::size_t>(written++)] = c;
    }
    return written;
}

std::size_t PalmSearch::find_palms(const Part& part, std::span<const PalmPrior> priors,
                                   std::span<const Limb::Sample*> palms) const {
    std::size_t found = 0;
    const auto add = [&](const Limb::Sample* palm) {
        if (palm != nullptr && found < palms.size()) {
            palms[found++] = palm;
        }
    };
    const auto add_near = [&](const Vec3f& end) {
        add(limb_.thickest({end, kTipToPalmMm, kTipToPalmFadeMm, kTipToPalmLoss}));
    };
    for (const PalmPrior& prior : priors) {
        const float limit = std::max(30.0F, 0.9F * prior.palm_radius_mm);
        add(limb_.thickest({prior.palm_mm, limit, 0.0F, kWander / prior.palm_radius_mm}));
    }
    Vec3f centroid = Vec3f::Zero();
    const Limb::Sample* nearest = &limb_.samples().front();
    for (const Limb::Sample& s : limb_.samples()) {
        centroid += s.p_mm;
        nearest = s.p_mm.z() < nearest->p_mm.z() ? &s : nearest;
    }
    centroid /= static_cast<float>(limb_.samples().size());
    const Vec3f a = limb_.farthest(centroid).p_mm;
    add_near(a);
    add_near(limb_.farthest(a).p_mm);
    if (part.root_pixels > 0) {
        add_near(limb_.farthest(part.root_mm).p_mm);
    }
    add_near(nearest->p_mm);
    const Limb::Ridge* fingers = nullptr;
    for (int k = 0; k < kFingersOfHands; ++k) {
        fingers = limb_.most_fingers(fingers);
        if (fingers == nullptr) {
            break;
        }
        const Limb::Sample* palm =
            limb_.thickest({fingers->p_mm, kFingerToPalmMm, kFingerToPalmMm, 0.0F});
        for (int step = 0; step < kStepsToPalm && palm != nullptr; ++step) {
            const float limit = kStepRadii * palm->radius_mm;
            palm = limb_.thickest({palm->p_mm, limit, limit, 0.0F});
        }
        add(palm);
    }
    return found;
}

}  // namespace xtrack::segment
