// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "core/decode/taps.hpp"
#include "core/pattern/response_curve.hpp"

namespace xtrack {

/// Subtracts the phase error of a projector with a known response.
///
/// A response turns a sine into a sum of harmonics whose ratios depend on the response alone;
/// ambient light adds a constant and albedo a factor, so the phase that a tap set measures is a
/// function of the true phase. It is tabulated here and inverted. Correcting grey values instead
/// would need the ambient light of each pixel.
class GammaCorrection {
 public:
    /// Corrects nothing.
    GammaCorrection() = default;

    /// @param taps with the phases they belong to: the correction is that of this combination
    /// @param responses one for each phase: of the colour that shows it; linear ones correct
    /// nothing
    GammaCorrection(const TapSet& taps, std::span<const double> phases_rad,
                    std::span<const ResponseCurve> responses);
    /// The same where all phases are shown alike.
    GammaCorrection(const TapSet& taps, std::span<const double> phases_rad,
                    const ResponseCurve& response);

    /// True when apply() changes nothing.
    [[nodiscard]] bool identity() const noexcept { return correction_rad_.empty(); }

    /// Measured phase -> true phase, in place, (-pi, pi]; NaN stays.
    void apply(int count, float* phase_rad) const noexcept;

 private:
    std::vector<float> correction_rad_;  // at kEntries measured phases from -pi, and pi again
};

}  // namespace xtrack
