// SPDX-License-Identifier: Apache-2.0
#include "gestures/segment/grid.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

#include "gestures/segment/block_row.hpp"

namespace xtrack::segment {

namespace {

/// Pixels of a block within this of the nearest one are the same surface, mm.
constexpr float kBlockBandMm = 15.0F;
/// Of eight neighbours, so many must lie on the same surface; fewer is a flying pixel.
constexpr int kNeighboursMin = 3;
/// Of eight neighbours, so many must lie on one surface to close a pinhole between them.
constexpr int kNeighboursToClose = 4;
/// More steps of depth than this would not fit the sums of a block's pixels.
constexpr float kBandMaxSteps = 65535.0F / (2 * kBlockSamples * kBlockSamples);
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

/// The first pixel without depth from one on; `end` where none before that is.
int next_empty(const float* z, int i, int end) {
    // Most have depth, so many are looked at at once.
    constexpr int kAtOnce = 8;
    for (; i + kAtOnce <= end; i += kAtOnce) {
        bool any = false;
        for (int k = 0; k < kAtOnce; ++k) {
            any |= z[i + k] <= 0.0F;
        }
        if (any) {
            break;
        }
    }
    while (i < end && z[i] > 0.0F) {
        ++i;
    }
    return i;
}

}  // namespace

void Grid::create(const Rig& rig, Size size, int block_scale, int step_scale) {
    scale = block_scale;
    inner_width = size.width / scale;
    inner_height = size.height / scale;
    width = inner_width + 2 * kPad;
    height = inner_height + 2 * kPad;
    const auto n = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    z.assign(n, 0.0F);
    blocks_.assign(n, 0.0F);
    kept_.assign(n, 0.0F);
    closed_.assign(n, 0.0F);
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
    step_slope = kSteepest * static_cast<float>(2.0 * step_scale / (fx + fy));
    for (int y = 0; y < inner_height; ++y) {
        for (int x = 0; x < inner_width; ++x) {
            const double px = (x + 0.5) * scale - 0.5;
            const double py = (y + 0.5) * scale - 0.5;
            ray[static_cast<std::size_t>(index(x, y))] =
                undistorted(rig.camera, (px - cx) / fx, (py - cy) / fy);
        }
    }
}

void Grid::load(const DepthFrame& depth, float near_mm, const Box& box) {
    // Each step looks at a pixel's neighbours, so what it is made from is wider.
    const Box closing = grown(box, 1);
    const Box keeping = grown(box, 2);
    const Box loading = grown(box, 3);
    const auto unit = static_cast<float>(depth.depth_unit_mm);
    BlockRow row;
    row.scale = scale;
    row.count = loading.width();
    row.low = static_cast<std::uint16_t>(std::clamp(std::ceil(near_mm / unit), 1.0F, 65534.0F));
    row.band = static_cast<std::uint16_t>(std::min(kBlockBandMm / unit, kBandMaxSteps));
    row.unit_mm = unit;
    row.stride = depth.depth.height() > 1 ? depth.depth.row(1) - depth.depth.row(0) : 0;
    for (int y = loading.y_begin; y < loading.y_end; ++y) {
        row.depth = depth.depth.row(y * scale) + loading.x_begin * scale;
        row.z_mm = blocks_.data() + index(loading.x_begin, y);
        block_row(row);
    }
    drop_lone(keeping, blocks_, kept_);
    close_pinholes(closing, kept_, closed_);
    close_pinholes(box, closed_, z);
}

float Grid::area_mm2(int begin, int end) const noexcept {
    // Four sums, as one would wait for every addition.
    std::array<float, 4> sums{};
    int i = begin;
    for (; i + 4 <= end; i += 4) {
        for (std::size_t k = 0; k < sums.size(); ++k) {
            const float v = z[static_cast<std::size_t>(i) + k];
            sums[k] += v * v;
        }
    }
    for (; i < end; ++i) {
        sums[0] += z[static_cast<std::size_t>(i)] * z[static_cast<std::size_t>(i)];
    }
    return ((sums[0] + sums[1]) + (sums[2] + sums[3])) * inverse_focal * inverse_focal;
}

void Grid::close_pinholes(const Box& box, const std::vector<float>& from,
                          std::vector<float>& to) const {
    const std::array<int, 8> offsets = {-width - 1, -width,    -width + 1, -1,
                                        1,          width - 1, width,      width + 1};
    for (int y = box.y_begin; y < box.y_end; ++y) {
        const int begin = index(box.x_begin, y);
        const int end = index(box.x_end, y);
        std::copy(from.begin() + begin, from.begin() + end, to.begin() + begin);
        for (int i = next_empty(from.data(), begin, end); i < end;
             i = next_empty(from.data(), i + 1, end)) {
            const float* here = from.data() + i;
            // A pinhole has skin on two of its four sides at least; most empty pixels have none.
            const int sides = (here[-1] > 0.0F ? 1 : 0) + (here[1] > 0.0F ? 1 : 0) +
                              (here[-width] > 0.0F ? 1 : 0) + (here[width] > 0.0F ? 1 : 0);
            if (sides < 2) {
                continue;
            }
            float nearest = 1e9F;
            int valid = 0;
            for (const int o : offsets) {
                const float v = here[o];
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
                const float v = here[o];
                const bool same = v > 0.0F && v < limit;
                sum += same ? v : 0.0F;
                count += same ? 1 : 0;
            }
            if (count >= kNeighboursToClose) {
                to[static_cast<std::size_t>(i)] = sum / static_cast<float>(count);
            }
        }
    }
}

void Grid::drop_lone(const Box& box, const std::vector<float>& from, std::vector<float>& to) const {
    for (int y = box.y_begin; y < box.y_end; ++y) {
        const float* in = from.data() + index(box.x_begin, y);
        float* out = to.data() + index(box.x_begin, y);
        for (int x = 0; x < box.width(); ++x) {
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
