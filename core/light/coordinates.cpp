// SPDX-License-Identifier: Apache-2.0
#include "core/light/coordinates.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

#include "core/decode/gamma_correction.hpp"
#include "core/unwrap/unwrap_row.hpp"

namespace xtrack {

std::vector<GreyPeriod> grey_periods(const PatternSequence& sequence) {
    std::vector<GreyPeriod> periods;
    for (std::size_t i = 0; i < sequence.patterns.size(); ++i) {
        const Pattern& pattern = sequence.patterns[i];
        if (pattern.kind != PatternKind::sine) {
            continue;
        }
        auto same = std::find_if(periods.begin(), periods.end(), [&](const GreyPeriod& period) {
            return period.period_px == pattern.period_px;
        });
        if (same == periods.end()) {
            same = periods.insert(same, GreyPeriod{pattern.period_px, {}, {}});
        }
        same->patterns.push_back(static_cast<int>(i));
        same->phases_rad.push_back(pattern.phase_rad[0]);
    }
    std::erase_if(periods, [](const GreyPeriod& period) { return period.patterns.size() < 3; });
    std::sort(periods.begin(), periods.end(),
              [](const GreyPeriod& a, const GreyPeriod& b) { return a.period_px > b.period_px; });
    return periods;
}

Result<GreyCoordinates> GreyCoordinates::create(const PatternSequence& sequence, Size image,
                                                const Triangulation* geometry) {
    GreyCoordinates made;
    for (GreyPeriod& period : grey_periods(sequence)) {
        auto taps = least_squares_taps(period.phases_rad);
        if (!taps) {
            return taps.error();
        }
        made.periods_.push_back({std::move(period), *taps});
    }
    if (made.periods_.empty()) {
        return Error{ErrorCode::unsupported,
                     "pattern sequence: it has no three grey sines of one period, which tell where "
                     "colours are; show those of `xtrack calibrate patterns` (light_sequence())"};
    }
    auto reference = OrderReference::create(geometry, image, made.periods_.front().images.period_px,
                                            sequence.coded_length_px());
    if (!reference) {
        return reference.error();
    }
    made.reference_ = *std::move(reference);
    return made;
}

std::complex<double> GreyCoordinates::Period::sum(const LightSamples& samples, std::size_t channel,
                                                  std::size_t pixel) const {
    std::complex<double> z = 0.0;
    for (std::size_t k = 0; k < images.patterns.size(); ++k) {
        z += samples.level(images.patterns[k], channel, pixel) *
             std::complex<double>(taps.taps[k].re, taps.taps[k].im);
    }
    return z;
}

LightRange GreyCoordinates::range(const LightSamples& samples, std::size_t channel,
                                  std::size_t pixel) const {
    const Period& longest = periods_.front();
    const std::complex<double> z = longest.sum(samples, channel, pixel);
    double mean = 0.0;
    for (std::size_t k = 0; k < longest.images.patterns.size(); ++k) {
        const double fringe = (z * std::polar(1.0, longest.images.phases_rad[k])).real();
        mean += samples.level(longest.images.patterns[k], channel, pixel) - fringe;
    }
    mean /= static_cast<double>(longest.images.patterns.size());
    return {mean - std::abs(z), 2.0 * std::abs(z)};
}

std::vector<int> GreyCoordinates::patterns() const {
    std::vector<int> all;
    for (const Period& period : periods_) {
        all.insert(all.end(), period.images.patterns.begin(), period.images.patterns.end());
    }
    return all;
}

std::vector<float> GreyCoordinates::of(const LightSamples& samples,
                                       std::span<const std::size_t> pixels,
                                       const ResponseCurve& response) const {
    std::vector<float> reference(pixels.size());
    for (std::size_t n = 0; n < pixels.size(); ++n) {
        reference[n] = reference_.row(samples.v(pixels[n]))[samples.u(pixels[n])];
    }
    std::vector<float> phase(pixels.size());
    std::vector<float> found(pixels.size());
    for (const Period& period : periods_) {
        for (std::size_t n = 0; n < pixels.size(); ++n) {
            phase[n] =
                static_cast<float>(std::arg(period.sum(samples, LightSamples::kLuma, pixels[n])));
        }
        UnwrapRow row;
        row.count = static_cast<int>(pixels.size());
        GammaCorrection(period.taps, period.images.phases_rad, response)
            .apply(row.count, phase.data());
        row.reference_px = reference.data();
        row.phase_rad = phase.data();
        row.period_px = period.images.period_px;
        row.tolerance = &period == &periods_.front() ? reference_.tolerance() : 0.5F;
        row.coordinate_px = found.data();
        unwrap_row(row);
        reference.swap(found);
    }
    return reference;
}

}  // namespace xtrack
