// SPDX-License-Identifier: Apache-2.0
#include <xtrack/mesh.hpp>

#include <algorithm>
#include <cmath>

#include <xtrack/point_cloud.hpp>

#include "core/base/setting_up.hpp"

namespace xtrack {

namespace {

// A pixel as a corner of triangles.
struct Corner {
    double depth = 0.0;  // steps; 0 = none
    std::uint32_t vertex = 0;
};

class Triangulate {
 public:
    Triangulate(Mesh& mesh, double max_step) : mesh_(mesh), max_step_(max_step) {}

    // Four pixels: `a` `b` above `c` `d`.
    void join(const Corner& a, const Corner& b, const Corner& c, const Corner& d) {
        // Cut along the diagonal that is flatter, so that a crease is kept.
        if (step(a, d) <= step(b, c)) {
            add(a, c, d);
            add(a, d, b);
        } else {
            add(a, c, b);
            add(b, c, d);
        }
    }

 private:
    // No diagonal begins where there is no depth.
    static double step(const Corner& from, const Corner& to) {
        return from.depth == 0.0 || to.depth == 0.0 ? HUGE_VAL : std::fabs(from.depth - to.depth);
    }

    void add(const Corner& a, const Corner& b, const Corner& c) {
        const auto [near, far] = std::minmax({a.depth, b.depth, c.depth});
        if (near > 0.0 && far - near <= max_step_ * near) {
            mesh_.triangles.push_back({a.vertex, b.vertex, c.vertex});
        }
    }

    Mesh& mesh_;
    double max_step_;
};

Mesh fill(const Image<std::uint16_t>& depth, PointCloud cloud, double max_step) {
    Mesh mesh;
    mesh.metric = cloud.metric;
    mesh.vertices_mm = std::move(cloud.points_mm);
    mesh.texture_uv.reserve(mesh.vertices_mm.size());
    mesh.triangles.reserve(2 * mesh.vertices_mm.size());
    Triangulate triangulate(mesh, max_step);
    const auto width = static_cast<std::size_t>(depth.width());
    std::vector<Corner> above(width);
    std::vector<Corner> row(width);
    for (int v = 0; v < depth.height(); ++v) {
        for (std::size_t u = 0; u < width; ++u) {
            row[u].depth = depth.at(static_cast<int>(u), v);
            row[u].vertex = static_cast<std::uint32_t>(mesh.texture_uv.size());
            if (row[u].depth != 0.0) {
                // Of the pixel's centre; images count rows from the top, textures from the bottom.
                mesh.texture_uv.push_back(
                    {(static_cast<float>(u) + 0.5F) / static_cast<float>(width),
                     1.0F - (static_cast<float>(v) + 0.5F) / static_cast<float>(depth.height())});
            }
        }
        for (std::size_t u = 0; v > 0 && u + 1 < width; ++u) {
            triangulate.join(above[u], above[u + 1], row[u], row[u + 1]);
        }
        std::swap(above, row);
    }
    return mesh;
}

}  // namespace

Result<Mesh> make_mesh(const DepthFrame& depth, const Rig& rig, const MeshSettings& settings) {
    if (!(settings.max_step > 0.0 && settings.max_step <= 1.0)) {
        return Error{ErrorCode::invalid_argument, "mesh: max_step must be over 0 and at most 1"};
    }
    auto cloud = make_point_cloud(depth, rig);
    if (!cloud) {
        return cloud.error();
    }
    return base::setting_up("make_mesh", [&]() -> Result<Mesh> {
        return fill(depth.depth, std::move(*cloud), settings.max_step);
    });
}

}  // namespace xtrack
