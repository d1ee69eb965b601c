// SPDX-License-Identifier: Apache-2.0
#include "core/sim/timing.hpp"

#include <algorithm>
#include <cmath>

namespace xtrack::sim {
namespace {

Duration nanoseconds(double s) { return Duration{std::llround(s * 1e9)}; }

}  // namespace

Timing::Timing(const SimSettings& settings)
    : patterns_(static_cast<std::int64_t>(settings.patterns.patterns.size())),
      rows_(settings.rig.camera.size.height),
      frame_s_(1.0 / settings.camera.frame_hz),
      exposure_s_(settings.camera.exposure_s),
      readout_s_(settings.camera.readout_s),
      first_stamp_s_(0.5 * (exposure_s_ + readout_s_)),
      latency_error_s_(settings.clocks.latency_error_s),
      guard_s_(settings.clocks.guard_s) {
    if (settings.clocks.locked) {
        show_s_ = frame_s_;
        first_show_s_ = first_stamp_s_ - 0.5 * frame_s_;
        latency_error_s_ = 0.0;
        guard_s_ = 0.0;
    } else {
        show_s_ = frame_s_ * settings.clocks.hold_frames * (1.0 + settings.clocks.drift_ppm * 1e-6);
        first_show_s_ = settings.clocks.phase_s;
    }
}

Stamp Timing::stamp(std::uint64_t frame) const {
    return Stamp{} + nanoseconds(first_stamp_s_ + static_cast<double>(frame) * frame_s_);
}

std::int64_t Timing::show_at(double t_s) const {
    return static_cast<std::int64_t>(std::floor((t_s - first_show_s_) / show_s_));
}

double Timing::show_start_s(std::int64_t show) const {
    return first_show_s_ + static_cast<double>(show) * show_s_;
}

std::size_t Timing::pattern_of(std::int64_t show) const {
    // The projector ran before the camera was opened.
    return static_cast<std::size_t>((show % patterns_ + patterns_) % patterns_);
}

PatternMix Timing::shown(double begin_s, double end_s) const {
    PatternMix mix;
    const double length = end_s - begin_s;
    double rest = 1.0;
    for (std::int64_t show = show_at(begin_s); mix.count < kMaxShares; ++show) {
        const double from = std::max(begin_s, show_start_s(show));
        const double to = std::min(end_s, show_start_s(show + 1));
        const double weight = length > 0.0 ? (to - from) / length : 1.0;
        constexpr double kNothing = 1e-9;
        if (weight > kNothing) {
            const bool last = to >= end_s || mix.count + 1 == kMaxShares;
            mix.shares[mix.count++] = {pattern_of(show), static_cast<float>(last ? rest : weight)};
            rest -= weight;
        }
        if (to >= end_s) {
            break;
        }
    }
    return mix;
}

PatternAssignment Timing::assign(std::uint64_t frame) const {
    FrameTiming timing;
    timing.stamp = stamp(frame);
    timing.exposure = nanoseconds(exposure_s_ + 2.0 * guard_s_);
    timing.readout = nanoseconds(readout_s_);
    timing.rows = rows_;
    const double middle = first_stamp_s_ + static_cast<double>(frame) * frame_s_;
    const double half = 0.5 * (exposure_s_ + readout_s_) + guard_s_ + std::abs(latency_error_s_);
    constexpr std::size_t kMostShows = 8;  // exposure + readout are two frames, a show is one
    std::array<PatternShow, kMostShows> shows{};
    std::size_t count = 0;
    for (std::int64_t show = show_at(middle - half) - 1; count < kMostShows; ++show) {
        const double start = show_start_s(show) + latency_error_s_;
        if (start > middle + half) {
            break;
        }
        shows[count++] = {Stamp{} + nanoseconds(start), static_cast<int>(pattern_of(show))};
    }
    return assign_pattern({shows.data(), count}, timing);
}

}  // namespace xtrack::sim
