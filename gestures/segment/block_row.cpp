// SPDX-License-Identifier: Apache-2.0
#include "gestures/segment/block_row.hpp"

#include <algorithm>
#include <array>

namespace xtrack::segment {

void block_row_scalar(const BlockRow& row) noexcept {
    const int columns = std::min(row.scale, kBlockSamples);
    const int rows = block_rows(row.scale);
    const int samples = rows * columns;
    std::array<std::ptrdiff_t, 3 * kBlockSamples> at{};
    for (int k = 0; k < samples; ++k) {
        at[static_cast<std::size_t>(k)] = block_sample(k / columns, rows, row.scale) * row.stride +
                                          block_sample(k % columns, columns, row.scale);
    }
    const bool robust = row.scale >= kBlockRobustScale;
    for (int x = 0; x < row.count; ++x) {
        const std::uint16_t* const block = row.depth + static_cast<std::ptrdiff_t>(x) * row.scale;
        std::array<int, 3 * kBlockSamples> pixel{};
        int first = kBlockNone;
        int second = kBlockNone;
        for (std::size_t k = 0; k < static_cast<std::size_t>(samples); ++k) {
            const int d = block[at[k]] >= row.low ? block[at[k]] : kBlockNone;
            pixel[k] = d;
            second = std::min(second, std::max(first, d));
            first = std::min(first, d);
        }
        const int nearest = robust ? second : first;
        const int low = robust ? std::max<int>(nearest - row.band, row.low) : nearest;
        const int high = std::min<int>(nearest + row.band, kBlockNone - 1);
        int sum = 0;
        int count = 0;
        for (std::size_t k = 0; k < static_cast<std::size_t>(samples); ++k) {
            const bool same = pixel[k] >= low && pixel[k] <= high;
            sum += same ? pixel[k] - low : 0;
            count += same ? 1 : 0;
        }
        const float mean = static_cast<float>(sum) / static_cast<float>(std::max(count, 1));
        row.z_mm[x] = count > 0 ? row.unit_mm * (static_cast<float>(low) + mean) : 0.0F;
    }
}

#if XTRACK_WITH_HIGHWAY
void block_row(const BlockRow& row) noexcept { block_row_highway(row); }
#else
void block_row(const BlockRow& row) noexcept { block_row_scalar(row); }
#endif

}  // namespace xtrack::segment
