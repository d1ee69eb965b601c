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
constexpr int kSamplesMax = 3500;
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

struct Samples {
    const Grid& grid;
    const Parts& parts;
    std::span<const int> pixels;
    std::size_t step;

    template <typename F>
    void each(F&& f) const {
        for (std::size_t k = 0; k < pixels.size(); k += step) {
            f(pixels[k], grid.point(pixels[k]));
        }
    }
};

float ramp(float v, float from, float to) {
    return std::clamp((v - from) / (to - from), 0.0F, 1.0F);
}

int farthest(const Samples& s, const Vec3f& from) {
    float best = -1.0F;
    int pixel = s.pixels[0];
    s.each([&](int i, const Vec3f& p) {
        const float d = (p - from).squaredNorm();
        if (d > best) {
            best = d;
            pixel = i;
        }
    });
    return pixel;
}

/// The thickest place within a hand's length of an end.
int thickest_near(const Samples& s, const Vec3f& end, float limit_mm) {
    float best = 0.0F;
    int pixel = -1;
    for (const int i : s.pixels) {
        const float r = s.parts.radius_mm(s.grid, i);
        if (r <= best) {
            continue;
        }
        const float d = (s.grid.point(i) - end).norm();
        if (d > limit_mm) {
            continue;
        }
        const float weighted = r * (1.0F - 0.5F * ramp(d, kTipToPalmFadeMm, kTipToPalmMm + 30.0F));
        if (weighted > best) {
            best = weighted;
            pixel = i;
        }
    }
    return pixel;
}

/// Where the forearm is: thick surface outside the palm's circle pulls, fingers push.
void find_arm(const Samples& s, const Part& part, const PalmPrior* prior, PalmCandidate& c) {
    const float r = c.radius_mm;
    const float ring = kRingRadii * r;
    const float reach = reach_limit_mm(r);
    Vec3f thick = Vec3f::Zero();
    Vec3f thin = Vec3f::Zero();
    float thick_mass = 0.0F;
    float arm_mass = 0.0F;
    float mass = 0.0F;
    s.each([&](int i, const Vec3f& p) {
        mass += 1.0F;
        const Vec3f d = p - c.centre_mm;
        const float n = d.norm();
        if (n < ring || n > 2.0F * reach) {
            return;
        }
        const Vec3f u = d / n;
        if (n > reach) {
            thick += kArmWeight * u;
            thick_mass += kArmWeight;
            arm_mass += 1.0F;
            return;
        }
        const float t =
            ramp(s.parts.radius_mm(s.grid, i), kFingerRadiusMm, kFingerRadiusMm + kFingerRampMm);
        thick += t * u;
        thick_mass += t;
        thin += (1.0F - t) * u;
    });
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

void find_wrist(const Samples& s, PalmCandidate& c) {
    const float r = c.radius_mm;
    std::array<float, kWristBins> width{};
    const float bin = (kWristToRadii - kWristFromRadii) * r / kWristBins;
    s.each([&](int i, const Vec3f& p) {
        const Vec3f d = p - c.centre_mm;
        const float t = d.dot(c.arm_direction) - kWristFromRadii * r;
        // Across the arm: a thumb that hangs beside the wrist is not its width.
        if (t < 0.0F || (d - d.dot(c.arm_direction) * c.arm_direction).norm() > 1.3F * r) {
            return;
        }
        const auto b = static_cast<std::size_t>(t / bin);
        if (b < width.size()) {
            const float pitch = s.grid.pitch_mm(s.grid.z[static_cast<std::size_t>(i)]);
            width[b] += pitch * pitch;
        }
    });
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

void judge(const Samples& s, const Part& part, const TrackerSettings& settings,
           std::span<const Body> bodies, PalmCandidate& c) {
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
    const Grid& grid = s.grid;
    const auto weight = static_cast<float>(s.step);
    s.each([&](int i, const Vec3f& p) {
        const Vec3f d = p - c.centre_mm;
        const float along = d.dot(c.arm_direction);
        const int x = grid.x_of(i);
        const int y = grid.y_of(i);
        const bool border =
            x <= 1 || y <= 1 || x >= grid.inner_width - 2 || y >= grid.inner_height - 2;
        if (along > c.wrist_mm) {
            arm_depth += p.z();
            arm_count += 1.0F;
            arm_at_border |= border;
            return;
        }
        const float n = d.norm();
        if (n > reach) {
            over += 1.0F;
            return;
        }
        inside += 1.0F;
        const float pitch = grid.pitch_mm(p.z());
        inside_area += weight * pitch * pitch;
        far = std::max(far, n);
        hand_at_border |= border;
        if (n > kRingRadii * c.radius_mm && s.parts.radius_mm(grid, i) < kFingerRadiusMm) {
            finger_area += weight * pitch * pitch;
        }
    });
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
    const auto ahead = static_cast<float>(settings.ahead_of_body_mm);
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

}  // namespace

float reach_limit_mm(float palm_radius_mm) {
    return std::clamp(kReachRadii * palm_radius_mm, kReachFloorMm, kReachCeilingMm);
}

int search_palms(const Grid& grid, const Parts& parts, int part_index,
                 std::span<const PalmPrior> priors, const TrackerSettings& settings,
                 std::span<PalmCandidate> out) {
    const Part& part = parts.parts()[static_cast<std::size_t>(part_index)];
    const auto pixels = parts.pixels(part);
    const std::size_t step = 1 + pixels.size() / kSamplesMax;
    const Samples s{grid, parts, pixels, step};

    Vec3f centroid = Vec3f::Zero();
    float nearest = 1e9F;
    int nearest_pixel = pixels[0];
    float count = 0.0F;
    s.each([&](int i, const Vec3f& p) {
        centroid += p;
        count += 1.0F;
        if (p.z() < nearest) {
            nearest = p.z();
            nearest_pixel = i;
        }
    });
    centroid /= count;

    std::array<int, kCandidatesMax> palms{};
    std::size_t found = 0;
    const auto add = [&](const Vec3f& end, float limit_mm) {
        const int palm = thickest_near(s, end, limit_mm);
        if (palm >= 0 && found < palms.size()) {
            palms[found++] = palm;
        }
    };
    for (const PalmPrior& prior : priors) {
        add(prior.palm_mm, std::max(30.0F, 0.9F * prior.palm_radius_mm));
    }
    const Vec3f a = grid.point(farthest(s, centroid));
    add(a, kTipToPalmMm);
    const Vec3f b = grid.point(farthest(s, a));
    add(b, kTipToPalmMm);
    if (part.root_pixels > 0) {
        add(grid.point(farthest(s, part.root_mm)), kTipToPalmMm);
    }
    add(grid.point(nearest_pixel), kTipToPalmMm);

    int written = 0;
    for (std::size_t k = 0; k < found && written < static_cast<int>(out.size()); ++k) {
        PalmCandidate c;
        c.part = part_index;
        c.pixel = palms[k];
        c.centre_mm = grid.point(c.pixel);
        c.radius_mm = parts.radius_mm(grid, c.pixel);
        if (c.radius_mm < static_cast<float>(settings.palm_radius_min_mm) ||
            c.radius_mm > static_cast<float>(settings.palm_radius_max_mm)) {
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
        float nearest_prior = kPriorReachMm;
        for (std::size_t m = 0; m < priors.size(); ++m) {
            const float d = (priors[m].palm_mm - c.centre_mm).norm();
            if (d < nearest_prior) {
                nearest_prior = d;
                c.prior = static_cast<int>(m);
            }
        }
        find_arm(s, part, c.prior >= 0 ? &priors[static_cast<std::size_t>(c.prior)] : nullptr, c);
        find_wrist(s, c);
        judge(s, part, settings, parts.bodies(), c);
        out[static_cast<std::size_t>(written++)] = c;
    }
    return written;
}

}  // namespace xtrack::segment
