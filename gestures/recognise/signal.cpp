// SPDX-License-Identifier: Apache-2.0
#include "gestures/recognise/signal.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "gestures/recognise/motion_history.hpp"

namespace xtrack::recognise {

namespace {

constexpr double kFilteredShare = 0.25;
// Third differences that a median is taken of: half a second at 60 Hz.
constexpr std::size_t kDifferences = 30;
constexpr std::size_t kEnough = 8;
// A third difference of white noise has sqrt(1 + 9 + 9 + 1) of its sigma.
const double kThirdDifference = std::sqrt(20.0);
constexpr double kMedianOfNorm3 = 1.538;  // of three normal variables
constexpr double kMedianOfNorm1 = 0.6745;
// A follower: the measure settles within a second and does not jump.
constexpr double kFollowShare = 0.05;
// Acceleration that changes within a few samples looks like noise; more than this it is not.
constexpr double kMostPalmMm = 8.0;
constexpr double kMostApertureMm = 8.0;
// A step of time that differs by more breaks the row: differences need even steps.
constexpr double kEvenShare = 0.3;

double median(std::array<double, kDifferences>& values, std::size_t count) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(count / 2);
    std::nth_element(values.begin(), middle, values.begin() + static_cast<std::ptrdiff_t>(count));
    return *middle;
}

}  // namespace

double Signal::still_mm(double asked_mm) const noexcept {
    return std::max(asked_mm, 3.0 * kFilteredShare * palm_noise_mm);
}

double Signal::still_mmps(double asked_mmps, Duration window) const noexcept {
    // n samples, dt apart: sigma of the slope is noise / dt * sqrt(12 / (n (n^2 - 1))), of each of
    // three axes.
    const double n = samples_in(window);
    const double slope_mmps = palm_noise_mm / interval_s * std::sqrt(12.0 / (n * (n * n - 1.0)));
    return std::max(asked_mmps, 3.0 * slope_mmps);
}

double Signal::samples_in(Duration window) const noexcept {
    return std::max(std::floor(to_seconds(window) / interval_s) + 1.0, 2.0);
}

double Signal::way_mm(Duration window) const noexcept {
    return 3.0 * palm_noise_mm / std::sqrt(samples_in(window));
}

void SignalMeter::update(const MotionHistory& history) noexcept {
    std::array<double, kDifferences> palm{};
    std::array<double, kDifferences> aperture{};
    std::size_t palms = 0;
    std::size_t apertures = 0;
    double interval_s = 0.0;
    std::size_t intervals = 0;
    const std::size_t last = std::min(history.size(), kDifferences + 3);
    for (std::size_t i = 0; i + 3 < last; ++i) {
        const MotionSample& a = history.at(i);
        const MotionSample& b = history.at(i + 1);
        const MotionSample& c = history.at(i + 2);
        const MotionSample& d = history.at(i + 3);
        const double first_s = to_seconds(a.stamp - b.stamp);
        interval_s += first_s;
        ++intervals;
        if (std::abs(to_seconds(b.stamp - c.stamp) - first_s) > kEvenShare * first_s ||
            std::abs(to_seconds(c.stamp - d.stamp) - first_s) > kEvenShare * first_s) {
            continue;
        }
        palm[palms++] = static_cast<double>(
            (a.palm_mm - 3.0F * b.palm_mm + 3.0F * c.palm_mm - d.palm_mm).norm());
        if (a.aperture_mm >= 0.0F && b.aperture_mm >= 0.0F && c.aperture_mm >= 0.0F &&
            d.aperture_mm >= 0.0F) {
            aperture[apertures++] = static_cast<double>(std::abs(
                a.aperture_mm - 3.0F * b.aperture_mm + 3.0F * c.aperture_mm - d.aperture_mm));
        }
    }
    if (intervals < kEnough) {
        return;
    }
    signal_.interval_s = interval_s / static_cast<double>(intervals);
    const auto follow = [](double& value, bool& known, double measured) {
        value += (known ? kFollowShare : 1.0) * (measured - value);
        known = true;
    };
    if (palms >= kEnough) {
        follow(signal_.palm_noise_mm, palm_known_,
               std::min(median(palm, palms) / (kMedianOfNorm3 * kThirdDifference), kMostPalmMm));
    }
    if (apertures >= kEnough) {
        follow(signal_.aperture_noise_mm, aperture_known_,
               std::min(median(aperture, apertures) / (kMedianOfNorm1 * kThirdDifference),
                        kMostApertureMm));
    }
}

}  // namespace xtrack::recognise
