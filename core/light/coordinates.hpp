// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <complex>
#include <cstddef>
#include <span>
#include <vector>

#include <xtrack/pattern.hpp>
#include <xtrack/result.hpp>

#include "core/decode/taps.hpp"
#include "core/depth/order_reference.hpp"
#include "core/depth/triangulation.hpp"
#include "core/light/light_samples.hpp"
#include "core/pattern/response_curve.hpp"

namespace xtrack {

/// The grey sines of one period.
struct GreyPeriod {
    double period_px = 0.0;
    std::vector<int> patterns;
    std::vector<double> phases_rad;
};

/// Grey periods of a sequence that have three or more steps, longest first.
[[nodiscard]] std::vector<GreyPeriod> grey_periods(const PatternSequence& sequence);

/// Grey levels of a pixel without the projector's light, and what full light adds.
struct LightRange {
    double black = 0.0;
    double range = 0.0;
};

/// Finds the projector coordinate that each sample sees, from the luma of grey sines.
/// @thread const calls from any
class GreyCoordinates {
 public:
    /// @param geometry for a longest period that is shorter than the coded axis; null: no rig
    /// @return an Error where the periods' phases or order do not determine a coordinate
    [[nodiscard]] static Result<GreyCoordinates> create(const PatternSequence& sequence, Size image,
                                                        const Triangulation* geometry);

    /// @param response of grey patterns to luma
    /// @return projector px, one for each of `pixels`; NaN: none
    /// @pre the sines were seen by each of `pixels`
    [[nodiscard]] std::vector<float> of(const LightSamples& samples,
                                        std::span<const std::size_t> pixels,
                                        const ResponseCurve& response) const;

    /// Black and white by the longest period. @pre the projector is linear, the sines were seen
    [[nodiscard]] LightRange range(const LightSamples& samples, std::size_t channel,
                                   std::size_t pixel) const;
    /// The patterns that are used.
    [[nodiscard]] std::vector<int> patterns() const;

 private:
    struct Period {
        GreyPeriod images;
        TapSet taps;

        /// B e^{i phi}
        [[nodiscard]] std::complex<double> sum(const LightSamples& samples, std::size_t channel,
                                               std::size_t pixel) const;
    };
    OrderReference reference_;
    std::vector<Period> periods_;
};

}  // namespace xtrack
