// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace xtrack {

// The per-pixel work of SpatialUnwrapper, a row at a time. Rows are padded: `kRowMargin` floats on
// either side of whole words of 64 pixels are readable, and hold NaN (phase) or 0 (modulation), so
// that no kernel has an end to care for. Bit x % 64 of word x / 64 is pixel x.

inline constexpr int kRowMargin = 16;
inline constexpr int kWordPixels = 64;
/// Grey levels; what is above (or infinite, NaN or negative) is no modulation.
inline constexpr float kMostModulation = 1e6F;
[[nodiscard]] constexpr float known_modulation(float modulation) noexcept {
    return modulation >= 0.0F && modulation <= kMostModulation ? modulation : 0.0F;
}

/// One row taken in: what is no wrapped phase becomes NaN, what is no modulation, or belongs to no
/// phase, becomes 0.
struct TakeRow {
    int count = 0;                       ///< pixels
    const float* phase_rad = nullptr;    ///< outside -pi ... pi, infinite or NaN: masked
    const float* modulation = nullptr;   ///< grey levels
    float* padded_phase_rad = nullptr;   ///< out: `count` values
    float* padded_modulation = nullptr;  ///< out: `count` values
    float* best_modulation = nullptr;    ///< out: the largest of every 64 pixels
};

/// Wrapped differences from each pixel to the one on its right and to the one below it. A step that
/// wraps upward (phase falls by more than pi) adds one to the order, downward it takes one.
struct StepRow {
    int words = 0;
    const float* phase_rad = nullptr;  ///< padded
    const float* below_rad = nullptr;  ///< padded; the next row
    float* right_step_rad = nullptr;   ///< out, padded: NaN where either pixel is masked
    float* below_step_rad = nullptr;   ///< out, padded
    std::uint64_t* valid = nullptr;    ///< out: pixels that have a phase
    std::uint64_t* right_up = nullptr;
    std::uint64_t* right_down = nullptr;
    std::uint64_t* below_up = nullptr;
    std::uint64_t* below_down = nullptr;
};

/// How far a step is from the median of the two before it and the two after it along its own line:
/// a plane of any slope has none, a depth step stands out, even one that a pixel on the edge
/// halves, and so does a pixel of no meaning. Where one side is missing the other counts twice;
/// where both are, the step itself is judged.
struct JudgeRow {
    int words = 0;
    const float* step_rad = nullptr;  ///< padded
    /// Padded; of each step the ones two before, one before, one after, two after.
    std::array<const float*, 4> beside_rad{};
    const float* modulation = nullptr;        ///< of each step's first pixel, padded
    const float* other_modulation = nullptr;  ///< of each step's second pixel, padded
    float limit_rad = 0.0F;                   ///< more: not possible
    float noise = 0.0F;            ///< rad grey levels: more than noise / modulation is not sound
    float sound_limit_rad = 0.0F;  ///< nor is more than this, however faint the fringe is
    float floor_rad = 0.0F;        ///< less is sound in any case
    std::uint64_t* possible = nullptr;  ///< out: within the limit
    std::uint64_t* sound = nullptr;     ///< out: within the limit, and within the noise as well
};

/// The deviation above, of one step.
[[nodiscard]] float step_deviation(float step, float before2, float before, float after,
                                   float after2) noexcept;

/// What a row of phases is off a row of others, wrapped: -pi ... pi, NaN where either is none.
struct SubtractRow {
    int count = 0;                     ///< pixels
    const float* phase_rad = nullptr;  ///< -pi ... pi or NaN
    const float* from_rad = nullptr;   ///< the same
    float* difference_rad = nullptr;   ///< out
};

/// Pixels of a row up to `end`, from where the piece before ended: what is added to their phase
/// (NaN masks them), and the component that they are of.
struct PhasePiece {
    int end = 0;
    float add_rad = 0.0F;
    std::uint16_t component = 0;
};

/// A row put together from its pieces.
struct PieceRow {
    int count = 0;                       ///< pixels; where the last piece ends
    std::span<const PhasePiece> pieces;  ///< ends ascend
    const float* phase_rad = nullptr;    ///< must not be what is written
    float* unwrapped_rad = nullptr;      ///< out
    std::uint16_t* component = nullptr;  ///< out
};

/// @thread any; rows are independent
/// @ownership borrows everything for the call
void piece_row(const PieceRow& row) noexcept;
void subtract_row(const SubtractRow& row) noexcept;
void take_row(const TakeRow& row) noexcept;
void step_row(const StepRow& row) noexcept;
void judge_row(const JudgeRow& row) noexcept;

/// The reference forms, plain C++.
void piece_row_scalar(const PieceRow& row) noexcept;
void subtract_row_scalar(const SubtractRow& row) noexcept;
void take_row_scalar(const TakeRow& row) noexcept;
void step_row_scalar(const StepRow& row) noexcept;
void judge_row_scalar(const JudgeRow& row) noexcept;

#if XTRACK_WITH_HIGHWAY
void piece_row_highway(const PieceRow& row) noexcept;
void subtract_row_highway(const SubtractRow& row) noexcept;
void take_row_highway(const TakeRow& row) noexcept;
void step_row_highway(const StepRow& row) noexcept;
void judge_row_highway(const JudgeRow& row) noexcept;
#endif

}  // namespace xtrack
