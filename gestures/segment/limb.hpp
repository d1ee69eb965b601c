// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "gestures/segment/grid.hpp"
#include "gestures/segment/parts.hpp"

namespace xtrack::segment {

/// Thinner than this is a finger: inscribed radius, mm.
inline constexpr float kFingerRadiusMm = 11.5F;

/// A part as a search for palms looks at it: some of its pixels, evenly, and those on its middle
/// lines, where fingers are and the centres of palms may be.
class Limb {
 public:
    /// A pixel of the part.
    struct Sample {
        Vec3f p_mm;
        float radius_mm = 0.0F;  ///< of the circle round it that stays on its surface
        float area_mm2 = 0.0F;   ///< of the surface that it stands for
        bool border = false;     ///< at the border of the image
        int pixel = 0;
    };
    /// A pixel on the middle line of something as thin as a finger.
    struct Ridge {
        Vec3f p_mm;
        float area_mm2 = 0.0F;  ///< of the finger across it
    };

    /// @param thick_mm radius from which on a pixel may be a palm's centre
    void create(const Grid& grid, float thick_mm);

    /// The part must have pixels.
    void take(const Grid& grid, const Parts& parts, const Part& part);

    [[nodiscard]] std::span<const Sample> samples() const noexcept { return samples_; }
    [[nodiscard]] std::span<const Ridge> ridges() const noexcept { return ridges_; }

    [[nodiscard]] const Sample& farthest(const Vec3f& from) const;
    /// Where to look, and how much less a radius counts by its distance from there.
    struct Around {
        Vec3f p_mm;
        float limit_mm = 0.0F;
        float full_mm = 0.0F;      ///< up to here it counts in full
        float loss_per_mm = 0.0F;  ///< share that it loses beyond
    };
    /// @return nullptr = nothing thick is there
    [[nodiscard]] const Sample* thickest(const Around& around) const;
    /// Where most fingers are close together.
    /// @param but where not nullptr: others than those there
    /// @return nullptr = there are none
    [[nodiscard]] const Ridge* most_fingers(const Ridge* but) const;

 private:
    float thick_mm_ = 0.0F;
    std::vector<Sample> samples_;
    std::vector<Sample> thick_;
    std::vector<Ridge> ridges_;
};

}  // namespace xtrack::segment
