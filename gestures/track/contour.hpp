// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <xtrack/hand_region.hpp>

#include "gestures/segment/grid.hpp"

namespace xtrack::track {

/// The outer outline of one label, clockwise in the image, traced with Moore's neighbourhood.
class Contour {
 public:
    void create(const segment::Grid& grid);

    /// The region's box must fit it.
    void trace(const segment::Grid& grid, std::span<const std::uint8_t> labels,
               const HandRegion& region);

    [[nodiscard]] std::span<const int> points() const noexcept { return points_; }

 private:
    std::vector<int> points_;
    std::size_t limit_ = 0;
};

}  // namespace xtrack::track
