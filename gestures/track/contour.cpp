// SPDX-License-Identifier: Apache-2.0
#include "gestures/track/contour.hpp"

#include <array>

namespace xtrack::track {

void Contour::create(const segment::Grid& grid) {
    limit_ = static_cast<std::size_t>(8 * (grid.inner_width + grid.inner_height));
    points_.reserve(limit_);
}

void Contour::trace(const segment::Grid& grid, std::span<const std::uint8_t> labels,
                    const HandRegion& region) {
    points_.clear();
    const int w = grid.width;
    // Clockwise from the left, y down.
    const std::array<int, 8> around = {-1, -w - 1, -w, -w + 1, 1, w + 1, w, w - 1};
    const auto inside = [&](int i) { return labels[static_cast<std::size_t>(i)] == region.label; };
    // The raster-first pixel of the label is on its outer rim, whatever holes it has.
    const int end = grid.index(region.x_end, region.y_begin);
    int first = grid.index(region.x_begin, region.y_begin);
    while (first < end && !inside(first)) {
        ++first;
    }
    if (first == end) {
        return;
    }
    int here = first;
    int back = 0;  // direction of the empty pixel that was left behind: to the left of the first
    do {
        points_.push_back(here);
        int next = -1;
        for (int k = 1; k <= 8; ++k) {
            const int direction = (back + k) % 8;
            if (inside(here + around[static_cast<std::size_t>(direction)])) {
                next = direction;
                break;
            }
        }
        if (next < 0) {
            return;  // a single pixel
        }
        here += around[static_cast<std::size_t>(next)];
        // The pixel examined before this one was empty: seen from the new place it lies two steps
        // (after a straight move) or three (after a diagonal one) back.
        back = (next + (next % 2 == 0 ? 6 : 5)) % 8;
    } while (here != first && points_.size() < limit_);
}

}  // namespace xtrack::track
