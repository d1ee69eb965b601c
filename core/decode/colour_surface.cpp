// SPDX-License-Identifier: Apache-2.0
#include "core/decode/colour_surface.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace xtrack {
namespace {

constexpr double kSamePhaseRad = 1e-3;
constexpr double kLeastDeterminant = 1e-3;
// Contrasts that differ by this much from what is usual count half: another surface.
constexpr float kOtherContrast = 0.15F;
// Only the second harmonic tells tint from gain, and rooms are dark beside the projector: that
// there is no tint is believed for this share of the pixels.
constexpr float kTintShare = 1.0F;
constexpr float kLeastContrast = 0.1F;
constexpr float kMostContrast = 1.05F;     // 1, and what noise adds
constexpr float kMostSeenContrast = 1.2F;  // of one pixel
constexpr float kMostLogGain = 0.4F;       // |E|; colours 3 times apart, beyond it one is missing
constexpr float kMostTint = 0.5F;

using Matrix5 = Eigen::Matrix<float, 5, 5>;
using Vector5 = Eigen::Matrix<float, 5, 1>;

// 2 Re(c e^{-ip}): what a colour has of a deviation.
float of_colour(const std::array<float, 2>& c, float cosine, float sine) noexcept {
    return 2.0F * (c[0] * cosine + c[1] * sine);
}

// What is believed already, in a linear equation for all of it.
float rest(const std::array<float, 5>& slope, const ColourSurface& believed) noexcept {
    return slope[1] * believed.log_gain[0] + slope[2] * believed.log_gain[1] +
           slope[3] * believed.tint[0] + slope[4] * believed.tint[1];
}

}  // namespace

Result<ColourModel> ColourModel::create(const std::array<double, 3>& phases_rad,
                                        const Mat3d& camera_from_projector_rgb) {
    const double turn = 2.0 * std::numbers::pi;
    const double first = std::remainder(phases_rad[1] - phases_rad[0], turn);
    const double second = std::remainder(phases_rad[2] - phases_rad[1], turn);
    if (!(std::fabs(std::fabs(first) - turn / 3.0) < kSamePhaseRad) ||
        !(std::fabs(second - first) < kSamePhaseRad)) {
        return Error{ErrorCode::invalid_argument,
                     "the phases of red, green and blue must be thirds of a turn apart"};
    }
    const Eigen::Matrix3d forward = camera_from_projector_rgb;
    if (!(std::fabs(forward.determinant()) > kLeastDeterminant)) {
        return Error{ErrorCode::invalid_argument,
                     "camera_from_projector_rgb is singular: its colours cannot be told apart; "
                     "measure it again"};
    }
    ColourModel model;
    model.projector_from_bgr_ = forward.inverse().rowwise().reverse().cast<float>();
    for (std::size_t k = 0; k < 3; ++k) {
        const double step = phases_rad[k] - phases_rad[0];
        model.steps_rad_[k] = static_cast<float>(step);
        model.cosine_[k] = static_cast<float>(std::cos(step));
        model.sine_[k] = static_cast<float>(std::sin(step));
    }
    return model;
}

ColourModel::Inverse ColourModel::inverse(const ColourSurface& surface) const noexcept {
    Eigen::Matrix3f forward;
    for (int row = 0; row < 3; ++row) {
        const auto k = static_cast<std::size_t>(row);
        const float gain = std::exp(of_colour(surface.log_gain, cosine_[k], sine_[k]));
        const float tint = of_colour(surface.tint, cosine_[k], sine_[k]);
        forward.row(row) << gain * (1.0F + tint), gain * cosine_[k], -gain * sine_[k];
    }
    return forward.inverse();
}

ColourModel::Taps ColourModel::taps(const Inverse& inverse) const noexcept {
    const Inverse from_bgr = inverse * projector_from_bgr_;
    Taps taps{};
    for (int channel = 0; channel < 3; ++channel) {
        const auto c = static_cast<std::size_t>(channel);
        taps[c] = from_bgr(1, channel);
        taps[c + 3] = from_bgr(2, channel);
    }
    return taps;
}

std::array<float, 3> ColourModel::gains(const ColourSurface& surface) const noexcept {
    std::array<float, 3> gains{};
    for (std::size_t k = 0; k < 3; ++k) {
        gains[k] = std::exp(of_colour(surface.log_gain, cosine_[k], sine_[k]));
    }
    return gains;
}

ColourSurface ColourModel::surface(const std::array<float, 3>& gains,
                                   float contrast) const noexcept {
    ColourSurface surface;
    surface.contrast = contrast;
    for (std::size_t k = 0; k < 3; ++k) {
        surface.log_gain[0] += std::log(gains[k]) * cosine_[k] / 3.0F;
        surface.log_gain[1] += std::log(gains[k]) * sine_[k] / 3.0F;
    }
    return surface;
}

void ColourFit::add(const ColourSurface& believed, const ColourModel::Light& seen,
                    float weight) noexcept {
    const float amplitude = std::sqrt(seen[1] * seen[1] + seen[2] * seen[2]);
    if (!(amplitude < kMostSeenContrast * seen[0]) || !(amplitude > 0.0F)) {
        return;
    }
    const float kappa = believed.contrast;
    const float first = 2.0F - kappa * kappa;
    const float contrast = amplitude / seen[0];
    const float c = seen[1] / amplitude;
    const float s = seen[2] / amplitude;
    const Row slope{1.0F, first * c + kappa * (c * c - s * s), kappa * 2.0F * c * s - first * s,
                    2.0F * c, -2.0F * s};
    const float other = (contrast - kappa) / kOtherContrast;
    add_equation(slope, contrast + rest(slope, believed), weight / (1.0F + other * other));
}

void ColourFit::add_equation(const Row& slope, float right, float weight) noexcept {
    std::size_t next = 0;
    for (std::size_t i = 0; i < kUnknowns; ++i) {
        for (std::size_t j = i; j < kUnknowns; ++j) {
            sums_[next++] += weight * slope[i] * slope[j];
        }
    }
    for (std::size_t i = 0; i < kUnknowns; ++i) {
        sums_[next++] += weight * slope[i] * right;
    }
}

void ColourFit::add_pair(const ColourSurface& believed, const ColourModel::Light& fine,
                         const ColourModel::Light& coarse, float ratio, float ahead_rad,
                         float weight) noexcept {
    if (!(fine.tail<2>().squaredNorm() > 0.0F) || !(coarse.tail<2>().squaredNorm() > 0.0F)) {
        return;
    }
    const float kappa = believed.contrast;
    // kappa times the error of the phase has the noise of the contrast.
    const auto phase_slope = [&](const ColourModel::Light& seen) {
        const float amplitude = std::sqrt(seen[1] * seen[1] + seen[2] * seen[2]);
        const float c = seen[1] / amplitude;
        const float s = seen[2] / amplitude;
        return Row{0.0F, -2.0F * s - kappa * 2.0F * c * s, -2.0F * c + kappa * (c * c - s * s),
                   -2.0F * s, -2.0F * c};
    };
    Row slope = phase_slope(coarse);
    const Row of_fine = phase_slope(fine);
    for (std::size_t i = 0; i < kUnknowns; ++i) {
        slope[i] -= ratio * of_fine[i];
    }
    add_equation(slope, kappa * ahead_rad + rest(slope, believed), weight);
}

void ColourFit::fade(float share) noexcept {
    for (float& sum : sums_) {
        sum *= share;
    }
}

ColourSurface ColourFit::solve(const ColourSurface& believed,
                               float believed_pixels) const noexcept {
    Matrix5 normal;
    Vector5 right;
    std::size_t next = 0;
    for (int i = 0; i < static_cast<int>(kUnknowns); ++i) {
        for (int j = i; j < static_cast<int>(kUnknowns); ++j) {
            normal(i, j) = normal(j, i) = sums_[next++];
        }
    }
    for (int i = 0; i < static_cast<int>(kUnknowns); ++i) {
        right(i) = sums_[next++];
    }
    const float tint_pixels = believed_pixels + kTintShare * sums_[0];
    Vector5 weights;
    weights << believed_pixels, believed_pixels, believed_pixels, tint_pixels, tint_pixels;
    Vector5 prior;
    prior << believed.contrast, believed.log_gain[0], believed.log_gain[1], 0.0F, 0.0F;
    normal.diagonal() += weights;
    right += weights.cwiseProduct(prior);
    const Vector5 found = normal.ldlt().solve(right);
    if (!found.allFinite()) {
        return believed;
    }
    ColourSurface surface;
    surface.contrast = std::clamp(found[0], kLeastContrast, kMostContrast);
    const float log_gain = std::hypot(found[1], found[2]);
    const float within = log_gain > kMostLogGain ? kMostLogGain / log_gain : 1.0F;
    surface.log_gain = {within * found[1], within * found[2]};
    surface.tint = {std::clamp(found[3], -kMostTint, kMostTint),
                    std::clamp(found[4], -kMostTint, kMostTint)};
    return surface;
}

}  // namespace xtrack
