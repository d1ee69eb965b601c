// SPDX-License-Identifier: Apache-2.0
#include "core/light/colour_test.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <optional>
#include <string>

#include <Eigen/LU>

#include "core/base/text.hpp"
#include "core/decode/taps.hpp"
#include "core/light/crosstalk.hpp"

namespace xtrack {
namespace {

// Crosstalk and responses in turn; each round takes away most of what is left.
constexpr int kMostRounds = 12;
constexpr double kSettled = 1e-4;  // share of full light
constexpr double kHandDistance_mm = 600.0;

// What a camera must do, and why:
// noise grows with the condition, thrice at least where colours are so alike
constexpr double kMostCondition = 8.0;
// a locked camera's gain holds to a percent, automatic ones jump by tens
constexpr double kMostGainChange = 0.05;
constexpr double kAlikeGains = 0.03;
// 3 px of 96, 4 mm at a hand's distance in the rigs of the documentation; hands need 5 to 10 mm
constexpr double kMostPhaseError_rad = 0.2;
constexpr double kMostResidual = 0.06;    // share of full light
constexpr double kLeastRange = 8.0;       // grey levels that full light adds in a channel
constexpr double kLeastPixelRange = 1.0;  // the same of one pixel, which counts by it
constexpr double kLeastContrast = 0.5;    // that short fringes must keep
constexpr std::size_t kLeastPixels = 500;
constexpr double kLeastAgreement = 0.5;  // of the pixels

constexpr std::array<const char*, 3> kColours{"red", "green", "blue"};

std::string fixed(double value, int digits) {
    std::string text;
    base::append_fixed(text, static_cast<float>(value), digits);
    return text;
}
std::string percent(double share) { return fixed(100.0 * share, 0) + " %"; }

double median(std::vector<double>& values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

void add_pixels(const ColourTestInput& input, int pattern, std::size_t image, double usual_range,
                std::vector<ColourPixel>& pixels) {
    const Pattern& shown = input.sequence.patterns[static_cast<std::size_t>(pattern)];
    for (std::size_t n = 0; n < input.pixels.size(); ++n) {
        const auto x_px = static_cast<double>(input.coordinate_px[n]);
        const auto dark = [](const LightRange& full) { return full.range < kLeastPixelRange; };
        if (!std::isfinite(x_px) ||
            std::any_of(input.ranges[n].begin(), input.ranges[n].end(), dark)) {
            continue;
        }
        ColourPixel& pixel = pixels.emplace_back();
        pixel.image = image;
        double range = 0.0;
        for (std::size_t c = 0; c < 3; ++c) {
            const LightRange& full = input.ranges[n][c];
            const double level = input.samples.level(pattern, c, input.pixels[n]);
            const double black = input.ranges_in_colour ? full.black : 0.0;
            pixel.share[c] = static_cast<float>((level - black) / full.range);
            pixel.value[c] = static_cast<float>(intensity(shown, x_px, static_cast<int>(c)));
            range += full.range / 3.0;
        }
        if (!input.ranges_in_colour) {
            // Luma's black is not the channels', but ambient light is about as white as the
            // projector's: it lights the surface's colours alike.
            pixel.ambient = static_cast<float>(input.ranges[n][0].black / range);
        }
        const double weight = range / usual_range;
        pixel.weight = static_cast<float>(weight * weight);
    }
}

std::array<ResponseCurve, 3> curves_of(const ColourTestInput& input,
                                       const std::array<std::vector<double>, 3>& light) {
    std::array<ResponseCurve, 3> curves;
    for (std::size_t k = 0; k < 3; ++k) {
        curves[k] = input.ramp != nullptr ? ResponseCurve(equal_steps(*input.ramp, light[k]))
                                          : colour_response(input.sequence, static_cast<int>(k));
    }
    return curves;
}

// Of the pixels that agree: the phase that the colours give, against that of their coordinate.
double phase_error_rad(const Pattern& pattern, const CrosstalkFit& fit,
                       std::span<const ColourPixel> pixels,
                       const std::array<ResponseCurve, 3>& curves) {
    TapSet taps;
    if (!fit_taps(pattern.phase_rad, taps)) {
        return std::numbers::pi;
    }
    const Mat3d inverse = fit.matrix.inverse();
    double squares = 0.0;
    double count = 0.0;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        if (!fit.agrees[i] || pixels[i].image + 1 < fit.contrast.size()) {
            continue;
        }
        const ColourPixel& pixel = pixels[i];
        const Vec3d light =
            (inverse * Vec3f(pixel.share[0], pixel.share[1], pixel.share[2]).cast<double>())
                .cwiseQuotient(Vec3f(pixel.gain[0], pixel.gain[1], pixel.gain[2]).cast<double>())
                .array() -
            static_cast<double>(pixel.ambient);
        std::complex<double> seen = 0.0;
        std::complex<double> shown = 0.0;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::complex<double> tap(taps.taps[k].re, taps.taps[k].im);
            const double lit = std::clamp(light[static_cast<Eigen::Index>(k)], 0.0, 1.0);
            seen += tap * curves[k].value(lit);
            shown += tap * static_cast<double>(pixel.value[k]);
        }
        const double error = std::arg(seen * std::conj(shown));
        squares += error * error;
        count += 1.0;
    }
    return count > 0.0 ? std::sqrt(squares / count) : std::numbers::pi;
}

// That the colours' curves add to the phase of fringes, rms over a fringe.
double bend_rad(const Pattern& pattern, const std::array<ResponseCurve, 3>& curves) {
    TapSet taps;
    if (!fit_taps(pattern.phase_rad, taps)) {
        return std::numbers::pi;
    }
    constexpr int kSteps = 180;
    double squares = 0.0;
    for (int i = 0; i < kSteps; ++i) {
        const double phase = 2.0 * std::numbers::pi * i / kSteps;
        std::complex<double> seen = 0.0;
        for (std::size_t k = 0; k < 3; ++k) {
            const double value = 0.5 + 0.5 * std::cos(phase + pattern.phase_rad[k]);
            seen += std::complex<double>(taps.taps[k].re, taps.taps[k].im) * curves[k].light(value);
        }
        const double error = std::arg(seen * std::polar(1.0, -phase));
        squares += error * error;
    }
    return std::sqrt(squares / kSteps);
}

// Of a phase in the middle of the image, at a hand's distance.
std::optional<double> depth_error_mm(const ColourTestInput& input, double period_px,
                                     double error_rad) {
    if (input.geometry == nullptr || input.rig == nullptr) {
        return std::nullopt;
    }
    double z_mm = kHandDistance_mm;
    if (const auto& volume = input.rig->working_volume) {
        z_mm = std::clamp(z_mm, volume->near_mm, volume->far_mm);
    }
    const Size image = input.rig->camera.size;
    const double u = 0.5 * (image.width - 1);
    const double v = 0.5 * (image.height - 1);
    const double px_per_mm = 0.5 * (input.geometry->coordinate_of_depth(u, v, z_mm + 1.0) -
                                    input.geometry->coordinate_of_depth(u, v, z_mm - 1.0));
    return error_rad * period_px / (2.0 * std::numbers::pi) / std::fabs(px_per_mm);
}

// What the fit's matrix says of the camera, its mean row summing to one. Shares of each channel's
// own white leave the camera's white out: it is put back.
Mat3d camera_matrix(const ColourTestInput& input, const Mat3d& fitted) {
    Mat3d matrix = fitted;
    if (input.ranges_in_colour) {
        Vec3d white;
        for (std::size_t c = 0; c < 3; ++c) {
            std::vector<double> shares;
            for (const auto& range : input.ranges) {
                shares.push_back(range[c].range /
                                 (range[0].range + range[1].range + range[2].range));
            }
            white[static_cast<Eigen::Index>(c)] = median(shares);
        }
        matrix = white.asDiagonal() * fitted;
    }
    return matrix * (3.0 / matrix.sum());
}

// The first channel to which full light adds hardly anything; 3: none.
std::size_t dark_channel(const ColourTestInput& input) {
    for (std::size_t c = 0; c < 3; ++c) {
        std::vector<double> ranges;
        for (const auto& range : input.ranges) {
            ranges.push_back(range[c].range);
        }
        if (median(ranges) < kLeastRange) {
            return c;
        }
    }
    return 3;
}

double usual_range(const ColourTestInput& input) {
    std::vector<double> ranges;
    for (const auto& range : input.ranges) {
        ranges.push_back((range[0].range + range[1].range + range[2].range) / 3.0);
    }
    return median(ranges);
}

// What speaks against the colours; empty: nothing does.
std::string complaint(const ColourSelfTest& test, const Vec3d& row_sums, double agreement) {
    if (test.contrast < kLeastContrast) {
        return "the shortest colour fringes keep " + percent(test.contrast) +
               " of their contrast: the camera's colours are coarser than they; ask it for "
               "uncompressed or larger images, and focus it";
    }
    if (test.gain_change > kMostGainChange) {
        const bool alike = row_sums.maxCoeff() - row_sums.minCoeff() < kAlikeGains;
        return std::string("the camera's ") + (alike ? "exposure or gain" : "white balance") +
               " changed by " + percent(test.gain_change) +
               " between the white and the colour images, or it has a gamma of its own; lock it, "
               "and "
               "switch that off";
    }
    if (!(test.condition < kMostCondition)) {
        return "the camera's colours are too alike (condition " +
               fixed(std::min(test.condition, 999.0), 0) + ", at most " + fixed(kMostCondition, 0) +
               " will do); raise its saturation, or use grey fringes";
    }
    if (agreement < kLeastAgreement) {
        return "only " + percent(agreement) +
               " of the lit pixels agree on the colours; show a plain wall";
    }
    if (test.residual > kMostResidual || test.phase_error_rad > kMostPhaseError_rad) {
        return "colours are off by " + percent(test.residual) +
               " of full light and their phase by " + fixed(test.phase_error_rad, 2) +
               " rad; give more light, or lower the gain";
    }
    return {};
}

}  // namespace

std::vector<int> colour_patterns(const PatternSequence& sequence) {
    std::vector<int> patterns;
    for (std::size_t i = 0; i < sequence.patterns.size(); ++i) {
        if (sequence.patterns[i].kind == PatternKind::rgb_sine) {
            patterns.push_back(static_cast<int>(i));
        }
    }
    std::stable_sort(patterns.begin(), patterns.end(), [&](int a, int b) {
        return sequence.patterns[static_cast<std::size_t>(a)].period_px >
               sequence.patterns[static_cast<std::size_t>(b)].period_px;
    });
    return patterns;
}

void separate_ramp(const Ramp& ramp, const std::array<std::vector<double>, 3>& shares,
                   const Mat3d& camera_from_projector_rgb,
                   std::array<std::vector<double>, 3>& light) {
    const Mat3d inverse = balanced(camera_from_projector_rgb).inverse();
    for (auto& curve : light) {
        curve.resize(ramp.steps.size());
    }
    for (std::size_t i = 0; i < ramp.steps.size(); ++i) {
        const Vec3d apart = inverse * Vec3d(shares[0][i], shares[1][i], shares[2][i]);
        for (std::size_t k = 0; k < 3; ++k) {
            light[k][i] = apart[static_cast<Eigen::Index>(k)];
        }
    }
    for (auto& curve : light) {
        pool_falls(curve);
    }
}

ColourTestResult test_colours(const ColourTestInput& input) {
    ColourTestResult result;
    result.light = input.ramp_shares;
    ColourSelfTest& test = result.verdict;
    if (const std::size_t dark = dark_channel(input); dark < 3) {
        test.reason = "the projector adds fewer than " + fixed(kLeastRange, 0) +
                      " grey levels of " + kColours[dark] + "; give more light or exposure";
        return result;
    }
    const std::vector<int> patterns = colour_patterns(input.sequence);
    const double usual = usual_range(input);
    std::vector<ColourPixel> pixels;
    for (std::size_t image = 0; image < patterns.size(); ++image) {
        add_pixels(input, patterns[image], image, usual, pixels);
    }
    if (pixels.size() < kLeastPixels) {
        test.reason = "hardly a pixel sees where on the projector it looks; show a plain wall";
        return result;
    }
    CrosstalkFit fit;
    std::array<ResponseCurve, 3> curves = curves_of(input, result.light);
    for (int round = 0; round < kMostRounds; ++round) {
        fit = input.ranges_in_colour ? fit_crosstalk(pixels, patterns.size(), curves)
                                     : fit_coloured(pixels, patterns.size(), curves);
        test.condition = condition_of(balanced(fit.matrix));
        if (input.ramp == nullptr || !(test.condition < kMostCondition)) {
            break;
        }
        const std::array<std::vector<double>, 3> before = result.light;
        separate_ramp(*input.ramp, input.ramp_shares, fit.matrix, result.light);
        curves = curves_of(input, result.light);
        double change = 0.0;
        for (std::size_t k = 0; k < 3; ++k) {
            for (std::size_t i = 0; i < before[k].size(); ++i) {
                change = std::max(change, std::fabs(result.light[k][i] - before[k][i]));
            }
        }
        if (change < kSettled) {
            break;
        }
    }
    const Vec3d row_sums = fit.matrix.rowwise().sum();
    test.camera_from_projector_rgb = camera_matrix(input, fit.matrix);
    if (input.ranges_in_colour) {
        test.gain_change = (row_sums - Vec3d::Ones()).cwiseAbs().maxCoeff();
    }
    test.pixels = fit.pixels;
    test.contrast = fit.contrast.back();
    test.residual = residual_of(fit, pixels, curves);
    const Pattern& shortest = input.sequence.patterns[static_cast<std::size_t>(patterns.back())];
    test.phase_error_rad = phase_error_rad(shortest, fit, pixels, curves);
    test.bend_rad = bend_rad(shortest, curves);
    test.depth_error_mm = depth_error_mm(input, shortest.period_px, test.phase_error_rad);
    const double agreement = static_cast<double>(fit.pixels) / static_cast<double>(pixels.size());
    test.reason = complaint(test, row_sums, agreement);
    test.passed = test.reason.empty();
    if (test.passed) {
        test.reason = "the colours can be told apart; their phase is good to " +
                      fixed(test.phase_error_rad, 3) + " rad";
        if (!works_as_shown(test)) {
            test.reason +=
                ", once pictures are compensated: as they are the projector bends it by " +
                fixed(test.bend_rad, 2) + " rad";
        }
    }
    return result;
}

}  // namespace xtrack
