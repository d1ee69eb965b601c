// SPDX-License-Identifier: Apache-2.0
#include "core/decode/taps.hpp"

#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include <Eigen/Dense>

namespace xtrack {
namespace {

using Complex = std::complex<double>;

// Below this the phases hardly differ and noise would be magnified without bound (ratio of the
// smallest to the largest singular value, no unit).
constexpr double kMinConditioning = 1e-3;

std::vector<double> zeros_of(TapDesign design, double step_rad) {
    const double mirror = -step_rad;
    switch (design) {
        case TapDesign::three: return {0.0, mirror};
        case TapDesign::three_plus_one: return {0.0, mirror, mirror};
        case TapDesign::three_plus_two: return {0.0, 0.0, mirror, mirror};
        case TapDesign::four: return {0.0, mirror, std::numbers::pi};
        case TapDesign::four_plus_one: return {0.0, mirror, mirror, std::numbers::pi};
    }
    return {};
}

}  // namespace

double TapSet::noise_gain() const noexcept {
    double power = 0.0;
    for (int n = 0; n < count; ++n) {
        const Tap& tap = taps[static_cast<std::size_t>(n)];
        power += static_cast<double>(tap.re) * static_cast<double>(tap.re) +
                 static_cast<double>(tap.im) * static_cast<double>(tap.im);
    }
    return std::sqrt(power / 2.0);
}

int tap_count(TapDesign design) noexcept {
    switch (design) {
        case TapDesign::three: return 3;
        case TapDesign::three_plus_one: return 4;
        case TapDesign::three_plus_two: return 5;
        case TapDesign::four: return 4;
        case TapDesign::four_plus_one: return 5;
    }
    return 0;
}

Result<TapSet> design_taps(TapDesign design, double step_rad, double first_phase_rad) {
    std::vector<Complex> polynomial{1.0};  // ascending powers of u
    for (const double zero : zeros_of(design, step_rad)) {
        const Complex root = std::polar(1.0, zero);
        polynomial.push_back(0.0);
        for (std::size_t n = polynomial.size() - 1; n > 0; --n) {
            polynomial[n] = polynomial[n - 1] - root * polynomial[n];
        }
        polynomial[0] *= -root;
    }
    Complex response = 0.0;
    for (std::size_t n = 0; n < polynomial.size(); ++n) {
        response += polynomial[n] * std::polar(1.0, static_cast<double>(n) * step_rad);
    }
    if (!std::isfinite(step_rad) || !(std::abs(response) > kMinConditioning)) {
        return Error{ErrorCode::invalid_argument,
                     "phase step of " + std::to_string(step_rad) +
                         " rad between patterns cannot be told from the background; use a step "
                         "near 2 pi / 3 or pi / 2"};
    }
    const Complex scale = 2.0 / response * std::polar(1.0, -first_phase_rad);
    TapSet set;
    set.count = static_cast<int>(polynomial.size());
    for (std::size_t n = 0; n < polynomial.size(); ++n) {
        const Complex c = polynomial[n] * scale;
        set.taps[n].re = static_cast<float>(c.real());
        set.taps[n].im = static_cast<float>(c.imag());
    }
    return set;
}

Result<TapSet> least_squares_taps(std::span<const double> phases_rad) {
    const std::size_t count = phases_rad.size();
    if (count < 3 || count > kMaxTaps) {
        return Error{ErrorCode::invalid_argument,
                     std::to_string(count) + " phases of one period; phase shifting needs 3 to " +
                         std::to_string(kMaxTaps)};
    }
    for (const double phase : phases_rad) {
        if (!std::isfinite(phase)) {
            return Error{ErrorCode::invalid_argument, "a pattern's phase is not a number"};
        }
    }
    TapSet set;
    if (!fit_taps(phases_rad, set)) {
        return Error{ErrorCode::invalid_argument,
                     "the phases of a period are too alike to determine offset, amplitude and "
                     "phase; use at least three spread over the circle"};
    }
    return set;
}

bool fit_taps(std::span<const double> phases_rad, TapSet& set) noexcept {
    if (phases_rad.size() < 3 || phases_rad.size() > kMaxTaps) {
        return false;
    }
    // I_n = A + (B cos phi) cos(phase_n) - (B sin phi) sin(phase_n)
    const auto row = [](double phase) {
        return Eigen::Vector3d(1.0, std::cos(phase), -std::sin(phase));
    };
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    for (const double phase : phases_rad) {
        normal += row(phase) * row(phase).transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(normal);
    const Eigen::Vector3d& values = solver.eigenvalues();  // ascending squares of singular values
    if (!(values(0) > kMinConditioning * kMinConditioning * values(2))) {
        return false;
    }
    const Eigen::Matrix3d inverse = solver.eigenvectors() * values.cwiseInverse().asDiagonal() *
                                    solver.eigenvectors().transpose();
    set.count = static_cast<int>(phases_rad.size());
    for (std::size_t n = 0; n < phases_rad.size(); ++n) {
        const Eigen::Vector3d solution = inverse * row(phases_rad[n]);
        set.taps[n] = {};
        set.taps[n].re = static_cast<float>(solution(1));
        set.taps[n].im = static_cast<float>(solution(2));
    }
    return true;
}

}  // namespace xtrack
