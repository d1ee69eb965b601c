// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <xtrack/tracker_settings.hpp>

#include "gestures/segment/grid.hpp"
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
    float wrist_mm = 0.0F;  ///< distance from the centre to the wrist along arm_direction
    float reach_mm = 0.0F;  ///< how far the hand goes from the centre
    float score = 0.0F;     ///< 0..1
    float rank = 0.0F;      ///< the score before it was cut to 0..1: orders candidates
    int prior = -1;         ///< the expected palm it agrees with
};

inline constexpr int kCandidatesMax = 6;

/// Looks for palms on one part: the thickest place near each of its ends (the two farthest apart,
/// the one farthest from the body, the nearest to the camera) and near every expected palm.
class PalmSearch {
 public:
    void create(const Grid& grid, const TrackerSettings& settings);

    /// @param out room for kCandidatesMax
    /// @return how many were written; their scores say which of them look like hands
    int search(const Grid& grid, const Parts& parts, int part, std::span<const PalmPrior> priors,
               std::span<PalmCandidate> out);

 private:
    /// A pixel of the part.
    struct Sample {
        Vec3f p_mm;
        float radius_mm = 0.0F;    ///< of the circle round it that stays on its surface
        float area_mm2 = 0.0F;     ///< of the surface that it stands for
        float distance_mm = 0.0F;  ///< from the palm that is looked at
        bool border = false;       ///< at the border of the image
        int pixel = 0;
    };

    void take(const Grid& grid, const Parts& parts, const Part& part);
    [[nodiscard]] const Sample& farthest(const Vec3f& from) const;
    [[nodiscard]] const Sample* thickest_near(const Vec3f& end, float limit_mm) const;
    /// Measures every sample's distance from the candidate, too.
    void find_arm(const Part& part, const PalmPrior* prior, PalmCandidate& c);
    void find_wrist(PalmCandidate& c) const;
    void judge(const Part& part, std::span<const Body> bodies, PalmCandidate& c) const;

    TrackerSettings settings_;
    std::vector<Sample> samples_;  ///< some of the pixels, evenly
    std::vector<Sample> thick_;    ///< every pixel that may be a palm's centre
};

/// How far a hand may reach from the palm's centre: to the tip of the middle finger.
[[nodiscard]] float reach_limit_mm(float palm_radius_mm);

}  // namespace xtrack::segment
