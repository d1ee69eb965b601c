// SPDX-License-Identifier: Apache-2.0
#include "core/unwrap/spatial_row.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace xtrack {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kTurn = 2.0F * kPi;

std::uint64_t bit_if(bool set, int x) noexcept {
    return static_cast<std::uint64_t>(set ? 1U : 0U) << static_cast<unsigned>(x % kWordPixels);
}

float wrapped(float step) noexcept {
    return step > kPi ? step - kTurn : (step < -kPi ? step + kTurn : step);
}

}  // namespace

float step_deviation(float step, float before2, float before, float after, float after2) noexcept {
    before2 = std::isnan(before2) ? before : before2;
    after2 = std::isnan(after2) ? after : after2;
    const bool no_before = std::isnan(before);
    const bool no_after = std::isnan(after);
    if (no_before && no_after) {
        return std::fabs(step);
    }
    const float a = no_before ? after : before;
    const float a2 = no_before ? after2 : before2;
    const float b = no_after ? before : after;
    const float b2 = no_after ? before2 : after2;
    const float low = std::max(std::min(a, a2), std::min(b, b2));
    const float high = std::min(std::max(a, a2), std::max(b, b2));
    return std::fabs(step - 0.5F * (low + high));
}

void piece_row_scalar(const PieceRow& row) noexcept {
    int x = 0;
    for (const PhasePiece& piece : row.pieces) {
        for (; x < piece.end; ++x) {
            row.unwrapped_rad[x] = row.phase_rad[x] + piece.add_rad;
            row.component[x] = piece.component;
        }
    }
}

void subtract_row_scalar(const SubtractRow& row) noexcept {
    for (int x = 0; x < row.count; ++x) {
        const float off = wrapped(row.phase_rad[x] - row.from_rad[x]);
        // Rounding may lead past the ends.
        row.difference_rad[x] = off > kPi ? kPi : (off < -kPi ? -kPi : off);
    }
}

void take_row_scalar(const TakeRow& row) noexcept {
    for (int begin = 0; begin < row.count; begin += kWordPixels) {
        float best = 0.0F;
        for (int x = begin; x < std::min(begin + kWordPixels, row.count); ++x) {
            const float phase = row.phase_rad[x];
            const bool valid = std::fabs(phase) <= kPi;
            row.padded_phase_rad[x] = valid ? phase : std::numeric_limits<float>::quiet_NaN();
            row.padded_modulation[x] = valid ? known_modulation(row.modulation[x]) : 0.0F;
            best = std::max(best, row.padded_modulation[x]);
        }
        row.best_modulation[begin / kWordPixels] = best;
    }
}

void step_row_scalar(const StepRow& row) noexcept {
    for (int word = 0; word < row.words; ++word) {
        std::uint64_t valid = 0, right_up = 0, right_down = 0, below_up = 0, below_down = 0;
        for (int x = word * kWordPixels; x < (word + 1) * kWordPixels; ++x) {
            const float phase = row.phase_rad[x];
            const float right = row.phase_rad[x + 1] - phase;
            const float below = row.below_rad[x] - phase;
            valid |= bit_if(!std::isnan(phase), x);
            right_up |= bit_if(right < -kPi, x);
            right_down |= bit_if(right > kPi, x);
            below_up |= bit_if(below < -kPi, x);
            below_down |= bit_if(below > kPi, x);
            row.right_step_rad[x] = wrapped(right);
            row.below_step_rad[x] = wrapped(below);
        }
        row.valid[word] = valid;
        row.right_up[word] = right_up;
        row.right_down[word] = right_down;
        row.below_up[word] = below_up;
        row.below_down[word] = below_down;
    }
}

void judge_row_scalar(const JudgeRow& row) noexcept {
    for (int word = 0; word < row.words; ++word) {
        std::uint64_t possible = 0, sound = 0;
        for (int x = word * kWordPixels; x < (word + 1) * kWordPixels; ++x) {
            const float off =
                step_deviation(row.step_rad[x], row.beside_rad[0][x], row.beside_rad[1][x],
                               row.beside_rad[2][x], row.beside_rad[3][x]);
            const float weaker = std::min(row.modulation[x], row.other_modulation[x]);
            const bool within = off <= row.limit_rad;
            possible |= bit_if(within, x);
            const bool quiet = off <= row.sound_limit_rad && off * weaker <= row.noise;
            sound |= bit_if(within && (off <= row.floor_rad || quiet), x);
        }
        row.possible[word] = possible;
        row.sound[word] = sound;
    }
}

#if XTRACK_WITH_HIGHWAY
void piece_row(const PieceRow& row) noexcept { piece_row_highway(row); }
void subtract_row(const SubtractRow& row) noexcept { subtract_row_highway(row); }
void take_row(const TakeRow& row) noexcept { take_row_highway(row); }
void step_row(const StepRow& row) noexcept { step_row_highway(row); }
void judge_row(const JudgeRow& row) noexcept { judge_row_highway(row); }
#else
void piece_row(const PieceRow& row) noexcept { piece_row_scalar(row); }
void subtract_row(const SubtractRow& row) noexcept { subtract_row_scalar(row); }
void take_row(const TakeRow& row) noexcept { take_row_scalar(row); }
void step_row(const StepRow& row) noexcept { step_row_scalar(row); }
void judge_row(const JudgeRow& row) noexcept { judge_row_scalar(row); }
#endif

}  // namespace xtrack
