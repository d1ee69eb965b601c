// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gestures/segment/grid.hpp"

namespace xtrack::track {

/// The outer outline of one label, clockwise in the image, traced with Moore's neighbourhood.
class Contour {
 public:
    void create(const segment::Grid& grid);

    /// @param start a grid index inside the label; the tracing begins above it, at the rim
    void trace(const segment::Grid& grid, std::span<const std::uint8_t> labels, std::uint8_t label,
               int start);

    [[nodiscard]] std::span<const int> points() const noexcept { return points_; }

 private:
    std::vector<int> points_;
    std::size_t limit_ = 0;
};

}  // namespace xtrack::track
