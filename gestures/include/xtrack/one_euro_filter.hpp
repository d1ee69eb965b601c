// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include <xtrack/geometry.hpp>
#include <xtrack/stamp.hpp>

namespace xtrack {

/// The defaults suit positions in mm; beta is bound to that unit. In metres the same behaviour
/// needs a beta a thousand times larger, in normalised coordinates another one again.
/// @since 0.1
struct OneEuroSettings {
    double min_cutoff_hz = 0.35;        ///< cutoff at rest: lower is calmer. > 0
    double beta_hz_per_mmps = 0.05;     ///< how fast the cutoff grows with speed. >= 0
    double derivative_cutoff_hz = 0.5;  ///< smoothing of the speed estimate. > 0
};

/// A low-pass whose cutoff grows with speed: calm at rest, little lag in motion.
/// Casiez, Roussel, Vogel: "1 Euro Filter", CHI 2012. Uses the real time between samples.
/// Non-positive cutoffs and a negative beta are taken as the smallest legal value.
/// @thread one thread at a time; objects are independent
/// @since 0.1
class OneEuroFilter {
 public:
    explicit OneEuroFilter(const OneEuroSettings& settings = {});

    /// The filtered value at `stamp`. The first sample passes through. A sample whose stamp is not
    /// later than the one before, or that is not finite, is skipped: the last output comes back.
    double filter(double value, Stamp stamp) noexcept;

    /// Forgets everything, as for a hand with a new id.
    void reset() noexcept { started_ = false; }

 private:
    OneEuroSettings settings_;
    bool started_ = false;
    Stamp stamp_;
    double value_ = 0.0;
    double slope_ = 0.0;
};

/// Three of them, for a point. Each axis adapts by itself, as in the paper's reference.
/// @thread one thread at a time; objects are independent
/// @since 0.1
class OneEuroFilter3 {
 public:
    explicit OneEuroFilter3(const OneEuroSettings& settings = {})
        : axes_{OneEuroFilter{settings}, OneEuroFilter{settings}, OneEuroFilter{settings}} {}

    Vec3f filter(const Vec3f& point, Stamp stamp) noexcept {
        Vec3f out;
        for (std::size_t i = 0; i < axes_.size(); ++i) {
            const auto axis = static_cast<Eigen::Index>(i);
            out[axis] =
                static_cast<float>(axes_[i].filter(static_cast<double>(point[axis]), stamp));
        }
        return out;
    }
    void reset() noexcept {
        for (OneEuroFilter& axis : axes_) {
            axis.reset();
        }
    }

 private:
    std::array<OneEuroFilter, 3> axes_;
};

}  // namespace xtrack
