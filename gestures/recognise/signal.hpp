// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <xtrack/stamp.hpp>

namespace xtrack::recognise {

class MotionHistory;

/// How good the signal of one hand is, measured on itself: what thresholds are fitted to.
struct Signal {
    double palm_noise_mm = 0.0;      ///< white, one axis of one sample
    double aperture_noise_mm = 0.0;  ///< white, of thumb to index
    double interval_s = 1.0 / 60.0;  ///< between samples

    /// A radius in which a hand at rest stays: what is asked for, or three sigma of a 1-euro
    /// filter's output, which is a quarter of the noise of its input at rest (2 mm in, 0.5 mm out).
    [[nodiscard]] double still_mm(double asked_mm) const noexcept;
    /// A speed that a hand at rest stays under: what is asked for, or three sigma of the slope of a
    /// line through the samples of a window.
    [[nodiscard]] double still_mmps(double asked_mmps, Duration window) const noexcept;
    /// Three sigma of a way that is added up from such slopes: of the mean of a window.
    [[nodiscard]] double way_mm(Duration window) const noexcept;
    /// A hysteresis of at least three sigma.
    [[nodiscard]] static double apart(double asked, double noise) noexcept {
        return asked > 3.0 * noise ? asked : 3.0 * noise;
    }

    [[nodiscard]] double samples_in(Duration window) const noexcept;
};

/// Measures a Signal from the history of a hand, in which movement is smooth and noise is not: the
/// median size of third differences, which are 0 for constant acceleration.
class SignalMeter {
 public:
    /// A new sample is in the history.
    void update(const MotionHistory& history) noexcept;
    [[nodiscard]] const Signal& signal() const noexcept { return signal_; }

 private:
    Signal signal_;
    bool palm_known_ = false;
    bool aperture_known_ = false;
};

}  // namespace xtrack::recognise
