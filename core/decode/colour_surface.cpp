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
// there is no tint is believed for so many times the pixels.
constexpr float kTintShare = 3.0F;
// That no colour is washed out more than another is believed for this share of the pixels.
constexpr float kTransferShare = 0.1F;
constexpr float kLeastContrast = 0.1F;
constexpr float kMostContrast = 1.05F;     // 1, and what noise adds
constexpr float kMostSeenContrast = 1.2F;  // of one pixel
constexpr float kMostLogGain = 0.4F;       // |E|; colours 3 times apart, beyond it one is missing
constexpr float kMostTint = 0.5F;
constexpr float kLeastTransfer = 0.3F;
constexpr float kMostLogTransfer = 0.2F;

// Where the unknowns are.
constexpr int kFineContrast = 0;
constexpr int kCoarseContrast = 1;
constexpr int kGain = 2;
constexpr int kTint = 4;
constexpr int kTransfer = 6;

// 2 Re(c e^{-ip}): what a colour has of a deviation.
float of_colour(const std::array<float, 2>& c, float cosine, float sine) noexcept {
    return 2.0F * (c[0] * cosine + c[1] * sine);
}

// What is believed already, in a linear equation for all of it.
float rest(const std::array<float, 8>& slope, const ColourSurface& believed) noexcept {
    return slope[kGain] * believed.log_gain[0] + slope[kGain + 1] * believed.log_gain[1] +
           slope[kTint] * believed.tint[0] + slope[kTint + 1] * believed.tint[1] +
           slope[kTransfer] * believed.log_transfer[0] +
           slope[kTransfer + 1] * believed.log_transfer[1];
}

// What a contrast counts that is off from what is believed.
float usual(float off) noexcept {
    const float other = off / kOtherContrast;
    return 1.0F / (1.0F + other * other);
}

// Shortened to a length.
std::array<float, 2> within(float most, float re, float im) noexcept {
    const float share = most / std::max(std::hypot(re, im), most);
    return {share * re, share * im};
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

ColourModel::Inverse ColourModel::coarse_inverse(const ColourSurface& surface) const noexcept {
    ColourSurface opaque = surface;
    opaque.log_transfer = {};
    return inverse(opaque);
}

ColourModel::Inverse ColourModel::inverse(const ColourSurface& surface) const noexcept {
    Eigen::Matrix3f forward;
    for (int row = 0; row < 3; ++row) {
        const auto k = static_cast<std::size_t>(row);
        const float gain = std::exp(of_colour(surface.log_gain, cosine_[k], sine_[k]));
        const float tint = of_colour(surface.tint, cosine_[k], sine_[k]);
        const float fringe = gain * std::exp(of_colour(surface.log_transfer, cosine_[k], sine_[k]));
        forward.row(row) << gain * (1.0F + tint), fringe * cosine_[k], -fringe * sine_[k];
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
    const float c2 = c * c - s * s;
    const float s2 = 2.0F * c * s;
    const Row slope{1.0F,     0.0F,      first * c + kappa * c2,   kappa * s2 - first * s,
                    2.0F * c, -2.0F * s, kappa * (c2 - kappa * c), kappa * (s2 + kappa * s)};
    add_equation(slope, contrast + rest(slope, believed), weight * usual(contrast - kappa));
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
    // Over a hand a long period has few phases: where its contrast is another, the light may be.
    if (coarse.tail<2>().norm() < kMostSeenContrast * coarse[0]) {
        const float contrast = coarse.tail<2>().norm() / coarse[0];
        const Row slope{0.0F, 1.0F};
        const float off = contrast - believed.contrast / believed.transfer;
        add_equation(slope, contrast, weight * usual(off));
    }
    // kappa times the error of the phase has the noise of the contrast.
    const float kappa = believed.contrast;
    const auto phase_slope = [&](const ColourModel::Light& seen, float transfer) {
        const float amplitude = std::sqrt(seen[1] * seen[1] + seen[2] * seen[2]);
        const float c = seen[1] / amplitude;
        const float s = seen[2] / amplitude;
        const float first = -2.0F * transfer;  // in a larger contrast the same weighs less
        const float c2 = kappa * (c * c - s * s);
        const float s2 = kappa * 2.0F * c * s;
        return Row{0.0F, 0.0F, first * s - s2, first * c + c2, first * s, first * c, -s2, c2};
    };
    Row slope = phase_slope(coarse, believed.transfer);
    slope[kTransfer] = slope[kTransfer + 1] = 0.0F;
    const Row of_fine = phase_slope(fine, 1.0F);
    for (std::size_t i = 0; i < kUnknowns; ++i) {
        slope[i] -= ratio * of_fine[i];
    }
    add_equation(slope, kappa * ahead_rad + rest(slope, believed), weight);
}

void ColourFit::forget(float share) noexcept {
    for (float& sum : sums_) {
        sum *= share;
    }
}

ColourSurface ColourFit::solve(const ColourSurface& believed, float believed_pixels,
                               bool may_transfer) const noexcept {
    constexpr int kCount = static_cast<int>(kUnknowns);
    Eigen::Matrix<float, kCount, kCount> normal;
    Eigen::Matrix<float, kCount, 1> right;
    std::size_t next = 0;
    for (int i = 0; i < kCount; ++i) {
        for (int j = i; j < kCount; ++j) {
            normal(i, j) = normal(j, i) = sums_[next++];
        }
    }
    for (int i = 0; i < kCount; ++i) {
        right(i) = sums_[next++];
    }
    // What nothing was seen of, stays.
    const bool transfers = may_transfer && normal(kCoarseContrast, kCoarseContrast) > 0.0F;
    constexpr float kSurely = 1e6F;
    Eigen::Matrix<float, kCount, 1> prior;
    prior << believed.contrast, believed.contrast / believed.transfer, believed.log_gain[0],
        believed.log_gain[1], believed.tint[0], believed.tint[1], believed.log_transfer[0],
        believed.log_transfer[1];
    if (!may_transfer) {
        prior.tail<2>().setZero();
    }
    Eigen::Matrix<float, kCount, 1> weights =
        Eigen::Matrix<float, kCount, 1>::Constant(believed_pixels);
    weights.tail<2>().setConstant(transfers ? believed_pixels : kSurely);
    right += weights.cwiseProduct(prior);
    weights.segment<2>(kTint).array() += kTintShare * sums_[0];
    weights.tail<2>().array() += kTransferShare * sums_[0];
    normal.diagonal() += weights;
    const Eigen::Matrix<float, kCount, 1> found = normal.ldlt().solve(right);
    if (!found.allFinite()) {
        return believed;
    }
    ColourSurface surface;
    surface.contrast = std::clamp(found[kFineContrast], kLeastContrast, kMostContrast);
    if (may_transfer) {
        surface.transfer = believed.transfer;
        surface.log_transfer = believed.log_transfer;
    }
    if (transfers) {
        const float coarse = std::max(found[kCoarseContrast], kLeastContrast);
        surface.transfer = std::clamp(surface.contrast / coarse, kLeastTransfer, 1.0F);
        surface.log_transfer = within(kMostLogTransfer, found[kTransfer], found[kTransfer + 1]);
    }
    surface.log_gain = within(kMostLogGain, found[kGain], found[kGain + 1]);
    surface.tint = {std::clamp(found[kTint], -kMostTint, kMostTint),
                    std::clamp(found[kTint + 1], -kMostTint, kMostTint)};
    return surface;
}

}  // namespace xtrack
