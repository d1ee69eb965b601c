// SPDX-License-Identifier: Apache-2.0
#include "core/decode/carrier.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>

namespace xtrack {
namespace {

constexpr int kMostLag = 64;  // twice the longest period, and a margin
constexpr int kLinesLookedAt = 24;
// Of the mean square: noise correlates by less.
constexpr double kLeastCorrelation = 0.1;

}  // namespace

double find_carrier_px(ImageView<const std::uint8_t> grey, bool down) noexcept {
    const int length = down ? grey.height : grey.width;
    const int lines = down ? grey.width : grey.height;
    if (length < 2 * kMostLag) {
        return 0.0;
    }
    // Second differences, so that shading does not hide the fringe.
    const auto at = [&](int line, int i) {
        const auto value = [&](int k) {
            return static_cast<double>(down ? grey.row(k)[line] : grey.row(line)[k]);
        };
        return value(i) - 0.5 * (value(i - 3) + value(i + 3));
    };
    std::array<double, kMostLag + 1> correlation{};
    for (int n = 0; n < kLinesLookedAt; ++n) {
        const int line = (2 * n + 1) * lines / (2 * kLinesLookedAt);
        for (int lag = 0; lag <= kMostLag; ++lag) {
            double sum = 0.0;
            for (int i = 3; i + lag + 3 < length; i += 2) {
                sum += at(line, i) * at(line, i + lag);
            }
            correlation[static_cast<std::size_t>(lag)] += sum / (length - lag);
        }
    }
    // The first peak after the first dip.
    std::size_t lag = 1;
    while (lag < kMostLag && correlation[lag] < correlation[lag - 1]) {
        ++lag;
    }
    while (lag < kMostLag && correlation[lag] >= correlation[lag - 1]) {
        ++lag;
    }
    const std::size_t peak = lag - 1;
    if (lag >= kMostLag || !(correlation[peak] > kLeastCorrelation * correlation[0])) {
        return 0.0;
    }
    const double before = correlation[peak - 1];
    const double after = correlation[peak + 1];
    const double bend = before - 2.0 * correlation[peak] + after;
    const double period =
        static_cast<double>(peak) + (bend < 0.0 ? 0.5 * (before - after) / bend : 0.0);
    return period >= kShortestCarrier_px && period <= kLongestCarrier_px ? period : 0.0;
}

TapSet carrier_taps(double carrier_px, bool down, double phase_rad) noexcept {
    constexpr int kMostReach = (kMaxTaps - 1) / 2;
    const double w = 2.0 * std::numbers::pi / carrier_px;
    const int reach = std::min(kMostReach, static_cast<int>(std::lround(std::fabs(carrier_px))));
    std::array<std::complex<double>, kMaxTaps> taps{};
    std::array<double, kMaxTaps> window{};
    const int count = 2 * reach + 1;
    // The three signals that the taps must tell apart: the fringe, its mirror image, the mean.
    std::complex<double> mean;
    double weight = 0.0;
    for (int n = 0; n < count; ++n) {
        const auto i = static_cast<std::size_t>(n);
        const int shift = n - reach;
        window[i] = 0.5 + 0.5 * std::cos(std::numbers::pi * shift / (reach + 1.0));
        taps[i] = window[i] * std::polar(1.0, -w * shift);
        mean += taps[i];
        weight += window[i];
    }
    std::complex<double> response;
    for (int n = 0; n < count; ++n) {
        const auto i = static_cast<std::size_t>(n);
        taps[i] -= window[i] * mean / weight;
        response += taps[i] * std::polar(1.0, w * (n - reach));
    }
    const std::complex<double> scale = 2.0 * std::polar(1.0, -phase_rad) / response;
    TapSet set;
    set.count = count;
    for (int n = 0; n < count; ++n) {
        const auto i = static_cast<std::size_t>(n);
        const std::complex<double> tap = taps[i] * scale;
        set.taps[i] = {static_cast<float>(tap.real()), static_cast<float>(tap.imag()),
                       down ? 0 : n - reach, down ? n - reach : 0};
    }
    return set;
}

}  // namespace xtrack
