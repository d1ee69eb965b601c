// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include <xtrack/geometry.hpp>
#include <xtrack/image.hpp>
#include <xtrack/pattern.hpp>
#include <xtrack/result.hpp>
#include <xtrack/rig.hpp>

#include "core/depth/depth_row.hpp"

namespace xtrack {

/// Depth nearer than this is not looked for when the rig names no working volume, mm.
inline constexpr double kDefaultNearMm = 1.0;
/// The most that a u16 of 0.1 mm holds, mm.
inline constexpr double kDefaultFarMm = 6553.5;

/// Coordinates along the coded axis that a pixel can see, projector px, at the two ends of the
/// working volume.
struct VolumeReach {
    double near_px = 0.0;
    double far_px = 0.0;
};

/// The geometry of one rig, one coded axis and one image size, prepared for rows of pixels.
/// A table of rays is kept only when the camera's lens is distorted; else rays are affine.
/// @thread const calls from any; rows are independent
class Triangulation {
 public:
    /// @return invalid_argument for a rig that validate() refuses or that has no projector, an
    ///         image of another size than the rig's camera, or a baseline without component along
    ///         the coded axis (depth would not move the pattern)
    [[nodiscard]] static Result<Triangulation> create(const Rig& rig, Axis axis, Size image);

    /// Fills `row`'s geometry for image row y; the caller sets count, inputs and outputs. The row
    /// borrows `scratch` (2 * width floats) when the camera is distorted.
    void prepare_row(int y, float* scratch, DepthRow& row) const noexcept;

    /// Projector pixels as seen -> as without the projector's lens, in place. Needs both of a
    /// point's coordinates, of which one is measured, so the depth is found alongside by
    /// fixed-point iteration. Does nothing for a projector without distortion.
    void undistort_projector_row(int y, int count, float* coordinate_px) const noexcept;

    /// Coordinate that a point at depth z_mm in pixel (u, v) has, as the projector shows it.
    [[nodiscard]] double coordinate_of_depth(double u, double v, double z_mm) const noexcept;

    /// A row of coordinate_of_depth() from depth in steps of unit_mm; 0 gives NaN.
    void coordinate_of_depth_row(int y, int count, const std::uint16_t* depth, double unit_mm,
                                 float* coordinate_px) const noexcept;

    /// What the working volume can reach in a pixel; empty when the rig names no volume.
    [[nodiscard]] std::optional<VolumeReach> reach(int u, int v) const noexcept;

    [[nodiscard]] bool projector_distorted() const noexcept { return projector_.distorted(); }

 private:
    struct Ratio {  // a, c of one pixel, and the same for the other projector axis
        double a = 0.0;
        double c = 0.0;
        double a_other = 0.0;
    };
    [[nodiscard]] Vec3d ray(int u, int v) const noexcept;
    [[nodiscard]] Ratio ratio(int u, int v) const noexcept;
    /// How far the projector's lens moves the coordinate of a point at depth z, px.
    [[nodiscard]] double lens_shift_px(const Ratio& ratio, double z_mm) const noexcept;
    void set_steps() noexcept;
    [[nodiscard]] std::optional<Error> check_parallax(Axis axis) const;

    Size size_;
    Pinhole camera_;
    Pinhole projector_;
    bool along_x_ = true;
    Vec3d coded_ = Vec3d::Zero();  // rows of K_p [R | T], left 3x3
    Vec3d other_ = Vec3d::Zero();
    Vec3d scale_ = Vec3d::Zero();
    double b_ = 0.0;
    double b_other_ = 0.0;
    double d_ = 0.0;
    bool has_volume_ = false;
    double near_mm_ = kDefaultNearMm;
    double far_mm_ = kDefaultFarMm;
    Ratio origin_, per_column_, per_row_;  // without camera distortion, a and c are affine
    Image<float> ray_x_;                   // empty without camera distortion
    Image<float> ray_y_;
};

}  // namespace xtrack
