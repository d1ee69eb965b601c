// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

#include <xtrack/depth.hpp>
#include <xtrack/geometry.hpp>
#include <xtrack/result.hpp>
#include <xtrack/rig.hpp>

namespace xtrack {

/// Points in the camera frame, mm, with a grey or colour value each.
/// @since 0.1
struct PointCloud {
    bool metric = true;
    std::vector<Vec3f> points_mm;
    std::vector<std::array<std::uint8_t, 3>> colours_rgb;  ///< empty or one a point
};

/// Every pixel that has depth, as a point of the camera frame, row by row.
/// @param depth any depth image of the rig's camera; relative depth gives a relative cloud
/// @param rig the camera's intrinsics and distortion; nothing else of it is read
/// @param grey image of the same size that colours the points, grey 0 ... 255; may be empty
/// @return invalid_argument when sizes disagree or the camera matrix is singular; io where
///         memory runs out
/// @thread any
/// @ownership borrows the arguments for the call
/// @since 0.1
[[nodiscard]] Result<PointCloud> make_point_cloud(const DepthFrame& depth, const Rig& rig,
                                                  ImageView<const float> grey = {});

/// Writes binary little-endian PLY: x y z as float, mm, and red green blue where there are colours.
/// The file appears whole or not at all: it is written beside its place and renamed.
/// @return io, naming the file; invalid_argument when colours are neither absent nor one a point
/// @thread any
/// @since 0.1
[[nodiscard]] Result<void> write_ply(const PointCloud& cloud, const std::filesystem::path& file);

/// Writes binary PCD 0.7, the format of the Point Cloud Library: x y z as float, mm, and where
/// there are colours `rgb`, packed as 0x00RRGGBB. One row of points, whole or not at all as above.
/// @return io, naming the file; invalid_argument when colours are neither absent nor one a point
/// @thread any
/// @since 0.1
[[nodiscard]] Result<void> write_pcd(const PointCloud& cloud, const std::filesystem::path& file);

}  // namespace xtrack
