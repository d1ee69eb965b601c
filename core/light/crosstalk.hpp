// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <xtrack/geometry.hpp>

#include "core/pattern/response_curve.hpp"

namespace xtrack {

/// One pixel under one colour pattern, its albedo and most ambient light taken out.
struct ColourPixel {
    std::array<float, 3> share{};  ///< of full light in the camera's red, green, blue
    std::array<float, 3> value{};  ///< that the projector was handed for red, green, blue
    float ambient = 0.0F;          ///< white light that is left in it, a share as well
    std::array<float, 3> gain{1.0F, 1.0F, 1.0F};  ///< of the surface for the projector's colours
    float weight = 1.0F;    ///< in the sums: the inverse of the noise's variance
    std::size_t image = 0;  ///< which colour pattern, longest period first
};

/// share = matrix * gain * light, as far as pixels agree with it; light is that of the value, but
/// for what blur and coarse colours take of an image's contrast.
struct CrosstalkFit {
    Mat3d matrix = Mat3d::Identity();  ///< rows camera, columns projector; red, green, blue
    std::vector<double> contrast;      ///< of each image, against the first
    std::vector<bool> agrees;          ///< one for each pixel
    std::size_t pixels = 0;            ///< that agree
};

/// Least squares of the rows, of pixels whose own colours were taken out: those that stray thrice
/// as far as most, such as edges, are left out.
/// @param images that the pixels are of; longest period first
/// @param responses of red, green, blue
[[nodiscard]] CrosstalkFit fit_crosstalk(std::span<const ColourPixel> pixels, std::size_t images,
                                         const std::array<ResponseCurve, 3>& responses);

/// The same of surfaces of any colour, which two or more images tell apart from the camera's: gains
/// of each pixel and the matrix in turn. Its rows sum to one, which the camera's white is taken to
/// do; else each colour's gains and column could share any factor.
/// @param pixels the same ones of each image, image by image; their gains are out
[[nodiscard]] CrosstalkFit fit_coloured(std::span<ColourPixel> pixels, std::size_t images,
                                        const std::array<ResponseCurve, 3>& responses);

/// Weighted rms of the shares about the fit, of those pixels that agree.
[[nodiscard]] double residual_of(const CrosstalkFit& fit, std::span<const ColourPixel> pixels,
                                 const std::array<ResponseCurve, 3>& responses);

/// The matrix with rows that sum to one: a camera whose white is balanced.
[[nodiscard]] Mat3d balanced(const Mat3d& matrix);

/// Largest through smallest singular value; infinite where colours cannot be told apart at all.
[[nodiscard]] double condition_of(const Mat3d& matrix);

}  // namespace xtrack
