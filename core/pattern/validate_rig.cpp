// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string>

#include <Eigen/LU>

#include <xtrack/pattern.hpp>
#include <xtrack/rig.hpp>

namespace xtrack {

namespace {

// How far R R^T may be from one: single-precision calibrations and figures rounded to four digits
// stay well below; a matrix that is no rotation does not.
constexpr double kRotationTolerance = 1e-3;
// Relative to the size of its entries, below this a matrix is singular for our purposes.
constexpr double kSingularTolerance = 1e-9;
// Focal lengths, principal point, skew: what is larger overflows on its way through floats.
constexpr double kMaxMatrix_px = 1e6;
// Coefficients of real lenses stay below a thousand; the same bound for the same reason.
constexpr double kMaxDistortion = 1e6;
constexpr double kMinBaseline_mm = 1e-3;
constexpr double kMaxLength_mm = 1e6;

Error bad(const std::string& field, const std::string& why) {
    return {ErrorCode::invalid_argument, field + " " + why};
}

bool is_rotation(const Mat3d& m, bool may_reflect) {
    if (!((m * m.transpose() - Mat3d::Identity()).cwiseAbs().maxCoeff() < kRotationTolerance)) {
        return false;
    }
    return may_reflect || m.determinant() > 0.0;
}

bool is_singular(const Mat3d& m) {
    const double scale = m.cwiseAbs().maxCoeff();
    return !(std::abs(m.determinant()) > kSingularTolerance * scale * scale * scale);
}

Result<void> check_pinhole(const std::string& who, const Pinhole& p) {
    for (const int side : {p.size.width, p.size.height}) {
        if (side < 1 || side > kMaxImageSide_px) {
            return bad(who + "_size", "is [" + std::to_string(p.size.width) + ", " +
                                          std::to_string(p.size.height) +
                                          "]; give [width, height], each from 1 to " +
                                          std::to_string(kMaxImageSide_px));
        }
    }
    const Mat3d& m = p.matrix;
    const std::string field = who + "_matrix";
    if (!m.allFinite()) {
        return bad(field, "holds NaN or infinity; give finite numbers");
    }
    if (!(m.cwiseAbs().maxCoeff() < kMaxMatrix_px)) {
        return bad(field, "holds a number of a million or more; give pixels");
    }
    if (!(m(0, 0) > 0.0 && m(1, 1) > 0.0)) {
        return bad(field,
                   "is singular or has focal lengths (entries 0,0 and 1,1) that are not "
                   "over 0; give them in pixels");
    }
    if (m(1, 0) != 0.0 || m(2, 0) != 0.0 || m(2, 1) != 0.0 || m(2, 2) != 1.0) {
        return bad(field, "is not [fx s cx; 0 fy cy; 0 0 1]; give it in that form, row by row");
    }
    for (const double k : p.distortion) {
        if (!std::isfinite(k)) {
            return bad(who + "_distortion", "holds NaN or infinity; give k1 k2 p1 p2 k3 ...");
        }
        if (std::abs(k) > kMaxDistortion) {
            return bad(who + "_distortion", "holds a number over a million; calibrate again");
        }
    }
    return {};
}

Result<void> check_pose(const Rig& rig) {
    if (!rig.projector_from_camera_R.allFinite() ||
        !is_rotation(rig.projector_from_camera_R, false)) {
        return bad("projector_from_camera_R",
                   "is not a rotation (R R^T = 1, determinant 1); give the stereo calibration's R");
    }
    const Vec3d& t = rig.projector_from_camera_T;
    if (!t.allFinite() || t.cwiseAbs().maxCoeff() > kMaxLength_mm) {
        return bad("projector_from_camera_T", "is not finite or longer than a kilometre; give mm");
    }
    if (t.norm() < kMinBaseline_mm) {
        return bad("projector_from_camera_T",
                   "is zero: without a baseline there is no depth; give the calibration's T in mm");
    }
    return {};
}

Result<void> check_interaction(const Mat4d& m) {
    const Mat3d rotation = m.topLeftCorner<3, 3>();
    if (!m.allFinite() || !is_rotation(rotation, true) || m(3, 0) != 0.0 || m(3, 1) != 0.0 ||
        m(3, 2) != 0.0 || m(3, 3) != 1.0) {
        return bad(
            "interaction_from_camera",
            "is not rigid; give a rotation or reflection, an offset in mm, and 0 0 0 1 last");
    }
    if (m.topRightCorner<3, 1>().cwiseAbs().maxCoeff() > kMaxLength_mm) {
        return bad("interaction_from_camera", "has an offset of over a kilometre; give mm");
    }
    return {};
}

}  // namespace

Pinhole nominal_camera(Size image) noexcept {
    Pinhole camera;
    camera.size = image;
    camera.matrix(0, 0) = camera.matrix(1, 1) = image.width;
    camera.matrix(0, 2) = 0.5 * (image.width - 1);
    camera.matrix(1, 2) = 0.5 * (image.height - 1);
    return camera;
}

Result<void> validate(const Rig& rig) {
    if (auto ok = check_pinhole("camera", rig.camera); !ok) {
        return ok;
    }
    if (!is_image_size(rig.camera.size)) {
        return bad("camera_size", "is over 64 million pixels; scale the images down");
    }
    if (rig.projector) {
        if (auto ok = check_pinhole("projector", *rig.projector); !ok) {
            return ok;
        }
        if (auto ok = check_pose(rig); !ok) {
            return ok;
        }
    }
    if (rig.interaction_from_camera) {
        if (auto ok = check_interaction(*rig.interaction_from_camera); !ok) {
            return ok;
        }
    }
    if (rig.working_volume) {
        const WorkingVolume& v = *rig.working_volume;
        if (!(v.near_mm > 0.0 && v.near_mm < v.far_mm && v.far_mm < kMaxLength_mm)) {
            return bad("working_volume_mm", "is not 0 < near < far; give [near, far] in mm");
        }
    }
    if (rig.camera_from_projector_rgb) {
        const Mat3d& m = *rig.camera_from_projector_rgb;
        if (!m.allFinite() || is_singular(m)) {
            return bad(
                "camera_from_projector_rgb",
                "is singular or not finite; give rows camera R G B, columns projector R G B");
        }
    }
    return {};
}

}  // namespace xtrack
