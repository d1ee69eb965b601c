// SPDX-License-Identifier: Apache-2.0
#include "gestures/segment/chamfer.hpp"

#include <algorithm>

namespace xtrack::segment {

void spread_rows_scalar(const SpreadRows& box) noexcept {
    // Backward is forward with every offset turned round.
    for (const bool backward : {false, true}) {
        const std::ptrdiff_t one = backward ? 1 : -1;
        const std::ptrdiff_t row = backward ? box.stride : -box.stride;
        for (int r = 0; r < box.rows; ++r) {
            const std::ptrdiff_t first = (backward ? box.rows - 1 - r : r) * box.stride;
            for (int k = 0; k < box.count; ++k) {
                const std::ptrdiff_t i = first + (backward ? box.count - 1 - k : k);
                int best = box.value[i];
                const auto offer = [&](std::ptrdiff_t offset, int cost) {
                    if (box.label == nullptr || box.label[i + offset] == box.label[i]) {
                        best = std::max(best, box.value[i + offset] - cost);
                    }
                };
                offer(one, kChamferUnit);
                offer(row, kChamferUnit);
                offer(row - 1, kChamferDiagonal);
                offer(row + 1, kChamferDiagonal);
                offer(row - 2, kChamferKnight);
                offer(row + 2, kChamferKnight);
                offer(2 * row - 1, kChamferKnight);
                offer(2 * row + 1, kChamferKnight);
                box.value[i] = static_cast<std::uint16_t>(best);
            }
        }
    }
}

void spread(const Grid& grid, const Box& box, std::span<std::uint16_t> value,
            std::span<const std::uint16_t> label) {
    if (box.empty()) {
        return;
    }
    const int first = grid.index(box.x_begin, box.y_begin);
    const SpreadRows rows{value.data() + first, label.empty() ? nullptr : label.data() + first,
                          grid.width, box.width(), box.y_end - box.y_begin};
#if XTRACK_WITH_HIGHWAY
    spread_rows_highway(rows);
#else
    spread_rows_scalar(rows);
#endif
}

}  // namespace xtrack::segment
