// SPDX-License-Identifier: Apache-2.0
#include "core/unwrap/reference_plane.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace xtrack {
namespace {

constexpr std::size_t kLeastPixels = 500;
constexpr int kWantedPixels = 20000;
constexpr int kRounds = 20;
// A robust scale of the residuals, in which half a fringe more is far: never below this, rad.
constexpr double kLeastScale_rad = 0.02;
constexpr double kSigmaOfMedian = 1.4826;
// What stands before a wall is seldom seen along all of the image's border: this share of the
// image on each side says which plane is meant.
constexpr double kBorderShare = 0.1;

using Vector5 = Eigen::Matrix<double, 5, 1>;
using Matrix5 = Eigen::Matrix<double, 5, 5>;

struct Sample {
    double u;
    double v;
    double phase;
    bool at_border;
};

double median(std::vector<double>& values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

}  // namespace

std::optional<ReferencePlane> ReferencePlane::fit(ImageView<const float> phase_rad,
                                                  ImageView<const std::uint16_t> component,
                                                  std::uint16_t id) {
    ReferencePlane plane;
    plane.half_width_px_ = std::max(1.0, 0.5 * phase_rad.width);
    plane.half_height_px_ = std::max(1.0, 0.5 * phase_rad.height);
    const double pixels = static_cast<double>(phase_rad.width) * phase_rad.height;
    const int stride = std::max(1, static_cast<int>(std::sqrt(pixels / kWantedPixels)));
    std::vector<Sample> samples;
    std::size_t border = 0;
    for (int y = 0; y < phase_rad.height; y += stride) {
        for (int x = 0; x < phase_rad.width; x += stride) {
            if (component.at(x, y) == id && std::isfinite(phase_rad.at(x, y))) {
                const double u = x / plane.half_width_px_ - 1.0;
                const double v = y / plane.half_height_px_ - 1.0;
                const bool at_border =
                    std::max(std::fabs(u), std::fabs(v)) > 1.0 - 2.0 * kBorderShare;
                samples.push_back({u, v, static_cast<double>(phase_rad.at(x, y)), at_border});
                border += at_border ? 1U : 0U;
            }
        }
    }
    if (samples.size() * static_cast<std::size_t>(stride) * static_cast<std::size_t>(stride) <
        kLeastPixels) {
        return std::nullopt;
    }
    const bool by_border =
        border * static_cast<std::size_t>(stride) * static_cast<std::size_t>(stride) >=
        kLeastPixels;
    std::vector<double> residuals(samples.size(), 0.0);
    std::vector<double> distances;
    double scale = 0.0;  // 0: the first round
    for (int round = 0; round < kRounds; ++round) {
        Matrix5 normal = Matrix5::Zero();
        Vector5 right = Vector5::Zero();
        for (std::size_t i = 0; i < samples.size(); ++i) {
            const Sample& s = samples[i];
            const double far = scale > 0.0 ? residuals[i] / scale : 0.0;
            const bool counts = scale > 0.0 || !by_border || s.at_border;
            // Geman and McClure's: what is far off must not pull at all.
            const double trust = 1.0 / (1.0 + far * far);
            const double weight = counts ? trust * trust : 0.0;
            Vector5 row;
            row << 1.0, s.u, s.v, -s.phase * s.u, -s.phase * s.v;
            normal += weight * row * row.transpose();
            right += weight * s.phase * row;
        }
        // One line of pixels leaves terms open; they then stay near zero.
        constexpr double kRidge = 1e-9;
        normal.diagonal().array() += kRidge * normal.trace();
        const Vector5 found = normal.ldlt().solve(right);
        if (!found.allFinite()) {
            return std::nullopt;
        }
        std::copy_n(found.data(), plane.terms_.size(), plane.terms_.begin());
        distances.clear();
        for (std::size_t i = 0; i < samples.size(); ++i) {
            const Sample& s = samples[i];
            const double below = 1.0 + found[3] * s.u + found[4] * s.v;
            residuals[i] = s.phase - (found[0] + found[1] * s.u + found[2] * s.v) / below;
            if (!by_border || s.at_border) {
                distances.push_back(std::fabs(residuals[i]));
            }
        }
        scale = std::max(kLeastScale_rad, kSigmaOfMedian * median(distances));
    }
    return plane;
}

double ReferencePlane::at(int x, int y) const noexcept {
    const double u = x / half_width_px_ - 1.0;
    const double v = y / half_height_px_ - 1.0;
    return (terms_[0] + terms_[1] * u + terms_[2] * v) / (1.0 + terms_[3] * u + terms_[4] * v);
}

}  // namespace xtrack
