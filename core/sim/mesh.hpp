// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include <xtrack/geometry.hpp>

namespace xtrack::sim {

/// A closed surface. Triangles are counter-clockwise seen from outside.
struct Mesh {
    std::vector<Vec3f> positions_mm;
    std::vector<Vec3f> normals;
    std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Distance to a surface, negative inside, mm; a lower bound of the true distance will do.
using DistanceField = std::function<float(const Vec3f&)>;

/// Turns a distance field into a mesh by naive surface nets on a rectilinear grid, each vertex then
/// moved onto the surface and given the field's gradient as normal (Gibson 1998).
/// @param xs,ys,zs grid planes, ascending, mm; the surface must lie inside
[[nodiscard]] Mesh polygonise(const DistanceField& field, const std::vector<float>& xs,
                              const std::vector<float>& ys, const std::vector<float>& zs);

/// Planes from `low` to `high` at most `step` apart.
[[nodiscard]] std::vector<float> grid_planes(float low, float high, float step);

// Building blocks of distance fields.

/// A capsule whose radius goes from radius_a at `a` to radius_b at `b`.
struct TaperedCapsule {
    Vec3f a = Vec3f::Zero();
    Vec3f b = Vec3f::Zero();
    float radius_a = 1.0F;
    float radius_b = 1.0F;
};
[[nodiscard]] float distance(const TaperedCapsule& c, const Vec3f& p);
/// Union of two fields with a fillet of about `k` mm between them.
[[nodiscard]] float smooth_union(float a, float b, float k);
[[nodiscard]] float smooth_step(float low, float high, float x);

/// Smooth noise in -1..1 whose features are about 1 unit apart.
[[nodiscard]] float value_noise(const Vec3f& p, std::uint64_t seed);

}  // namespace xtrack::sim
