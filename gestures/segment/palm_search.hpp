// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include <xtrack/hand.hpp>
#include <xtrack/tracker_settings.hpp>

#include "gestures/segment/grid.hpp"
#include "gestures/segment/limb.hpp"
#include "gestures/segment/parts.hpp"

namespace xtrack::segment {

/// Where a hand is expected, from the frames before.
struct PalmPrior {
    Vec3f palm_mm = Vec3f::Zero();
    Vec3f arm_direction = Vec3f::Zero();
    float palm_radius_mm = 0.0F;
};

/// A place on a part that may be a palm.
struct PalmCandidate {
    int part = -1;
    int pixel = -1;
    float radius_mm = 0.0F;
    Vec3f centre_mm = Vec3f::Zero();
    Vec3f arm_direction = Vec3f::Zero();
    bool arm_seen = false;
    float wrist_mm = 0.0F;   ///< distance from the centre to the wrist along arm_direction
    float reach_mm = 0.0F;   ///< how far the hand goes from the centre
    float score = 0.0F;      ///< 0..1
    float rank = 0.0F;       ///< the score before it was cut to 0..1: orders candidates
    int prior = -1;          ///< the expected palm it agrees with
    float agreement = 0.0F;  ///< 1 where that is, 0 as far from it as may be
    Vec3f expected_mm = Vec3f::Zero();  ///< where that is
};

/// Of a part: near each of kMaxHands priors, and at the ends of the part.
inline constexpr int kCandidatesMax = static_cast<int>(kMaxHands) + 6;

/// A palm that is followed may turn its edge: it may then be smaller by this than a new one.
inline constexpr float kEdgeOnShare = 0.8F;

/// Along a flat hand, fingers together, a palm's circle is nearly as wide everywhere: one that is a
/// radius off where the palm is expected must be wider by this share.
inline constexpr float kWander = 0.04F;

/// Looks for palms on one part: the thickest place near each of its ends (the two farthest apart,
/// the one farthest from the body, the nearest to the camera), where it has fingers, and near every
/// expected palm.
class PalmSearch {
 public:
    void create(const Grid& grid, const TrackerSettings& settings);

    /// @param out room for kCandidatesMax
    /// @return how many were written; their scores say which of them look like hands
    int search(const Grid& grid, const Parts& parts, int part, std::span<const PalmPrior> priors,
               std::span<PalmCandidate> out);

 private:
    std::size_t find_palms(const Part& part, std::span<const PalmPrior> priors,
                           std::span<const Limb::Sample*> palms) const;
    void find_arm(const Part& part, std::span<const PalmPrior> priors, PalmCandidate& c) const;
    void find_wrist(PalmCandidate& c) const;

    float radius_min_mm_ = 0.0F;
    float radius_max_mm_ = 0.0F;
    float ahead_mm_ = 0.0F;
    Limb limb_;
};

/// How far a hand may reach from the palm's centre: to the tip of the middle finger.
[[nodiscard]] float reach_limit_mm(float palm_radius_mm);

}  // namespace xtrack::segment
