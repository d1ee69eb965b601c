// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <xtrack/image.hpp>
#include <xtrack/result.hpp>

#include "core/depth/triangulation.hpp"

namespace xtrack {

/// The coordinate nearest to which a period is unwrapped when the order follows from the working
/// volume: the middle of what a pixel can see. It varies slowly, so one row serves a few.
class OrderReference {
 public:
    OrderReference() = default;

    /// Where the period is as long as the coded axis, the middle of the projector serves all.
    /// Where the volume reaches further than one period, by up to a tenth, both ends are given up
    /// as far as they could be taken for each other.
    /// @param geometry null: no rig
    /// @return unsupported when the period repeats within the working volume
    [[nodiscard]] static Result<OrderReference> create(const Triangulation* geometry, Size image,
                                                       double period_px, int coded_length_px);

    /// What may lie between a coordinate and the reference, in shares of the period; 0.5 = all.
    [[nodiscard]] float tolerance() const noexcept { return tolerance_; }
    /// `width` floats for image row y.
    [[nodiscard]] const float* row(int y) const noexcept {
        return middle_px_.row(y / kRowsPerEntry);
    }

 private:
    static constexpr int kRowsPerEntry = 4;
    Image<float> middle_px_;
    float tolerance_ = 0.5F;
};

}  // namespace xtrack
