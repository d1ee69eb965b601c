// SPDX-License-Identifier: Apache-2.0
#include "core/sim/mesh.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/sim/random.hpp"

namespace xtrack::sim {
namespace {

constexpr float kGradientStepMm = 0.25F;
constexpr int kProjectionSteps = 2;
constexpr std::uint32_t kNoVertex = 0xFFFFFFFFU;

Vec3f gradient(const DistanceField& field, const Vec3f& p) {
    Vec3f g = Vec3f::Zero();
    for (int axis = 0; axis < 3; ++axis) {
        Vec3f step = Vec3f::Zero();
        step[axis] = kGradientStepMm;
        g[axis] = field(p + step) - field(p - step);
    }
    return g / (2.0F * kGradientStepMm);
}

class Grid {
 public:
    Grid(const std::vector<float>& xs, const std::vector<float>& ys, const std::vector<float>& zs)
        : planes_{xs, ys, zs} {}
    [[nodiscard]] int count(int axis) const {
        return static_cast<int>(planes_[static_cast<std::size_t>(axis)].size());
    }
    [[nodiscard]] float plane(int axis, int i) const {
        return planes_[static_cast<std::size_t>(axis)][static_cast<std::size_t>(i)];
    }
    [[nodiscard]] std::size_t index(int i, int j, int k) const {
        return (static_cast<std::size_t>(k) * static_cast<std::size_t>(count(1)) +
                static_cast<std::size_t>(j)) *
                   static_cast<std::size_t>(count(0)) +
               static_cast<std::size_t>(i);
    }
    [[nodiscard]] std::size_t size() const { return index(0, 0, count(2)); }
    [[nodiscard]] Vec3f point(int i, int j, int k) const {
        return {plane(0, i), plane(1, j), plane(2, k)};
    }

 private:
    std::array<std::vector<float>, 3> planes_;
};

/// The field at every grid point. Far from the surface only its sign matters, so whole blocks are
/// filled from one sample at their middle.
std::vector<float> sample(const DistanceField& field, const Grid& grid) {
    constexpr int kBlock = 6;
    // Smooth unions and squeezed shapes make the field's slope differ from 1.
    constexpr float kSlopeMargin = 1.8F;
    std::vector<float> values(grid.size());
    for (int k0 = 0; k0 < grid.count(2); k0 += kBlock) {
        for (int j0 = 0; j0 < grid.count(1); j0 += kBlock) {
            for (int i0 = 0; i0 < grid.count(0); i0 += kBlock) {
                const int i1 = std::min(i0 + kBlock, grid.count(0));
                const int j1 = std::min(j0 + kBlock, grid.count(1));
                const int k1 = std::min(k0 + kBlock, grid.count(2));
                const Vec3f low = grid.point(i0, j0, k0);
                const Vec3f high = grid.point(i1 - 1, j1 - 1, k1 - 1);
                const float middle = field((low + high) * 0.5F);
                const float reach = (high - low).norm() * 0.5F * kSlopeMargin;
                const bool far = std::abs(middle) > reach + 1.0F;
                for (int k = k0; k < k1; ++k) {
                    for (int j = j0; j < j1; ++j) {
                        for (int i = i0; i < i1; ++i) {
                            values[grid.index(i, j, k)] = far ? middle : field(grid.point(i, j, k));
                        }
                    }
                }
            }
        }
    }
    return values;
}

/// The mean of the points where the cell's edges cross the surface; false if none does.
bool cell_vertex(const Grid& grid, const std::vector<float>& values, int i, int j, int k,
                 Vec3f& vertex) {
    std::array<float, 8> corner{};
    unsigned inside = 0;
    for (unsigned c = 0; c < 8; ++c) {
        corner[c] =
            values[grid.index(i + static_cast<int>(c & 1U), j + static_cast<int>(c >> 1U & 1U),
                              k + static_cast<int>(c >> 2U & 1U))];
        inside |= (corner[c] < 0.0F ? 1U : 0U) << c;
    }
    if (inside == 0U || inside == 0xFFU) {
        return false;
    }
    Vec3f sum = Vec3f::Zero();
    int crossings = 0;
    for (unsigned c = 0; c < 8; ++c) {
        for (unsigned axis = 0; axis < 3; ++axis) {
            const unsigned d = c | 1U << axis;
            if (d == c || ((inside >> c ^ inside >> d) & 1U) == 0U) {
                continue;
            }
            const auto at = [&](unsigned q) {
                return grid.point(i + static_cast<int>(q & 1U), j + static_cast<int>(q >> 1U & 1U),
                                  k + static_cast<int>(q >> 2U & 1U));
            };
            const float t = corner[c] / (corner[c] - corner[d]);
            sum += at(c) + (at(d) - at(c)) * t;
            ++crossings;
        }
    }
    vertex = sum / static_cast<float>(crossings);
    return true;
}

}  // namespace

Mesh polygonise(const DistanceField& field, const std::vector<float>& xs,
                const std::vector<float>& ys, const std::vector<float>& zs) {
    const Grid grid(xs, ys, zs);
    const std::vector<float> values = sample(field, grid);
    Mesh mesh;
    std::vector<std::uint32_t> vertex_of_cell(grid.size(), kNoVertex);
    for (int k = 0; k + 1 < grid.count(2); ++k) {
        for (int j = 0; j + 1 < grid.count(1); ++j) {
            for (int i = 0; i + 1 < grid.count(0); ++i) {
                Vec3f p;
                if (!cell_vertex(grid, values, i, j, k, p)) {
                    continue;
                }
                Vec3f normal = gradient(field, p);
                for (int step = 0; step < kProjectionSteps; ++step) {
                    const float slope2 = std::max(normal.squaredNorm(), 0.05F);
                    p -= normal * (field(p) / slope2);
                    normal = gradient(field, p);
                }
                vertex_of_cell[grid.index(i, j, k)] =
                    static_cast<std::uint32_t>(mesh.positions_mm.size());
                mesh.positions_mm.push_back(p);
                mesh.normals.push_back(normal.normalized());
            }
        }
    }
    // One quad for each grid edge that crosses the surface, joining the four cells around it.
    for (int k = 1; k + 1 < grid.count(2); ++k) {
        for (int j = 1; j + 1 < grid.count(1); ++j) {
            for (int i = 1; i + 1 < grid.count(0); ++i) {
                const bool here = values[grid.index(i, j, k)] < 0.0F;
                for (int axis = 0; axis < 3; ++axis) {
                    const std::array<int, 3> e{axis == 0, axis == 1, axis == 2};
                    const bool there = values[grid.index(i + e[0], j + e[1], k + e[2])] < 0.0F;
                    if (here == there) {
                        continue;
                    }
                    const std::array<int, 3> u{axis == 2, axis == 0, axis == 1};
                    const std::array<int, 3> v{axis == 1, axis == 2, axis == 0};
                    const auto cell = [&](int a, int b) {
                        return vertex_of_cell[grid.index(i - a * u[0] - b * v[0],
                                                         j - a * u[1] - b * v[1],
                                                         k - a * u[2] - b * v[2])];
                    };
                    std::array<std::uint32_t, 4> q{cell(0, 0), cell(1, 0), cell(1, 1), cell(0, 1)};
                    if (!here) {
                        std::swap(q[1], q[3]);
                    }
                    mesh.triangles.push_back({q[0], q[1], q[2]});
                    mesh.triangles.push_back({q[0], q[2], q[3]});
                }
            }
        }
    }
    return mesh;
}

std::vector<float> grid_planes(float low, float high, float step) {
    const int cells = std::max(1, static_cast<int>(std::ceil((high - low) / step)));
    std::vector<float> planes;
    planes.reserve(static_cast<std::size_t>(cells) + 1);
    for (int i = 0; i <= cells; ++i) {
        planes.push_back(low + (high - low) * static_cast<float>(i) / static_cast<float>(cells));
    }
    return planes;
}

float distance(const TaperedCapsule& c, const Vec3f& p) {
    const Vec3f axis = c.b - c.a;
    const float t = std::clamp((p - c.a).dot(axis) / axis.squaredNorm(), 0.0F, 1.0F);
    return (p - c.a - axis * t).norm() - (c.radius_a + (c.radius_b - c.radius_a) * t);
}

float smooth_union(float a, float b, float k) {
    const float h = std::max(k - std::abs(a - b), 0.0F) / k;
    return std::min(a, b) - h * h * k * 0.25F;
}

float smooth_step(float low, float high, float x) {
    const float t = std::clamp((x - low) / (high - low), 0.0F, 1.0F);
    return t * t * (3.0F - 2.0F * t);
}

float value_noise(const Vec3f& p, std::uint64_t seed) {
    std::array<std::int64_t, 3> cell{};
    std::array<float, 3> t{};
    for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        const float floor = std::floor(p[axis]);
        cell[a] = static_cast<std::int64_t>(floor);
        t[a] = smooth_step(0.0F, 1.0F, p[axis] - floor);
    }
    float sum = 0.0F;
    for (unsigned c = 0; c < 8; ++c) {
        float weight = 1.0F;
        std::uint64_t key = seed;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const unsigned up = c >> axis & 1U;
            weight *= up != 0U ? t[axis] : 1.0F - t[axis];
            key = mix(key, static_cast<std::uint64_t>(cell[axis] + up));
        }
        sum += weight * (static_cast<float>(key >> 40U) * 0x1.0p-23F - 1.0F);
    }
    return sum;
}

}  // namespace xtrack::sim
