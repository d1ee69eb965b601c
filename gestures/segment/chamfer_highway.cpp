// SPDX-License-Identifier: Apache-2.0
#include "gestures/segment/chamfer.hpp"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "gestures/segment/chamfer_highway.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace xtrack::segment::HWY_NAMESPACE {
namespace {

#if HWY_TARGET == HWY_SCALAR

void spread_rows(const SpreadRows& box) { spread_rows_scalar(box); }

#else

namespace hn = hwy::HWY_NAMESPACE;
// Eight lanes on every processor: the way along a row takes steps of 1, 2 and 4 lanes.
constexpr int kLanes = 8;
using D = hn::FixedTag<std::uint16_t, kLanes>;
using V = hn::Vec<D>;

template <int kBy, bool kBackward>
HWY_INLINE V moved(V v) {
    const D d;
    if constexpr (kBackward) {
        return hn::ShiftRightLanes<kBy>(d, v);
    } else {
        return hn::ShiftLeftLanes<kBy>(d, v);
    }
}

/// Eight pixels from i on. Lanes that moved() empties are 0, which is as far as can be.
template <bool kLabels, bool kBackward>
HWY_INLINE void eight(const SpreadRows& box, std::ptrdiff_t i, V by_lane) {
    const D d;
    const std::ptrdiff_t row = kBackward ? box.stride : -box.stride;
    V v = hn::LoadU(d, box.value + i);
    V own = v;
    if constexpr (kLabels) {
        own = hn::LoadU(d, box.label + i);
    }
    const auto offer = [&](std::ptrdiff_t offset, int cost) HWY_ATTR {
        V c = hn::SaturatedSub(hn::LoadU(d, box.value + i + offset),
                               hn::Set(d, static_cast<std::uint16_t>(cost)));
        if constexpr (kLabels) {
            c = hn::IfThenElseZero(hn::Eq(hn::LoadU(d, box.label + i + offset), own), c);
        }
        v = hn::Max(v, c);
    };
    offer(row, kChamferUnit);
    offer(row - 1, kChamferDiagonal);
    offer(row + 1, kChamferDiagonal);
    offer(row - 2, kChamferKnight);
    offer(row + 2, kChamferKnight);
    offer(2 * row - 1, kChamferKnight);
    offer(2 * row + 1, kChamferKnight);

    // Along the row: after steps of 1, 2 and 4 every lane knows the seven behind it, then comes
    // what the eight pixels before hand on. A label's end (all ones in `ends`) stops all of it.
    constexpr std::ptrdiff_t kBehind = kBackward ? 1 : -1;
    const V carry =
        hn::SaturatedSub(hn::Set(d, box.value[kBackward ? i + kLanes : i - 1]), by_lane);
    const auto less = [&](V from, int steps) HWY_ATTR {
        return hn::SaturatedSub(from, hn::Set(d, static_cast<std::uint16_t>(steps * kChamferUnit)));
    };
    if constexpr (kLabels) {
        V ends = hn::VecFromMask(d, hn::Ne(hn::LoadU(d, box.label + i + kBehind), own));
        v = hn::Max(v, hn::AndNot(ends, less(moved<1, kBackward>(v), 1)));
        ends = hn::Or(ends, moved<1, kBackward>(ends));
        v = hn::Max(v, hn::AndNot(ends, less(moved<2, kBackward>(v), 2)));
        ends = hn::Or(ends, moved<2, kBackward>(ends));
        v = hn::Max(v, hn::AndNot(ends, less(moved<4, kBackward>(v), 4)));
        ends = hn::Or(ends, moved<4, kBackward>(ends));
        v = hn::Max(v, hn::AndNot(ends, carry));
    } else {
        v = hn::Max(v, less(moved<1, kBackward>(v), 1));
        v = hn::Max(v, less(moved<2, kBackward>(v), 2));
        v = hn::Max(v, less(moved<4, kBackward>(v), 4));
        v = hn::Max(v, carry);
    }
    hn::StoreU(v, d, box.value + i);
}

template <bool kLabels, bool kBackward>
void pass(const SpreadRows& shared) {
    const SpreadRows box = shared;  // a copy: what is stored could be part of it to the compiler
    const D d;
    alignas(16) static constexpr std::uint16_t kForwardCosts[kLanes] = {5,  10, 15, 20,
                                                                        25, 30, 35, 40};
    alignas(16) static constexpr std::uint16_t kBackwardCosts[kLanes] = {40, 35, 30, 25,
                                                                         20, 15, 10, 5};
    static_assert(kForwardCosts[0] == kChamferUnit && kBackwardCosts[7] == kChamferUnit);
    const V by_lane = hn::Load(d, kBackward ? kBackwardCosts : kForwardCosts);
    for (int r = 0; r < box.rows; ++r) {
        const std::ptrdiff_t first = (kBackward ? box.rows - 1 - r : r) * box.stride;
        // The last eight overlap those before: to raise a value twice is to raise it once.
        for (int k = 0; k < box.count; k += kLanes) {
            const int at = std::min(k, box.count - kLanes);
            const int x = kBackward ? box.count - kLanes - at : at;
            eight<kLabels, kBackward>(box, first + x, by_lane);
        }
    }
}

void spread_rows(const SpreadRows& box) {
    if (box.count < kLanes) {
        spread_rows_scalar(box);
    } else if (box.label != nullptr) {
        pass<true, false>(box);
        pass<true, true>(box);
    } else {
        pass<false, false>(box);
        pass<false, true>(box);
    }
}

#endif

}  // namespace
}  // namespace xtrack::segment::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace xtrack::segment {

HWY_EXPORT(spread_rows);

void spread_rows_highway(const SpreadRows& box) noexcept { HWY_DYNAMIC_DISPATCH(spread_rows)(box); }

}  // namespace xtrack::segment
#endif
