// SPDX-License-Identifier: Apache-2.0
#include "core/unwrap/spatial_row.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/unwrap/spatial_row_highway.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <cstring>
#include <limits>
#include <numbers>

HWY_BEFORE_NAMESPACE();
namespace xtrack::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
// A whole number of vectors makes a word.
using D = hn::CappedTag<float, kWordPixels>;
using V = hn::Vec<D>;
using M = hn::Mask<D>;

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kTurn = 2.0F * kPi;

HWY_INLINE std::uint64_t bits_at(M mask, int lane) {
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(D(), mask, bytes);
    std::uint64_t bits = 0;
    std::memcpy(&bits, bytes, sizeof bits);
    return bits << static_cast<unsigned>(lane);
}

// The lines follow the scalar forms, which say why.
void take(const TakeRow& row) {
    const D d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    const V nan = hn::Set(d, std::numeric_limits<float>::quiet_NaN());
    const V pi = hn::Set(d, kPi);
    const V most = hn::Set(d, kMostModulation);
    const int whole = row.count / kWordPixels * kWordPixels;
    for (int begin = 0; begin < whole; begin += kWordPixels) {
        V best = hn::Zero(d);
        for (int x = begin; x < begin + kWordPixels; x += lanes) {
            const V phase = hn::LoadU(d, row.phase_rad + x);
            const V modulation = hn::LoadU(d, row.modulation + x);
            const M valid = hn::Le(hn::Abs(phase), pi);
            const M known = hn::And(hn::Ge(modulation, hn::Zero(d)), hn::Le(modulation, most));
            const V kept = hn::IfThenElseZero(hn::And(valid, known), modulation);
            hn::StoreU(hn::IfThenElse(valid, phase, nan), d, row.padded_phase_rad + x);
            hn::StoreU(kept, d, row.padded_modulation + x);
            best = hn::Max(best, kept);
        }
        row.best_modulation[begin / kWordPixels] = hn::GetLane(hn::MaxOfLanes(d, best));
    }
    if (whole < row.count) {
        TakeRow rest = row;
        rest.count -= whole;
        rest.phase_rad += whole;
        rest.modulation += whole;
        rest.padded_phase_rad += whole;
        rest.padded_modulation += whole;
        rest.best_modulation += whole / kWordPixels;
        take_row_scalar(rest);
    }
}

HWY_INLINE V wrapped(V step, M up, M down) {
    const V turn = hn::Set(D(), kTurn);
    return hn::IfThenElse(down, hn::Sub(step, turn), hn::IfThenElse(up, hn::Add(step, turn), step));
}

void pieces(const PieceRow& row) {
    const D d;
    const hn::Rebind<std::uint16_t, D> d16;
    const int lanes = static_cast<int>(hn::Lanes(d));
    int begin = 0;
    for (const PhasePiece& piece : row.pieces) {
        const V add = hn::Set(d, piece.add_rad);
        const auto component = hn::Set(d16, piece.component);
        int x = begin;
        // Whole vectors, past the end of the piece: what comes next overwrites the rest.
        for (; x < piece.end && x + lanes <= row.count; x += lanes) {
            hn::StoreU(hn::Add(hn::LoadU(d, row.phase_rad + x), add), d, row.unwrapped_rad + x);
            hn::StoreU(component, d16, row.component + x);
        }
        for (; x < piece.end; ++x) {
            row.unwrapped_rad[x] = row.phase_rad[x] + piece.add_rad;
            row.component[x] = piece.component;
        }
        begin = piece.end;
    }
}

void subtract(const SubtractRow& row) {
    const D d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    if (row.count < lanes) {
        subtract_row_scalar(row);
        return;
    }
    const V pi = hn::Set(d, kPi);
    const V minus_pi = hn::Set(d, -kPi);
    for (int x = 0; x < row.count; x += lanes) {
        // The last vector overlaps the one before it instead of running over the end.
        const int at = x + lanes <= row.count ? x : row.count - lanes;
        const V off = hn::Sub(hn::LoadU(d, row.phase_rad + at), hn::LoadU(d, row.from_rad + at));
        const V turned = wrapped(off, hn::Lt(off, minus_pi), hn::Gt(off, pi));
        // Rounding may lead past the ends. Min and Max do not keep NaN on every target.
        const V inside = hn::Min(hn::Max(turned, minus_pi), pi);
        hn::StoreU(hn::IfThenElse(hn::IsNaN(turned), turned, inside), d, row.difference_rad + at);
    }
}

void step(const StepRow& row) {
    const D d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    const V pi = hn::Set(d, kPi);
    const V minus_pi = hn::Set(d, -kPi);
    for (int word = 0; word < row.words; ++word) {
        std::uint64_t valid = 0, right_up = 0, right_down = 0, below_up = 0, below_down = 0;
        for (int lane = 0; lane < kWordPixels; lane += lanes) {
            const int x = word * kWordPixels + lane;
            const V phase = hn::LoadU(d, row.phase_rad + x);
            const V right = hn::Sub(hn::LoadU(d, row.phase_rad + x + 1), phase);
            const V below = hn::Sub(hn::LoadU(d, row.below_rad + x), phase);
            const M ru = hn::Lt(right, minus_pi);
            const M rd = hn::Gt(right, pi);
            const M bu = hn::Lt(below, minus_pi);
            const M bd = hn::Gt(below, pi);
            valid |= bits_at(hn::Eq(phase, phase), lane);
            right_up |= bits_at(ru, lane);
            right_down |= bits_at(rd, lane);
            below_up |= bits_at(bu, lane);
            below_down |= bits_at(bd, lane);
            hn::StoreU(wrapped(right, ru, rd), d, row.right_step_rad + x);
            hn::StoreU(wrapped(below, bu, bd), d, row.below_step_rad + x);
        }
        row.valid[word] = valid;
        row.right_up[word] = right_up;
        row.right_down[word] = right_down;
        row.below_up[word] = below_up;
        row.below_down[word] = below_down;
    }
}

HWY_INLINE V deviation(V step, V before2, V before, V after, V after2) {
    const M no_before = hn::IsNaN(before);
    const M no_after = hn::IsNaN(after);
    before2 = hn::IfThenElse(hn::IsNaN(before2), before, before2);
    after2 = hn::IfThenElse(hn::IsNaN(after2), after, after2);
    const V a = hn::IfThenElse(no_before, after, before);
    const V a2 = hn::IfThenElse(no_before, after2, before2);
    const V b = hn::IfThenElse(no_after, before, after);
    const V b2 = hn::IfThenElse(no_after, before2, after2);
    const V low = hn::Max(hn::Min(a, a2), hn::Min(b, b2));
    const V high = hn::Min(hn::Max(a, a2), hn::Max(b, b2));
    const V median = hn::Mul(hn::Set(D(), 0.5F), hn::Add(low, high));
    const M alone = hn::And(no_before, no_after);
    return hn::Abs(hn::Sub(step, hn::IfThenElse(alone, hn::Zero(D()), median)));
}

void judge(const JudgeRow& row) {
    const D d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    const V limit = hn::Set(d, row.limit_rad);
    const V noise = hn::Set(d, row.noise);
    const V floor = hn::Set(d, row.floor_rad);
    const V sound_limit = hn::Set(d, row.sound_limit_rad);
    for (int word = 0; word < row.words; ++word) {
        std::uint64_t possible = 0, sound = 0;
        for (int lane = 0; lane < kWordPixels; lane += lanes) {
            const int x = word * kWordPixels + lane;
            const V off =
                deviation(hn::LoadU(d, row.step_rad + x), hn::LoadU(d, row.beside_rad[0] + x),
                          hn::LoadU(d, row.beside_rad[1] + x), hn::LoadU(d, row.beside_rad[2] + x),
                          hn::LoadU(d, row.beside_rad[3] + x));
            const V weaker =
                hn::Min(hn::LoadU(d, row.modulation + x), hn::LoadU(d, row.other_modulation + x));
            const M within = hn::Le(off, limit);
            const M quiet = hn::And(hn::Le(off, sound_limit), hn::Le(hn::Mul(off, weaker), noise));
            const M usual = hn::Or(hn::Le(off, floor), quiet);
            possible |= bits_at(within, lane);
            sound |= bits_at(hn::And(within, usual), lane);
        }
        row.possible[word] = possible;
        row.sound[word] = sound;
    }
}

}  // namespace
}  // namespace xtrack::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace xtrack {

HWY_EXPORT(pieces);
HWY_EXPORT(subtract);
HWY_EXPORT(take);
HWY_EXPORT(step);
HWY_EXPORT(judge);

void piece_row_highway(const PieceRow& row) noexcept { HWY_DYNAMIC_DISPATCH(pieces)(row); }
void subtract_row_highway(const SubtractRow& row) noexcept { HWY_DYNAMIC_DISPATCH(subtract)(row); }
void take_row_highway(const TakeRow& row) noexcept { HWY_DYNAMIC_DISPATCH(take)(row); }
void step_row_highway(const StepRow& row) noexcept { HWY_DYNAMIC_DISPATCH(step)(row); }
void judge_row_highway(const JudgeRow& row) noexcept { HWY_DYNAMIC_DISPATCH(judge)(row); }

}  // namespace xtrack
#endif
