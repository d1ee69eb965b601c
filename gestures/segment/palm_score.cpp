// SPDX-License-Identifier: Apache-2.0
#include "gestures/segment/palm_score.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include "gestures/segment/ramp.hpp"

namespace xtrack::segment {

namespace {

// Weights of the score, summed from kScoreBase; found on scenes with arms, heads and furniture.
constexpr float kScoreBase = 0.5F;
constexpr float kScoreFingers = 0.30F;
constexpr float kScoreNearer = 0.30F;
constexpr float kScoreRoot = 0.15F;
constexpr float kScoreAtRoot = 0.3F;
constexpr float kScoreBorder = 0.10F;
constexpr float kScorePrior = 0.20F;
constexpr float kScoreAgreement = 0.20F;
constexpr float kScoreOverreach = 1.2F;
constexpr float kScoreOverreachMax = 0.3F;  // a head may be one surface with the hand before it
constexpr float kScoreSize = 0.4F;
constexpr float kScoreBody = 0.6F;      // the body that the limb grows from
constexpr float kScoreStranger = 0.5F;  // any other
constexpr float kScoreBulk = 0.5F;
constexpr float kScoreDome = 0.6F;
constexpr float kScoreWideArm = 0.3F;

/// Share of ahead_mm for a hand that is not connected to the body.
constexpr float kAheadOfStrangers = 0.4F;
/// Fingers take this share of the doubt from a hand that is raised beside its body.
constexpr float kBesideBody = 0.7F;
/// Nothing closer to the palm's centre is a finger, in palm radii.
constexpr float kFingersFromRadii = 1.25F;
/// Finger surface that makes a full vote, mm2: two fingers, of which a coarse grid shows a part.
constexpr float kFingerAreaMm2 = 1800.0F;
/// How much nearer than its arm a hand is for a full vote, mm.
constexpr float kNearerMm = 100.0F;
constexpr float kPalmUsualMinMm = 28.0F;
constexpr float kPalmUsualMaxMm = 54.0F;
constexpr float kPalmUsualRampMm = 10.0F;
/// A flat hand with its fingers together, or a palm and what its fingers do not explain, has less
/// surface within reach, in areas of the palm's circle; an elbow has more.
constexpr float kBulkPalms = 2.6F;
constexpr float kBulkPalmsMax = 3.4F;
/// That bulk times how thick it is, as seen from the front: a hand is flat, a fist small, and a
/// face is neither, mm.
constexpr float kDomeMm = 22.0F;
constexpr float kDomeMaxMm = 34.0F;
/// Fingers that bend add so much to that.
constexpr float kDomeOfFingersMm = 8.0F;
/// How far from the palm's centre thickness is measured, in palm radii.
constexpr float kDomeRadii = 2.0F;
/// A forearm is no wider than this behind the wrist, mm: necks and upper arms are.
constexpr float kArmWidthMm = 75.0F;
constexpr float kArmWidthMaxMm = 110.0F;
/// How far behind the wrist its width is measured, mm, and how far to either side, in palm radii.
constexpr float kArmLengthMm = 60.0F;
constexpr float kArmBesideRadii = 2.0F;

/// What the surface round a candidate adds up to.
struct Shape {
    float inside = 0.0F;  ///< samples of the hand, up to where a fingertip may be
    float over = 0.0F;    ///< samples that are farther, and not the arm's
    float area_mm2 = 0.0F;
    float finger_area_mm2 = 0.0F;
    float reach_mm = 0.0F;
    float thickness_mm = 0.0F;  ///< standard deviation from its plane
    float arm = 0.0F;           ///< samples
    float arm_depth_mm = 0.0F;
    float arm_width_mm = 0.0F;
    bool at_border = false;
    bool arm_at_border = false;
};

/// Smallest standard deviation of points, in whatever direction that is.
float thickness(float n, const Vec3f& sum, const std::array<float, 6>& squares) {
    if (n < 3.0F) {
        return 0.0F;
    }
    Eigen::Matrix3f m;
    m << squares[0], squares[1], squares[2], squares[1], squares[3], squares[4], squares[2],
        squares[4], squares[5];
    const Vec3f mean = sum / n;
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solver;
    solver.computeDirect(m / n - mean * mean.transpose(), Eigen::EigenvaluesOnly);
    return std::sqrt(std::max(0.0F, solver.eigenvalues()[0]));
}

Shape measure(const Limb& limb, const PalmCandidate& c) {
    Shape shape;
    const float limit = reach_limit_mm(c.radius_mm);
    const float dome = kDomeRadii * c.radius_mm;
    const float beside = kArmBesideRadii * c.radius_mm;
    float farthest = 0.0F;
    float n = 0.0F;
    Vec3f sum = Vec3f::Zero();
    std::array<float, 6> squares{};
    for (const Limb::Sample& s : limb.samples()) {
        const Vec3f d = s.p_mm - c.centre_mm;
        const float squared = d.squaredNorm();
        const float along = d.dot(c.arm_direction);
        if (along > c.wrist_mm) {
            shape.arm_depth_mm += s.p_mm.z();
            shape.arm += 1.0F;
            shape.arm_at_border |= s.border;
            if (along < c.wrist_mm + kArmLengthMm && squared - along * along < beside * beside) {
                shape.arm_width_mm += s.area_mm2;
            }
            continue;
        }
        if (squared > limit * limit) {
            shape.over += 1.0F;
            continue;
        }
        shape.inside += 1.0F;
        shape.area_mm2 += s.area_mm2;
        farthest = std::max(farthest, squared);
        shape.at_border |= s.border;
        if (squared < dome * dome) {
            n += 1.0F;
            sum += d;
            squares[0] += d.x() * d.x();
            squares[1] += d.x() * d.y();
            squares[2] += d.x() * d.z();
            squares[3] += d.y() * d.y();
            squares[4] += d.y() * d.z();
            squares[5] += d.z() * d.z();
        }
    }
    const float from = kFingersFromRadii * c.radius_mm;
    for (const Limb::Ridge& r : limb.ridges()) {
        const Vec3f d = r.p_mm - c.centre_mm;
        const float squared = d.squaredNorm();
        if (squared > from * from && squared < limit * limit &&
            d.dot(c.arm_direction) < c.wrist_mm) {
            shape.finger_area_mm2 += r.area_mm2;
        }
    }
    shape.reach_mm = std::sqrt(farthest);
    shape.arm_depth_mm /= std::max(1.0F, shape.arm);
    shape.arm_width_mm /= kArmLengthMm;
    shape.thickness_mm = thickness(n, sum, squares);
    return shape;
}

}  // namespace

void score_palm(const Limb& limb, const Part& part, std::span<const Body> bodies, float ahead_mm,
                PalmCandidate& c) {
    const Shape shape = measure(limb, c);
    c.reach_mm = shape.reach_mm;
    // The circle of a palm that shows its edge is smaller than the palm.
    const float palm_mm = std::max(c.radius_mm, kPalmUsualMinMm);
    const float palm_area = 3.14159F * palm_mm * palm_mm;
    const float bulk = (shape.area_mm2 - shape.finger_area_mm2) / palm_area;
    const float thin = std::min(1.0F, shape.finger_area_mm2 / kFingerAreaMm2);
    const float dome =
        ramp(bulk * shape.thickness_mm - thin * kDomeOfFingersMm, kDomeMm, kDomeMaxMm);
    // Hair is as thin as fingers.
    const float fingers = (1.0F - dome) * thin;

    float score = kScoreBase + kScoreFingers * fingers;
    score -= kScoreDome * dome;
    score -= kScoreBulk * ramp(bulk, kBulkPalms, kBulkPalmsMax);
    score -= kScoreWideArm * ramp(shape.arm_width_mm, kArmWidthMm, kArmWidthMaxMm);
    if (shape.arm > 0.1F * shape.inside) {
        const float nearer = (shape.arm_depth_mm - c.centre_mm.z()) / kNearerMm;
        score += kScoreNearer * std::clamp(nearer, -1.0F, 1.0F);
    }
    if (part.root_pixels > 0) {
        const Vec3f root = part.root_mm - c.centre_mm;
        score += kScoreRoot * root.normalized().dot(c.arm_direction);
        // Beside the body an arm begins; a hand is at the other end.
        score -= kScoreAtRoot * (1.0F - ramp(root.norm(), 1.5F * c.radius_mm, 3.0F * c.radius_mm));
    }
    score += kScoreBorder *
             (static_cast<float>(shape.arm_at_border) - static_cast<float>(shape.at_border));
    score -=
        std::min(kScoreOverreachMax, kScoreOverreach * shape.over / std::max(1.0F, shape.inside));
    score -= kScoreSize *
             std::max(ramp(-c.radius_mm, -kPalmUsualMinMm, kPalmUsualRampMm - kPalmUsualMinMm),
                      ramp(c.radius_mm, kPalmUsualMaxMm, kPalmUsualMaxMm + kPalmUsualRampMm));
    // A shoulder, a neck, a face: hardly nearer than the body beside it. So is a hand that is
    // raised beside its body, but it shows its fingers; nothing behind the body is a hand.
    for (const Body& body : bodies) {
        const bool own = body.label == part.body;
        const float ahead = body.front_mm - c.centre_mm.z();
        const float need = own ? ahead_mm : kAheadOfStrangers * ahead_mm;
        const float beside = kBesideBody * fingers * ramp(ahead, -ahead_mm, 0.0F);
        score -= (own ? kScoreBody : kScoreStranger) * (1.0F - beside) *
                 (1.0F - ramp(ahead, need, 2.0F * need));
    }
    if (c.prior >= 0) {
        // Along fingers that lie together a palm's circle fits nearly anywhere.
        score += kScorePrior + kScoreAgreement * c.agreement;
    }
    c.rank = score;
    c.score = std::clamp(score, 0.0F, 1.0F);
}

}  // namespace xtrack::segment
