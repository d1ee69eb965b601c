// SPDX-License-Identifier: Apache-2.0
#include "core/decode/gamma_correction.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace xtrack {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr std::size_t kEntries = 512;  // the error's steepest part spans a tenth of the circle
constexpr int kIterations = 30;

double wrapped(double angle) { return std::remainder(angle, 2.0 * kPi); }

double measured_phase(const TapSet& taps, std::span<const double> phases,
                      std::span<const ResponseCurve> responses, double phase) {
    std::complex<double> z = 0.0;
    for (std::size_t n = 0; n < phases.size(); ++n) {
        const double light = responses[n].light(0.5 + 0.5 * std::cos(phase + phases[n]));
        z += light * std::complex<double>(taps.taps[n].re, taps.taps[n].im);
    }
    return std::arg(z);
}

}  // namespace

GammaCorrection::GammaCorrection(const TapSet& taps, std::span<const double> phases_rad,
                                 std::span<const ResponseCurve> responses) {
    if (std::all_of(responses.begin(), responses.end(),
                    [](const ResponseCurve& one) { return one.linear(); })) {
        return;
    }
    correction_rad_.resize(kEntries + 1);
    for (std::size_t i = 0; i <= kEntries; ++i) {
        const double seen = -kPi + 2.0 * kPi * static_cast<double>(i) / kEntries;
        double phase = seen;
        // Damped, because near the steepest part the plain fixed point overshoots.
        constexpr double kDamping = 0.7;
        for (int n = 0; n < kIterations; ++n) {
            phase += kDamping * wrapped(seen - measured_phase(taps, phases_rad, responses, phase));
        }
        correction_rad_[i] = static_cast<float>(wrapped(phase - seen));
    }
}

GammaCorrection::GammaCorrection(const TapSet& taps, std::span<const double> phases_rad,
                                 const ResponseCurve& response)
    : GammaCorrection(taps, phases_rad, std::vector<ResponseCurve>(phases_rad.size(), response)) {}

void GammaCorrection::apply(int count, float* phase_rad) const noexcept {
    if (identity()) {
        return;
    }
    constexpr auto kPerRad = static_cast<float>(kEntries / (2.0 * kPi));
    constexpr auto kTurn = static_cast<float>(2.0 * kPi);
    constexpr auto kHalfTurn = static_cast<float>(kPi);
    for (int i = 0; i < count; ++i) {
        const float seen = phase_rad[i];
        if (std::isnan(seen)) {
            continue;
        }
        const float position = (seen + kHalfTurn) * kPerRad;
        auto cell = static_cast<std::size_t>(position > 0.0F ? position : 0.0F);
        cell = cell < kEntries ? cell : kEntries - 1;
        const float share = position - static_cast<float>(cell);
        float phase = seen + correction_rad_[cell] +
                      share * (correction_rad_[cell + 1] - correction_rad_[cell]);
        phase -= phase > kHalfTurn ? kTurn : 0.0F;
        phase += phase <= -kHalfTurn ? kTurn : 0.0F;
        phase_rad[i] = phase;
    }
}

}  // namespace xtrack
