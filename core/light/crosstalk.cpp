// SPDX-License-Identifier: Apache-2.0
#include "core/light/crosstalk.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace xtrack {
namespace {

constexpr int kRounds = 10;
constexpr int kGainRounds = 60;
// Three sigma of a normal distribution, by the median of the length of three errors.
constexpr float kStray = 2.9F;

// Light of pixels without blur.
class Lights {
 public:
    Lights(std::span<const ColourPixel> pixels, const std::array<ResponseCurve, 3>& responses) {
        constexpr int kSteps = 64;  // of a fringe
        for (int k = 0; k < 3; ++k) {
            const ResponseCurve& response = responses[static_cast<std::size_t>(k)];
            for (int i = 0; i < kSteps; ++i) {
                const double turn = 2.0 * std::numbers::pi * i / kSteps;
                mean_[k] += response.light(0.5 + 0.5 * std::cos(turn)) / kSteps;
            }
        }
        swings_.reserve(pixels.size());
        for (const ColourPixel& pixel : pixels) {
            Vec3d& swing = swings_.emplace_back();
            for (std::size_t k = 0; k < 3; ++k) {
                const auto at = static_cast<Eigen::Index>(k);
                swing[at] = responses[k].light(static_cast<double>(pixel.value[k])) - mean_[at];
            }
        }
    }
    /// What does not depend on contrast: the mean of a whole fringe, and ambient light.
    [[nodiscard]] Vec3d steady(const ColourPixel& pixel) const {
        return (mean_.array() + static_cast<double>(pixel.ambient)).matrix();
    }
    /// What the fringe adds to it.
    [[nodiscard]] const Vec3d& swing(std::size_t pixel) const { return swings_[pixel]; }

 private:
    Vec3d mean_ = Vec3d::Zero();
    std::vector<Vec3d> swings_;
};

Vec3d share_of(const ColourPixel& pixel) {
    return Vec3f(pixel.share[0], pixel.share[1], pixel.share[2]).cast<double>();
}

Vec3d gain_of(const ColourPixel& pixel) {
    return Vec3f(pixel.gain[0], pixel.gain[1], pixel.gain[2]).cast<double>();
}

// That a surface without colours would send back.
Vec3d light_of(const CrosstalkFit& fit, const Lights& lights, std::span<const ColourPixel> pixels,
               std::size_t i) {
    return lights.steady(pixels[i]) + fit.contrast[pixels[i].image] * lights.swing(i);
}

// Of all channels, squared.
double error_of(const CrosstalkFit& fit, const Lights& lights, std::span<const ColourPixel> pixels,
                std::size_t i) {
    const Vec3d sent = gain_of(pixels[i]).cwiseProduct(light_of(fit, lights, pixels, i));
    return (fit.matrix * sent - share_of(pixels[i])).squaredNorm();
}

void fit_matrix(std::span<const ColourPixel> pixels, const Lights& lights, CrosstalkFit& fit) {
    Mat3d normal = Mat3d::Zero();
    Mat3d right = Mat3d::Zero();  // column c: of camera channel c
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        if (fit.agrees[i]) {
            const auto weight = static_cast<double>(pixels[i].weight);
            const Vec3d sent = gain_of(pixels[i]).cwiseProduct(light_of(fit, lights, pixels, i));
            normal += weight * sent * sent.transpose();
            right += weight * sent * share_of(pixels[i]).transpose();
        }
    }
    fit.matrix = normal.ldlt().solve(right).transpose();
}

// Of all images but the first, by which the matrix is.
void fit_contrasts(std::span<const ColourPixel> pixels, const Lights& lights, CrosstalkFit& fit) {
    std::vector<double> seen(fit.contrast.size(), 0.0);
    std::vector<double> whole(fit.contrast.size(), 0.0);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        if (fit.agrees[i]) {
            const auto weight = static_cast<double>(pixels[i].weight);
            const Mat3d matrix = fit.matrix * gain_of(pixels[i]).asDiagonal();
            const Vec3d swing = matrix * lights.swing(i);
            const Vec3d steady = matrix * lights.steady(pixels[i]);
            seen[pixels[i].image] += weight * swing.dot(share_of(pixels[i]) - steady);
            whole[pixels[i].image] += weight * swing.squaredNorm();
        }
    }
    for (std::size_t n = 1; n < fit.contrast.size(); ++n) {
        fit.contrast[n] = whole[n] > 0.0 ? seen[n] / whole[n] : 1.0;
    }
}

// Of each pixel in all images, by least squares.
void fit_gains(std::span<ColourPixel> pixels, const Lights& lights, const CrosstalkFit& fit) {
    const Mat3d inverse = fit.matrix.inverse();
    const std::size_t count = pixels.size() / fit.contrast.size();
    for (std::size_t n = 0; n < count; ++n) {
        Vec3d seen = Vec3d::Zero();
        Vec3d whole = Vec3d::Zero();
        for (std::size_t i = n; i < pixels.size(); i += count) {
            const Vec3d light = light_of(fit, lights, pixels, i);
            seen += light.cwiseProduct(inverse * share_of(pixels[i]));
            whole += light.cwiseAbs2();
        }
        for (std::size_t i = n; i < pixels.size(); i += count) {
            for (std::size_t k = 0; k < 3; ++k) {
                const auto at = static_cast<Eigen::Index>(k);
                pixels[i].gain[k] = static_cast<float>(seen[at] / std::max(whole[at], 1e-9));
            }
        }
    }
}

void leave_out_strays(std::span<const ColourPixel> pixels, const Lights& lights,
                      CrosstalkFit& fit) {
    std::vector<float> strays(pixels.size());
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        // In units of each pixel's own noise.
        strays[i] = static_cast<float>(std::sqrt(error_of(fit, lights, pixels, i))) *
                    std::sqrt(pixels[i].weight);
    }
    std::vector<float> sorted = strays;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        fit.agrees[i] = strays[i] <= kStray * *middle;
    }
}

}  // namespace

CrosstalkFit fit_crosstalk(std::span<const ColourPixel> pixels, std::size_t images,
                           const std::array<ResponseCurve, 3>& responses) {
    const Lights lights(pixels, responses);
    CrosstalkFit fit;
    fit.contrast.assign(images, 1.0);
    fit.agrees.assign(pixels.size(), true);
    for (int round = 0; round < kRounds; ++round) {
        fit_matrix(pixels, lights, fit);
        fit_contrasts(pixels, lights, fit);
        leave_out_strays(pixels, lights, fit);
    }
    fit.pixels = static_cast<std::size_t>(std::count(fit.agrees.begin(), fit.agrees.end(), true));
    return fit;
}

CrosstalkFit fit_coloured(std::span<ColourPixel> pixels, std::size_t images,
                          const std::array<ResponseCurve, 3>& responses) {
    const Lights lights(pixels, responses);
    CrosstalkFit fit;
    fit.contrast.assign(images, 1.0);
    fit.agrees.assign(pixels.size(), true);
    fit.pixels = pixels.size();
    for (int round = 0; round < kGainRounds; ++round) {
        if (images > 1) {
            fit_gains(pixels, lights, fit);
        }
        fit_matrix(pixels, lights, fit);
        fit.matrix = fit.matrix * Vec3d(fit.matrix.inverse() * Vec3d::Ones()).asDiagonal();
        fit_contrasts(pixels, lights, fit);
    }
    return fit;
}

double residual_of(const CrosstalkFit& fit, std::span<const ColourPixel> pixels,
                   const std::array<ResponseCurve, 3>& responses) {
    const Lights lights(pixels, responses);
    double squares = 0.0;
    double weights = 0.0;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        if (fit.agrees[i]) {
            const auto weight = static_cast<double>(pixels[i].weight);
            squares += weight * error_of(fit, lights, pixels, i);
            weights += weight;
        }
    }
    return weights > 0.0 ? std::sqrt(squares / (3.0 * weights)) : 0.0;
}

Mat3d balanced(const Mat3d& matrix) {
    return matrix.rowwise().sum().cwiseInverse().asDiagonal() * matrix;
}

double condition_of(const Mat3d& matrix) {
    const Eigen::Matrix3d squared = matrix.transpose() * matrix;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(squared, Eigen::EigenvaluesOnly);
    const double least = solver.eigenvalues()[0];
    return least > 0.0 ? std::sqrt(solver.eigenvalues()[2] / least)
                       : std::numeric_limits<double>::infinity();
}

}  // namespace xtrack
