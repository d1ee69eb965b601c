// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <set>

#include <xtrack/depth.hpp>
#include <xtrack/result.hpp>
#include <xtrack/rig.hpp>

namespace xtrack::tools {

/// The forms in which `decode` leaves its points.
enum class Export { ply, pcd, obj };

/// Writes cloud.ply, cloud.pcd, or mesh.obj with mesh.mtl and mesh.png into `folder`.
/// @param average the scene without fringes, which colours points and mesh; may be empty
[[nodiscard]] Result<void> write_exports(const std::set<Export>& wanted, const DepthFrame& depth,
                                         const Rig& rig, ImageView<const float> average,
                                         const std::filesystem::path& folder);

}  // namespace xtrack::tools
