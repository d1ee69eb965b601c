// SPDX-License-Identifier: Apache-2.0
#include "gestures/segment/palm_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Geometry>

namespace xtrack::segment {

namespace {

// Proportions of a hand in palm radii, from anthropometry (hand length 190 mm, breadth 85 mm, so a
// palm radius of 42 mm): the middle fingertip is 2.9 radii from the palm's centre.
constexpr float kReachRadii = 3.7F;
constexpr float kReachFloorMm = 105.0F;
constexpr float kReachCeilingMm = 175.0F;
/// A palm's centre is at most this far from the tip of its hand, mm.
constexpr float kTipToPalmMm = 135.0F;
/// And a candidate this far loses half its weight: a forearm is as thick as a fist.
constexpr float kTipToPalmFadeMm = 105.0F;
/// A palm that is followed may turn its edge: it may then be smaller by this than a new one.
constexpr float kEdgeOnShare = 1.0F;
/// Thinner than this is a finger, thicker by the ramp is not: inscribed radius, mm.
constexpr float kFingerRadiusMm = 11.5F;
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
/// Samples of a part that are looked at; more change nothing and cost time.
constexpr std::size_t kSamplesMax = 450;
/// An expected palm explains a candidate this near, mm.
constexpr float kPriorReachMm = 90.0F;

// Weights of the score, summed from kScoreBase; found on scenes with arms, heads and furniture.
constexpr float kScoreBase = 0.45F;
constexpr float kScoreFingers = 0.30F;
constexpr float kScoreNearer = 0.30F;
constexpr float kScoreRoot = 0.15F;
constexpr float kScoreAtRoot = 0.3F;
constexpr float kScoreBorder = 0.10F;
constexpr float kScorePrior = 0.30F;
constexpr float kScoreOverreach = 1.2F;
constexpr float kScoreSize = 0.4F;
constexpr float kScoreBody = 0.6F;      // the body that the limb grows from
constexpr float kScoreStranger = 0.5F;  // any other
/// Share of ahead_of_body_mm for a hand that is not connected to the body.
constexpr float kAheadOfStrangers = 0.4F;
constexpr float kScoreBulk = 0.5F;
/// An open hand shows 2.5 times the area of its palm's circle, with spread fingers at most:
constexpr float kBulkPalms = 3.6F;
/// Finger surface that makes a full vote, mm2: two fingers.
constexpr float kFingerAreaMm2 = 1500.0F;
/// How much nearer than its arm a hand is for a full vote, mm.
constexpr float kNearerMm = 100.0F;
constexpr float kPalmUsualMinMm = 32.0F;
constexpr float kPalmUsualMaxMm = 54.0F;

float ramp(float v, float from, float to) {
    return std::clamp((v - from) / (to - from), 0.0F, 1.0F);
}

}  // namespace

void PalmSearch::create(const Grid& grid, const TrackerSettings& settings) {
    settings_ = settings;
    thick_.reserve(grid.size());
    samples_.reserve(kSamplesMax);
}

void PalmSearch::take(const Grid& grid, const Parts& parts, const Part& part) {
    thick_.clear();
    samples_.clear();
    const auto pixels = parts.pixels(part);
    const std::size_t step = 1 + pixels.size() / kSamplesMax;
    const auto weight = static_cast<float>(step);
    int row_begin = 0;
    int row_end = 0;
    bool border_row = false;
    std::size_t next = 0;
    for (std::size_t k = 0; k < pixels.size(); ++k) {
        const int i = pixels[k];
        if (i >= row_end) {
            const int y = grid.y_of(i);  // a division, so once a row
            row_begin = grid.index(0, y);
            row_end = row_begin + grid.width;
            border_row = y <= 1 || y >= grid.inner_height - 2;
        }
        const int x = i - row_begin;
        const float pitch = grid.pitch_mm(grid.z[static_cast<std::size_t>(i)]);
        const float radius = parts.radius_px(i) * pitch;
        const bool thick =
            radius >= kEdgeOnShare * static_cast<float>(settings_.palm_radius_min_mm);
        const bool sampled = k == next;
        if (!thick && !sampled) {
            continue;
        }
        const Sample s{grid.point(i),
                       radius,
                       weight * pitch * pitch,
                       0.0F,
                       border_row || x <= 1 || x >= grid.inner_width - 2,
                       i};
        if (thick) {
            thick_.push_back(s);
        }
        if (sampled) {
            samples_.push_back(s);
            next += step;
        }
    }
}

const PalmSearch::Sample& PalmSearch::farthest(const Vec3f& from) const {
    float best = -1.0F;
    const Sample* found = &samples_.front();
    for (const Sample& s : samples_) {
        const float d = (s.p_mm - from).squaredNorm();
        if (d > best) {
            best = d;
            found = &s;
        }
    }
    return *found;
}

/// The thickest place within a hand's length of an end.
const PalmSearch::Sample* PalmSearch::thickest_near(const Vec3f& end, float limit_mm) const {
    float best = 0.0F;
    const Sample* found = nullptr;
    for (const Sample& s : thick_) {
        if (s.radius_mm <= best) {
            continue;
        }
        const float d = (s.p_mm - end).norm();
        if (d > limit_mm) {
            continue;
        }
        const float weighted =
            s.radius_mm * (1.0F - 0.5F * ramp(d, kTipToPalmFadeMm, kTipToPalmMm + 30.0F));
        if (weighted > best) {
            best = weighted;
            found = &s;
        }
    }
    return found;
}

/// Where the forearm is: thick surface outside the palm's circle pulls, fingers push.
void PalmSearch::find_arm(const Part& part, const PalmPrior* prior, PalmCandidate& c) {
    const float r = c.radius_mm;
    const float ring = kRingRadii * r;
    const float reach = reach_limit_mm(r);
    Vec3f thick = Vec3f::Zero();
    Vec3f thin = Vec3f::Zero();
    float arm_mass = 0.0F;
    float mass = 0.0F;
    for (Sample& s : samples_) {
        mass += 1.0F;
        const Vec3f d = s.p_mm - c.centre_mm;
        const float n = d.norm();
        s.distance_mm = n;
        if (n < ring || n > 2.0F * reach) {
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
    if (prior != nullptr) {
        a += kPriorWeight * prior->arm_direction;
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
    for (const Sample& s : samples_) {
        const Vec3f d = s.p_mm - c.centre_mm;
        const float along = d.dot(c.arm_direction);
        const float t = along - kWristFromRadii * r;
        // Across the arm: a thumb that hangs beside the wrist is not its width.
        if (t < 0.0F || s.distance_mm * s.distance_mm - along * along > 1.69F * r * r) {
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

void PalmSearch::judge(const Part& part, std::span<const Body> bodies, PalmCandidate& c) const {
    const float reach = reach_limit_mm(c.radius_mm);
    float finger_area = 0.0F;
    float arm_depth = 0.0F;
    float arm_count = 0.0F;
    float over = 0.0F;
    float inside = 0.0F;
    float inside_area = 0.0F;
    float far = 0.0F;
    bool arm_at_border = false;
    bool hand_at_border = false;
    for (const Sample& s : samples_) {
        const Vec3f d = s.p_mm - c.centre_mm;
        if (d.dot(c.arm_direction) > c.wrist_mm) {
            arm_depth += s.p_mm.z();
            arm_count += 1.0F;
            arm_at_border |= s.border;
            continue;
        }
        const float n = s.distance_mm;
        if (n > reach) {
            over += 1.0F;
            continue;
        }
        inside += 1.0F;
        inside_area += s.area_mm2;
        far = std::max(far, n);
        hand_at_border |= s.border;
        if (n > kRingRadii * c.radius_mm && s.radius_mm < kFingerRadiusMm) {
            finger_area += s.area_mm2;
        }
    }
    c.reach_mm = far;
    float score = kScoreBase;
    score += kScoreFingers * std::min(1.0F, finger_area / kFingerAreaMm2);
    if (arm_count > 0.1F * inside) {
        const float nearer = (arm_depth / arm_count - c.centre_mm.z()) / kNearerMm;
        score += kScoreNearer * std::clamp(nearer, -1.0F, 1.0F);
    }
    if (part.root_pixels > 0) {
        const Vec3f root = part.root_mm - c.centre_mm;
        score += kScoreRoot * root.normalized().dot(c.arm_direction);
        // Beside the body an arm begins; a hand is at the other end.
        score -= kScoreAtRoot * (1.0F - ramp(root.norm(), 1.5F * c.radius_mm, 3.0F * c.radius_mm));
    }
    score +=
        kScoreBorder * (static_cast<float>(arm_at_border) - static_cast<float>(hand_at_border));
    score -= kScoreOverreach * over / std::max(1.0F, inside);
    const float usual = std::max(ramp(-c.radius_mm, -kPalmUsualMinMm, -kPalmUsualMinMm + 10.0F),
                                 ramp(c.radius_mm, kPalmUsualMaxMm, kPalmUsualMaxMm + 10.0F));
    score -= kScoreSize * usual;
    // A shoulder, a neck, a face: hardly nearer than the body beside it.
    const auto ahead = static_cast<float>(settings_.ahead_of_body_mm);
    for (const Body& body : bodies) {
        const bool own = body.label == part.body;
        const float need = own ? ahead : kAheadOfStrangers * ahead;
        score -= (own ? kScoreBody : kScoreStranger) *
                 (1.0F - ramp(body.front_mm - c.centre_mm.z(), need, 2.0F * need));
    }
    // More surface within reach than a palm and five fingers have: a face cut up by hair.
    const float palm_area = 3.14159F * c.radius_mm * c.radius_mm;
    score -= kScoreBulk * ramp(inside_area / palm_area, kBulkPalms, 1.4F * kBulkPalms);
    if (c.prior >= 0) {
        score += kScorePrior;
    }
    c.rank = score;
    c.score = std::clamp(score, 0.0F, 1.0F);
}

float reach_limit_mm(float palm_radius_mm) {
    return std::clamp(kReachRadii * palm_radius_mm, kReachFloorMm, kReachCeilingMm);
}

int PalmSearch::search(const Grid& grid, const Parts& parts, int part_index,
                       std::span<const PalmPrior> priors, std::span<PalmCandidate> out) {
    const Part& part = parts.parts()[static_cast<std::size_t>(part_index)];
    take(grid, parts, part);

    Vec3f centroid = Vec3f::Zero();
    const Sample* nearest = &samples_.front();
    for (const Sample& s : samples_) {
        centroid += s.p_mm;
        nearest = s.p_mm.z() < nearest->p_mm.z() ? &s : nearest;
    }
    centroid /= static_cast<float>(samples_.size());

    std::array<const Sample*, kCandidatesMax> palms{};
    std::size_t found = 0;
    const auto add = [&](const Vec3f& end, float limit_mm) {
        const Sample* const palm = thickest_near(end, limit_mm);
        if (palm != nullptr && found < palms.size()) {
            palms[found++] = palm;
        }
    };
    for (const PalmPrior& prior : priors) {
        add(prior.palm_mm, std::max(30.0F, 0.9F * prior.palm_radius_mm));
    }
    const Vec3f a = farthest(centroid).p_mm;
    add(a, kTipToPalmMm);
    add(farthest(a).p_mm, kTipToPalmMm);
    if (part.root_pixels > 0) {
        add(farthest(part.root_mm).p_mm, kTipToPalmMm);
    }
    add(nearest->p_mm, kTipToPalmMm);

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
            }
        }
        if (c.radius_mm < (c.prior >= 0 ? kEdgeOnShare : 1.0F) *
                              static_cast<float>(settings_.palm_radius_min_mm) ||
            c.radius_mm > static_cast<float>(settings_.palm_radius_max_mm)) {
            continue;
        }
        bool known = false;
        for (int m = 0; m < written; ++m) {
            known |= (out[static_cast<std::size_t>(m)].centre_mm - c.centre_mm).norm() <
                     0.6F * c.radius_mm;
        }
        if (known) {
            continue;
        }
        find_arm(part, c.prior >= 0 ? &priors[static_cast<std::size_t>(c.prior)] : nullptr, c);
        find_wrist(c);
        judge(part, parts.bodies(), c);
        out[static_cast<std::size_t>(written++)] = c;
    }
    return written;
}

}  // namespace xtrack::segment
