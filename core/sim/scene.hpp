// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <xtrack/image.hpp>
#include <xtrack/sim.hpp>

#include "core/sim/lens.hpp"

namespace xtrack::sim {

inline constexpr std::size_t kMaxChannels = 3;  ///< blue, green, red; a grey camera uses the first
inline constexpr float kFarAway = 1.0e30F;
inline constexpr std::uint32_t kUnlit = 0xFFFFFFFFU;

/// How a material reflects in the camera's channels: blue, green, red, about 1 in the mean.
using Tint = std::array<float, kMaxChannels>;
[[nodiscard]] Tint tint_of(SimPart part, bool colour);

/// Two projector pixels are about one camera pixel on a hand.
inline constexpr int kShadowCellPx = 2;

/// Where the projector's light meets a point.
struct Lit {
    float light = 0.0F;          ///< grey levels at full level; 0 = turned away or out of its frame
    float coordinate_px = 0.0F;  ///< along the coded axis
    std::uint32_t cell = kUnlit;  ///< of the shadow map, row by row
    float depth_mm = 0.0F;        ///< projector Z
};

/// The projector as a lamp: geometry, falloff and cosine, no shadows.
class Lamp {
 public:
    Lamp(const Rig& rig, Axis axis, double light_grey);

    /// @param albedo of the surface
    [[nodiscard]] Lit at(const Vec3f& point_mm, const Vec3f& normal, float albedo) const;
    /// Projector pixel and Z.
    [[nodiscard]] ScreenPoint project(const Vec3f& point_mm, float& depth_mm) const {
        const Vec3f p = rotation_ * point_mm + offset_mm_;
        depth_mm = p.z();
        return p.z() > kNearMm ? lens_.project(p) : ScreenPoint{-kOutside, -kOutside};
    }
    /// The same point on the shadow map, whose cells are kShadowCellPx projector pixels wide.
    [[nodiscard]] ScreenPoint project_to_map(const Vec3f& point_mm, float& depth_mm) const {
        const ScreenPoint p = project(point_mm, depth_mm);
        constexpr float kScale = 1.0F / kShadowCellPx;
        return {(p.x + 0.5F) * kScale - 0.5F, (p.y + 0.5F) * kScale - 0.5F};
    }
    [[nodiscard]] Size map_size() const noexcept {
        return {(lens_.size().width + kShadowCellPx - 1) / kShadowCellPx,
                (lens_.size().height + kShadowCellPx - 1) / kShadowCellPx};
    }

 private:
    static constexpr float kNearMm = 50.0F;
    static constexpr float kOutside = 1.0e5F;
    Lens lens_;
    Eigen::Matrix<float, 3, 3, Eigen::DontAlign> rotation_;
    Vec3f offset_mm_;
    Vec3f centre_mm_;
    Axis axis_;
    float light_grey_;
};

/// Slack of the shadow test, mm: what the map's grid and the facets make a lit surface miss itself.
inline constexpr float kShadowSlackMm = 4.0F;

/// Light that comes from all round, more from above.
[[nodiscard]] inline float ambient_share(const Vec3f& normal) { return 0.8F - 0.2F * normal.y(); }

/// All that stands still, seen by the camera once: body and wall, one value a camera pixel.
struct StaticScene {
    Image<float> ray_x;  ///< ray (x, y, 1) of each pixel
    Image<float> ray_y;
    Image<float> depth_mm;
    Image<std::uint8_t> part;         ///< SimPart
    Image<float> light;               ///< Lit::light, 0 in shadow
    Image<float> coordinate_px;       ///< Lit::coordinate_px
    Image<std::uint32_t> cell;        ///< Lit::cell
    Image<float> projector_depth_mm;  ///< Lit::depth_mm
    Image<float> ambient;             ///< grey levels
    std::vector<float> shadow_mm;     ///< the body's projector Z, one a cell of the shadow map
};

[[nodiscard]] StaticScene build_static_scene(const SimSettings& settings, const Lens& camera,
                                             const Lamp& lamp);

/// Light of each pattern along the coded axis as it reaches the wall: 8-bit values, the projector's
/// response and black level, blurred; one curve a camera channel, crosstalk included.
class PatternCurves {
 public:
    PatternCurves(const SimSettings& settings, std::size_t channels);

    /// `stride()` values: one a projector pixel, then the last once more.
    [[nodiscard]] const float* curve(std::size_t pattern, std::size_t channel) const {
        return values_.data() + (pattern * channels_ + channel) * stride();
    }
    [[nodiscard]] std::size_t stride() const noexcept { return length_ + 1; }

 private:
    std::size_t length_;
    std::size_t channels_;
    std::vector<float> values_;
};

}  // namespace xtrack::sim
