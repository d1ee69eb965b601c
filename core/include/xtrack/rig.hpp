// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include <xtrack/geometry.hpp>
#include <xtrack/result.hpp>

namespace xtrack {

/// A pinhole with OpenCV's distortion; a projector is the same thing the other way round.
/// @since 0.1
struct Pinhole {
    Mat3d matrix = Mat3d::Identity();    ///< focal lengths and principal point, px
    std::array<double, 8> distortion{};  ///< k1 k2 p1 p2 k3 k4 k5 k6, OpenCV's order
    Size size;

    [[nodiscard]] bool distorted() const noexcept {
        for (const double k : distortion) {
            if (k != 0.0) {
                return true;
            }
        }
        return false;
    }
};

/// Camera Z that can occur, mm.
/// @since 0.1
struct WorkingVolume {
    double near_mm = 0.0;
    double far_mm = 0.0;
};

/// A calibrated camera, the projector beside it, and where the user stands.
/// p_projector = projector_from_camera_R * p_camera + projector_from_camera_T, mm.
/// @since 0.1
struct Rig {
    Pinhole camera;
    std::optional<Pinhole> projector;  ///< absent for a plain depth camera
    Mat3d projector_from_camera_R = Mat3d::Identity();
    Vec3d projector_from_camera_T = Vec3d::Zero();
    /// 4x4, row i column j; a camera that faces the user has diag(-1, -1, 1) plus an offset. A
    /// reflection (determinant < 0) says that the image is mirrored.
    std::optional<Mat4d> interaction_from_camera;
    std::optional<WorkingVolume> working_volume;
    /// linear; rows camera R, G, B, columns projector R, G, B
    std::optional<Mat3d> camera_from_projector_rgb;
};

/// A camera that nobody has calibrated: its image is as wide as what it sees is far, the principal
/// point in the middle, no distortion.
/// @thread any
/// @since 0.1
[[nodiscard]] Pinhole nominal_camera(Size image) noexcept;

/// Checks what a computation relies on: sizes, finite numbers, focal lengths over 0, matrices that
/// can be inverted, a rotation that is one, a baseline that is not zero, near before far.
/// @return an Error that names the field as rig.yaml spells it, and the mend
/// @thread any
/// @since 0.1
[[nodiscard]] Result<void> validate(const Rig& rig);

}  // namespace xtrack
