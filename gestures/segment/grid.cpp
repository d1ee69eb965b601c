// SPDX-License-Identifier: Apache-2.0
#include "gestures/segment/grid.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

namespace xtrack::segment {

namespace {

/// A grid this wide resolves a finger (16 mm) with 4 pixels at 1 m and a 60 degree camera.
constexpr int kGridWidthMax = 420;
/// Pixels of a block within this of the nearest one are the same surface, mm.
constexpr float kBlockBandMm = 15.0F;
/// Of eight neighbours, so many must lie on the same surface; fewer is a flying pixel.
constexpr int kNeighboursMin = 3;
/// Of eight neighbours, so many must lie on one surface to close a pinhole between them.
constexpr int kNeighboursToClose = 4;
/// Rounds of the fixed-point inversion of the lens distortion; converges to 1e-4 px well before.
constexpr int kUndistortRounds = 20;

Vec2f undistorted(const Pinhole& camera, double x, double y) {
    const auto& k = camera.distortion;
    double u = x;
    double v = y;
    if (camera.distorted()) {
        for (int i = 0; i < kUndistortRounds; ++i) {
            const double r2 = u * u + v * v;
            const double radial = (1.0 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]))) /
                                  (1.0 + r2 * (k[5] + r2 * (k[6] + r2 * k[7])));
            const double du = 2.0 * k[2] * u * v + k[3] * (r2 + 2.0 * u * u);
            const double dv = k[2] * (r2 + 2.0 * v * v) + 2.0 * k[3] * u * v;
            u = (x - du) / radial;
            v = (y - dv) / radial;
        }
    }
    return {static_cast<float>(u), static_cast<float>(v)};
}

}  // namespace

void Grid::create(const Rig& rig, Size size) {
    scale = 1;
    while (size.width / scale > kGridWidthMax) {
        ++scale;
    }
    inner_width = size.width / scale;
    inner_height = size.height / scale;
    width = inner_width + 2 * kPad;
    height = inner_height + 2 * kPad;
    const auto n = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    z.assign(n, 0.0F);
    scratch_.assign(n, 0.0F);
    ray.assign(n, Vec2f::Zero());

    // A depth image may be a scaled version of the calibrated one.
    const Mat3d& m = rig.camera.matrix;
    const double sx =
        rig.camera.size.width > 0 ? static_cast<double>(size.width) / rig.camera.size.width : 1.0;
    const double sy = rig.camera.size.height > 0
                          ? static_cast<double>(size.height) / rig.camera.size.height
                          : 1.0;
    const double fx = m(0, 0) * sx;
    const double fy = m(1, 1) * sy;
    const double cx = (m(0, 2) + 0.5) * sx - 0.5;
    const double cy = (m(1, 2) + 0.5) * sy - 0.5;
    inverse_focal = static_cast<float>(2.0 * scale / (fx + fy));
    for (int y = 0; y < inner_height; ++y) {
        for (int x = 0; x < inner_width; ++x) {
            const double px = (x + 0.5) * scale - 0.5;
            const double py = (y + 0.5) * scale - 0.5;
            ray[static_cast<std::size_t>(index(x, y))] =
                undistorted(rig.camera, (px - cx) / fx, (py - cy) / fy);
        }
    }
}

namespace {

struct LoadRow {
    const DepthFrame& depth;
    int low = 0;
    int band = 0;
    float unit = 0.0F;
};

/// One row of the grid. `kScale` 0: the scale is not known to the compiler.
template <int kScale>
void load_row(const LoadRow& from, int any_scale, int y, int width, float* out) {
    constexpr int kNone = 1 << 20;
    const int scale = kScale > 0 ? kScale : any_scale;
    const std::uint16_t* const first = from.depth.depth.row(y * scale);
    const std::ptrdiff_t stride = from.depth.depth.row(y * scale + (scale > 1 ? 1 : 0)) - first;
    for (int x = 0; x < width; ++x) {
        int nearest = kNone;
        for (int dy = 0; dy < scale; ++dy) {
            for (int dx = 0; dx < scale; ++dx) {
                const int d = first[dy * stride + x * scale + dx];
                nearest = std::min(nearest, d >= from.low ? d : kNone);
            }
        }
        int sum = 0;
        int count = 0;
        for (int dy = 0; dy < scale; ++dy) {
            for (int dx = 0; dx < scale; ++dx) {
                const int d = first[dy * stride + x * scale + dx];
                const int same = d >= nearest && d <= nearest + from.band ? 1 : 0;
                sum += same * d;
                count += same;
            }
        }
        out[x] = from.unit * static_cast<float>(sum) / static_cast<float>(std::max(count, 1));
    }
}

}  // namespace

void Grid::load(const DepthFrame& depth, float near_mm) {
    const auto unit = static_cast<float>(depth.depth_unit_mm);
    const float lowest = std::max(1.0F, std::ceil(near_mm / unit));
    const LoadRow from{depth, static_cast<int>(lowest), static_cast<int>(kBlockBandMm / unit),
                       unit};
    // Written out for the usual scales, so that blocks are unrolled and several go at once.
    const auto row = scale == 1 ? &load_row<1> : (scale == 2 ? &load_row<2> : &load_row<0>);
    for (int y = 0; y < inner_height; ++y) {
        row(from, scale, y, inner_width, z.data() + index(0, y));
    }
    drop_lone();
    close_pinholes();
    close_pinholes();
}

void Grid::close_pinholes() {
    const std::array<int, 8> offsets = {-width - 1, -width,    -width + 1, -1,
                                        1,          width - 1, width,      width + 1};
    std::copy(z.begin(), z.end(), scratch_.begin());
    for (int y = 0; y < inner_height; ++y) {
        const int begin = index(0, y);
        for (int i = begin; i < begin + inner_width; ++i) {
            const float* here = scratch_.data() + i;
            // A pinhole has skin on two of its four sides at least; most empty pixels have none.
            const int sides = (here[-1] > 0.0F ? 1 : 0) + (here[1] > 0.0F ? 1 : 0) +
                              (here[-width] > 0.0F ? 1 : 0) + (here[width] > 0.0F ? 1 : 0);
            if (here[0] > 0.0F || sides < 2) {
                continue;
            }
            float nearest = 1e9F;
            int valid = 0;
            for (const int o : offsets) {
                const float v = scratch_[static_cast<std::size_t>(i + o)];
                if (v > 0.0F) {
                    ++valid;
                    nearest = std::min(nearest, v);
                }
            }
            if (valid < kNeighboursToClose) {
                continue;
            }
            const float limit = nearest + 2.0F * step_limit_mm(nearest);
            float sum = 0.0F;
            int count = 0;
            for (const int o : offsets) {
                const float v = scratch_[static_cast<std::size_t>(i + o)];
                const bool same = v > 0.0F && v < limit;
                sum += same ? v : 0.0F;
                count += same ? 1 : 0;
            }
            if (count >= kNeighboursToClose) {
                z[static_cast<std::size_t>(i)] = sum / static_cast<float>(count);
            }
        }
    }
}

void Grid::drop_lone() {
    std::copy(z.begin(), z.end(), scratch_.begin());
    for (int y = 0; y < inner_height; ++y) {
        const float* in = scratch_.data() + index(0, y);
        float* out = z.data() + index(0, y);
        for (int x = 0; x < inner_width; ++x) {
            const float v = in[x];
            const float limit = step_limit_mm(v);
            const auto same = [&](int o) { return std::abs(in[x + o] - v) < limit ? 1 : 0; };
            const int count = same(-width - 1) + same(-width) + same(-width + 1) + same(-1) +
                              same(1) + same(width - 1) + same(width) + same(width + 1);
            out[x] = count >= kNeighboursMin ? v : 0.0F;
        }
    }
}

}  // namespace xtrack::segment
