// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <xtrack/depth.hpp>
#include <xtrack/geometry.hpp>
#include <xtrack/result.hpp>
#include <xtrack/rig.hpp>

namespace xtrack {

/// Triangles of a surface in the camera frame, mm.
/// @since 0.1
struct Mesh {
    bool metric = true;
    std::vector<Vec3f> vertices_mm;
    /// One a vertex: where it is in the camera's image, 0 ... 1, u to the right, v up.
    std::vector<std::array<float, 2>> texture_uv;
    /// Three indices into vertices_mm, counterclockwise as the camera sees them.
    std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// What makes neighbouring pixels one surface.
/// @since 0.1
struct MeshSettings {
    /// The corners of a triangle differ in depth by at most this share of the nearest one's, over
    /// 0 ... 1. 0.015 is 9 mm at 0.6 m: more than the noise of a period that spans a room, less
    /// than from a finger to what is behind it.
    double max_step = 0.015;
};

/// Joins pixels with their neighbours to the right and below: up to two triangles between four
/// pixels, none across a step in depth and none where there is no depth.
/// @param depth any depth image of the rig's camera; relative depth gives a relative mesh. Every
///        pixel with depth becomes a vertex, row by row, as in make_point_cloud().
/// @param rig the camera's intrinsics and distortion; nothing else of it is read
/// @return invalid_argument when sizes disagree, the camera matrix is singular or max_step is out
///         of its range; io where memory runs out
/// @thread any
/// @ownership borrows the arguments for the call
/// @since 0.1
[[nodiscard]] Result<Mesh> make_mesh(const DepthFrame& depth, const Rig& rig,
                                     const MeshSettings& settings = {});

/// Writes Wavefront OBJ, mm, and where there is a texture the material file, of the same name with
/// `.mtl`, before it. Each appears whole or not at all: it is written beside its place and renamed.
/// The image itself is the caller's to write.
/// @param texture name of an image file in the same folder; empty: no material
/// @return io, naming the file; invalid_argument for a texture that is no plain file name, and
///         where a vertex has no texture_uv or a triangle no vertex
/// @thread any
/// @since 0.1
[[nodiscard]] Result<void> write_obj(const Mesh& mesh, const std::filesystem::path& file,
                                     const std::string& texture = {});

}  // namespace xtrack
