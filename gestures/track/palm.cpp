// SPDX-License-Identifier: Apache-2.0
#include "gestures/track/palm.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

namespace xtrack::track {

namespace {

constexpr float kDiscRadii = 0.9F;
constexpr int kSkinMin = 12;
/// So many of the pixels along a radius say what all of them do.
constexpr float kSamplesAcross = 8.0F;
/// Second fit: skin farther than this from the first plane is a finger folded over it, mm.
constexpr float kOutlierMm = 12.0F;

struct Plane {
    Eigen::Vector3f mean = Eigen::Vector3f::Zero();
    Eigen::Vector3f normal = Eigen::Vector3f::Zero();
    bool good = false;
};

template <typename Keep>
Plane fit(const segment::Grid& grid, std::span<const std::uint8_t> labels, const HandRegion& region,
          Keep&& keep) {
    const float disc = kDiscRadii * region.palm_radius_px;
    const int reach = static_cast<int>(disc);
    const int step = std::max(1, static_cast<int>(disc / kSamplesAcross));
    const int cx = static_cast<int>(std::lround(region.palm_px.x()));
    const int cy = static_cast<int>(std::lround(region.palm_px.y()));
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    Eigen::Matrix3f squares = Eigen::Matrix3f::Zero();
    int n = 0;
    for (int y = std::max(0, cy - reach); y <= std::min(grid.inner_height - 1, cy + reach);
         y += step) {
        for (int x = std::max(0, cx - reach); x <= std::min(grid.inner_width - 1, cx + reach);
             x += step) {
            const int i = grid.index(x, y);
            const auto dx = static_cast<float>(x - cx);
            const auto dy = static_cast<float>(y - cy);
            if (labels[static_cast<std::size_t>(i)] != region.label ||
                dx * dx + dy * dy > disc * disc) {
                continue;
            }
            const Eigen::Vector3f d = grid.point(i) - region.palm_mm;
            if (!keep(d)) {
                continue;
            }
            sum += d;
            squares += d * d.transpose();
            ++n;
        }
    }
    Plane plane;
    if (n < kSkinMin) {
        return plane;
    }
    plane.mean = sum / static_cast<float>(n);
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solver;
    solver.computeDirect(squares / static_cast<float>(n) - plane.mean * plane.mean.transpose());
    plane.normal = solver.eigenvectors().col(0);
    plane.good = plane.normal.allFinite() && plane.normal.norm() > 0.5F;
    return plane;
}

}  // namespace

Vec3f fit_palm_normal(const segment::Grid& grid, std::span<const std::uint8_t> labels,
                      const HandRegion& region) {
    const Plane rough = fit(grid, labels, region, [](const Eigen::Vector3f&) { return true; });
    if (!rough.good) {
        return Vec3f::Zero();
    }
    const Plane fine = fit(grid, labels, region, [&](const Eigen::Vector3f& d) {
        return std::abs((d - rough.mean).dot(rough.normal)) < kOutlierMm;
    });
    Vec3f normal = fine.good ? Vec3f(fine.normal) : Vec3f(rough.normal);
    if (normal.dot(region.palm_mm) > 0.0F) {
        normal = -normal;
    }
    return normal.normalized();
}

}  // namespace xtrack::track
