// SPDX-License-Identifier: Apache-2.0
#include "tools/decode_exports.hpp"

#include <string>

#include <xtrack/mesh.hpp>
#include <xtrack/point_cloud.hpp>

#include "core/base/file.hpp"
#include "tools/decode_pictures.hpp"

namespace xtrack::tools {

namespace {

constexpr const char* kTexture = "mesh.png";

Result<void> write_mesh(const DepthFrame& depth, const Rig& rig, ImageView<const float> average,
                        const std::filesystem::path& folder) {
    const auto mesh = make_mesh(depth, rig);
    if (!mesh) {
        return mesh.error();
    }
    if (average.empty()) {
        return write_obj(*mesh, folder / "mesh.obj");
    }
    const auto png = grey_png(average);
    if (!png) {
        return png.error();
    }
    if (auto ok = base::write_file(folder / kTexture, *png); !ok) {
        return ok;
    }
    return write_obj(*mesh, folder / "mesh.obj", kTexture);
}

}  // namespace

Result<void> write_exports(const std::set<Export>& wanted, const DepthFrame& depth, const Rig& rig,
                           ImageView<const float> average, const std::filesystem::path& folder) {
    if (wanted.contains(Export::ply) || wanted.contains(Export::pcd)) {
        const auto cloud = make_point_cloud(depth, rig, average);
        if (!cloud) {
            return cloud.error();
        }
        if (wanted.contains(Export::ply)) {
            if (auto ok = write_ply(*cloud, folder / "cloud.ply"); !ok) {
                return ok;
            }
        }
        if (wanted.contains(Export::pcd)) {
            if (auto ok = write_pcd(*cloud, folder / "cloud.pcd"); !ok) {
                return ok;
            }
        }
    }
    return wanted.contains(Export::obj) ? write_mesh(depth, rig, average, folder) : Result<void>();
}

}  // namespace xtrack::tools
