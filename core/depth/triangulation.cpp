// SPDX-License-Identifier: Apache-2.0
#include "core/depth/triangulation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <Eigen/LU>

#include "core/depth/distortion.hpp"

namespace xtrack {
namespace {

// Parallax between the ends of the volume below this cannot carry depth: the coordinate itself is
// known to about 0.1 px.
constexpr double kMinParallaxPx = 1.0;
// Ends of the parallax check for a rig that names no volume: a hand's range, mm.
constexpr double kTypicalNearMm = 300.0;
constexpr double kTypicalFarMm = 1500.0;
constexpr int kProjectorIterations = 5;
// A step below this leaves an error far below it: each is a few per cent of the one before, px.
constexpr double kProjectorConverged_px = 1e-3;

Error bad(const std::string& what) { return Error{ErrorCode::invalid_argument, "rig: " + what}; }

std::optional<Error> check(const Rig& rig, Size image) {
    if (!rig.projector) {
        return bad("no projector (projector_matrix); depth from fringes needs one");
    }
    if (auto valid = validate(rig); !valid) {
        return bad(valid.error().message);
    }
    if (rig.camera.size != image) {
        return bad("camera_size is " + std::to_string(rig.camera.size.width) + " x " +
                   std::to_string(rig.camera.size.height) + " but the images are " +
                   std::to_string(image.width) + " x " + std::to_string(image.height));
    }
    return std::nullopt;
}

}  // namespace

Result<Triangulation> Triangulation::create(const Rig& rig, Axis axis, Size image) {
    if (auto error = check(rig, image)) {
        return *error;
    }
    Triangulation t;
    t.size_ = image;
    t.camera_ = rig.camera;
    t.projector_ = *rig.projector;
    t.along_x_ = axis == Axis::x;
    const Eigen::Matrix3d matrix = t.projector_.matrix;
    const Eigen::Matrix3d rotation = matrix * Eigen::Matrix3d(rig.projector_from_camera_R);
    const Eigen::Vector3d shift = matrix * Eigen::Vector3d(rig.projector_from_camera_T);
    const int coded = t.along_x_ ? 0 : 1;
    const int other = 1 - coded;
    t.coded_ = rotation.row(coded).transpose();
    t.other_ = rotation.row(other).transpose();
    t.scale_ = rotation.row(2).transpose();
    t.b_ = shift(coded);
    t.b_other_ = shift(other);
    t.d_ = shift(2);
    if (rig.working_volume) {
        t.has_volume_ = true;
        t.near_mm_ = rig.working_volume->near_mm;
        t.far_mm_ = std::min(rig.working_volume->far_mm, kDefaultFarMm);
        if (t.near_mm_ >= t.far_mm_) {
            return bad("working_volume_mm begins beyond 6553.5 mm, the most a depth image holds");
        }
    }
    if (t.camera_.distorted()) {
        t.ray_x_.resize(image.width, image.height);
        t.ray_y_.resize(image.width, image.height);
        for (int v = 0; v < image.height; ++v) {
            for (int u = 0; u < image.width; ++u) {
                const RayXY r = ray_of_pixel(t.camera_, u, v);
                t.ray_x_.row(v)[u] = static_cast<float>(r.x);
                t.ray_y_.row(v)[u] = static_cast<float>(r.y);
            }
        }
    }
    t.set_steps();
    if (auto error = t.check_parallax(axis)) {
        return *error;
    }
    return t;
}

void Triangulation::set_steps() noexcept {
    if (!ray_x_.empty()) {
        return;
    }
    const int right = size_.width - 1;
    const int bottom = size_.height - 1;
    origin_ = ratio(0, 0);
    const Ratio beside = ratio(right, 0);
    const Ratio below = ratio(0, bottom);
    const double columns = std::max(right, 1);
    const double rows = std::max(bottom, 1);
    per_column_ = {(beside.a - origin_.a) / columns, (beside.c - origin_.c) / columns, 0.0};
    per_row_ = {(below.a - origin_.a) / rows, (below.c - origin_.c) / rows, 0.0};
}

std::optional<Error> Triangulation::check_parallax(Axis axis) const {
    const double nearest = has_volume_ ? near_mm_ : kTypicalNearMm;
    const double farthest = has_volume_ ? far_mm_ : kTypicalFarMm;
    double parallax = 0.0;
    constexpr int kGrid = 4;
    for (int j = 0; j <= kGrid; ++j) {
        for (int i = 0; i <= kGrid; ++i) {
            const int u = (size_.width - 1) * i / kGrid;
            const int v = (size_.height - 1) * j / kGrid;
            const double moved =
                coordinate_of_depth(u, v, nearest) - coordinate_of_depth(u, v, farthest);
            parallax = std::max(parallax, std::fabs(moved));
        }
    }
    if (parallax < kMinParallaxPx) {
        return bad(std::string("camera and projector have no baseline along the coded axis ") +
                   (axis == Axis::x ? "x" : "y") +
                   " (projector_from_camera_T); code the other axis or move the projector");
    }
    return std::nullopt;
}

Vec3d Triangulation::ray(int u, int v) const noexcept {
    if (!ray_x_.empty()) {
        return {static_cast<double>(ray_x_.at(u, v)), static_cast<double>(ray_y_.at(u, v)), 1.0};
    }
    const RayXY r = ray_of_pixel(camera_, u, v);
    return {r.x, r.y, 1.0};
}

Triangulation::Ratio Triangulation::ratio(int u, int v) const noexcept {
    const Vec3d r = ray(u, v);
    return {coded_.dot(r), scale_.dot(r), other_.dot(r)};
}

void Triangulation::prepare_row(int y, float* scratch, DepthRow& row) const noexcept {
    row.b = static_cast<float>(b_);
    row.d = static_cast<float>(d_);
    row.near_mm = static_cast<float>(near_mm_);
    row.far_mm = static_cast<float>(far_mm_);
    if (ray_x_.empty()) {
        row.a = nullptr;
        row.c = nullptr;
        row.a0 = static_cast<float>(origin_.a + y * per_row_.a);
        row.c0 = static_cast<float>(origin_.c + y * per_row_.c);
        row.a_step = static_cast<float>(per_column_.a);
        row.c_step = static_cast<float>(per_column_.c);
        return;
    }
    const float* x = ray_x_.row(y);
    const float* ry = ray_y_.row(y);
    float* a = scratch;
    float* c = scratch + size_.width;
    const Vec3f coded = coded_.cast<float>();
    const Vec3f scale = scale_.cast<float>();
    for (int i = 0; i < size_.width; ++i) {
        a[i] = coded.x() * x[i] + coded.y() * ry[i] + coded.z();
        c[i] = scale.x() * x[i] + scale.y() * ry[i] + scale.z();
    }
    row.a = a;
    row.c = c;
}

double Triangulation::lens_shift_px(const Ratio& ratio, double z_mm) const noexcept {
    const double depth = ratio.c * z_mm + d_;
    const double coded_px = (ratio.a * z_mm + b_) / depth;
    const double other_px = (ratio.a_other * z_mm + b_other_) / depth;
    const double u = along_x_ ? coded_px : other_px;
    const double v = along_x_ ? other_px : coded_px;
    const auto& m = projector_.matrix;
    const double y = (v - m(1, 2)) / m(1, 1);
    const double x = (u - m(0, 2) - m(0, 1) * y) / m(0, 0);
    const RayXY seen = distort(projector_, {x, y});
    return along_x_ ? m(0, 0) * seen.x + m(0, 1) * seen.y + m(0, 2) - coded_px
                    : m(1, 1) * seen.y + m(1, 2) - coded_px;
}

void Triangulation::undistort_projector_row(int y, int count, float* coordinate_px) const noexcept {
    if (!projector_.distorted()) {
        return;
    }
    double shift =
        0.0;  // of the pixel before: the lens is smooth, so it is nearly that of the next
    for (int u = 0; u < count; ++u) {
        const double seen = static_cast<double>(coordinate_px[u]);
        if (!std::isfinite(seen)) {
            continue;
        }
        const Ratio r = ratio(u, y);
        double ideal = seen - shift;
        for (int n = 0; n < kProjectorIterations; ++n) {
            const double z = (d_ * ideal - b_) / (r.a - r.c * ideal);
            const double moved = lens_shift_px(r, z);
            if (!std::isfinite(moved)) {
                break;
            }
            const double change = std::fabs(moved - shift);
            shift = moved;
            ideal = seen - shift;
            if (change < kProjectorConverged_px) {
                break;
            }
        }
        coordinate_px[u] = static_cast<float>(ideal);
    }
}

double Triangulation::coordinate_of_depth(double u, double v, double z_mm) const noexcept {
    const RayXY direction = ray_of_pixel(camera_, u, v);
    const Vec3d seen(direction.x, direction.y, 1.0);
    const Ratio r{coded_.dot(seen), scale_.dot(seen), other_.dot(seen)};
    const double ideal = (r.a * z_mm + b_) / (r.c * z_mm + d_);
    return projector_.distorted() ? ideal + lens_shift_px(r, z_mm) : ideal;
}

void Triangulation::coordinate_of_depth_row(int y, int count, const std::uint16_t* depth,
                                            double unit_mm, float* coordinate_px) const noexcept {
    for (int u = 0; u < count; ++u) {
        coordinate_px[u] = depth[u] == 0
                               ? std::numeric_limits<float>::quiet_NaN()
                               : static_cast<float>(coordinate_of_depth(u, y, depth[u] * unit_mm));
    }
}

std::optional<VolumeReach> Triangulation::reach(int u, int v) const noexcept {
    if (!has_volume_) {
        return std::nullopt;
    }
    return VolumeReach{coordinate_of_depth(u, v, near_mm_), coordinate_of_depth(u, v, far_mm_)};
}

}  // namespace xtrack
