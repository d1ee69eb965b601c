// SPDX-License-Identifier: Apache-2.0
#include <xtrack/one_euro_filter.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace xtrack {

namespace {

constexpr double kSmallestCutoffHz = 1e-6;

/// Weight of the new sample in a first-order low-pass. (eq. 2 of the paper)
double weight(double cutoff_hz, double dt_s) {
    const double tau_s = 1.0 / (2.0 * std::numbers::pi * cutoff_hz);
    return 1.0 / (1.0 + tau_s / dt_s);
}

}  // namespace

OneEuroFilter::OneEuroFilter(const OneEuroSettings& settings) : settings_(settings) {
    settings_.min_cutoff_hz = std::max(settings.min_cutoff_hz, kSmallestCutoffHz);
    settings_.beta_hz_per_mmps = std::max(settings.beta_hz_per_mmps, 0.0);
    settings_.derivative_cutoff_hz = std::max(settings.derivative_cutoff_hz, kSmallestCutoffHz);
}

double OneEuroFilter::filter(double value, Stamp stamp) noexcept {
    if (!std::isfinite(value)) {
        return value_;
    }
    if (!started_) {
        started_ = true;
        stamp_ = stamp;
        value_ = value;
        slope_ = 0.0;
        return value_;
    }
    if (stamp <= stamp_) {
        return value_;
    }
    const double dt_s = to_seconds(stamp - stamp_);
    stamp_ = stamp;
    // The slope is taken against the last *filtered* value, as in the authors' reference.
    const double slope = (value - value_) / dt_s;
    const double slope_weight = weight(settings_.derivative_cutoff_hz, dt_s);
    slope_ += slope_weight * (slope - slope_);
    const double cutoff_hz =
        settings_.min_cutoff_hz + settings_.beta_hz_per_mmps * std::abs(slope_);
    value_ += weight(cutoff_hz, dt_s) * (value - value_);
    return value_;
}

}  // namespace xtrack
