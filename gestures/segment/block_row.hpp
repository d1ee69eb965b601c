// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace xtrack::segment {

/// One row of blocks of depth pixels, `scale` on a side, each of which becomes one number: the mean
/// of the nearest surface in it.
struct BlockRow {
    const std::uint16_t* depth = nullptr;  ///< first pixel of the first block
    std::ptrdiff_t stride = 0;             ///< pixels from one row of the image to the next
    int scale = 1;
    int count = 0;           ///< blocks
    std::uint16_t low = 1;   ///< nearer is no depth, steps
    std::uint16_t band = 0;  ///< pixels within this of the nearest are the same surface, steps
    float unit_mm = 0.0F;    ///< of a step
    float* z_mm = nullptr;   ///< out: 0 = no depth
};

/// Of a block's pixels so many are looked at in a row, at most ...
inline constexpr int kBlockSamples = 4;
/// ... and so many of its rows where it has more than three: half of eight pixels say enough.
[[nodiscard]] constexpr int block_rows(int scale) noexcept { return scale > 3 ? 2 : scale; }
/// Which row, or pixel of a row, is the k-th of those that are looked at.
[[nodiscard]] constexpr int block_sample(int k, int samples, int scale) noexcept {
    return (2 * k + 1) * scale / (2 * samples);
}
/// From this scale on, one pixel that is nearer than all others of its block is a flying one.
inline constexpr int kBlockRobustScale = 3;
/// No depth, in steps: farther than everything.
inline constexpr std::uint16_t kBlockNone = 65535;

/// By the fastest form that this CPU has. The same bits as the scalar form's.
/// @thread any; rows are independent
void block_row(const BlockRow& row) noexcept;

/// The reference form, plain C++.
void block_row_scalar(const BlockRow& row) noexcept;

#if XTRACK_WITH_HIGHWAY
void block_row_highway(const BlockRow& row) noexcept;
#endif

}  // namespace xtrack::segment
