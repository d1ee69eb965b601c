// SPDX-License-Identifier: Apache-2.0
#include "gestures/segment/block_row.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "gestures/segment/block_row_highway.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace xtrack::segment::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::ScalableTag<float>;
using D16 = hn::Rebind<std::uint16_t, D>;
using V16 = hn::Vec<D16>;

/// Calls f for each pixel of the blocks, one column of all blocks at a time.
template <int kScale, typename F>
HWY_INLINE void each_pixel(const std::uint16_t* first, std::ptrdiff_t stride, F&& f) {
    const D16 d;
    constexpr int kRows = block_rows(kScale);
    for (int k = 0; k < kRows; ++k) {
        const std::uint16_t* const from = first + block_sample(k, kRows, kScale) * stride;
        if constexpr (kScale == 1) {
            f(hn::LoadU(d, from));
        } else if constexpr (kScale == 2) {
            V16 a, b;
            hn::LoadInterleaved2(d, from, a, b);
            f(a);
            f(b);
        } else if constexpr (kScale == 3) {
            V16 a, b, c;
            hn::LoadInterleaved3(d, from, a, b, c);
            f(a);
            f(b);
            f(c);
        } else {
            V16 a, b, c, e;
            hn::LoadInterleaved4(d, from, a, b, c, e);
            f(a);
            f(b);
            f(c);
            f(e);
        }
    }
}

template <int kScale>
void blocks_of(const BlockRow& shared) {
    const BlockRow row = shared;  // a copy: what is stored could be part of it to the compiler
    const D d;
    const D16 d16;
    const hn::RebindToSigned<D> d32;
    const int lanes = static_cast<int>(hn::Lanes(d));
    constexpr bool kRobust = kScale >= kBlockRobustScale;
    const V16 none = hn::Set(d16, kBlockNone);
    const V16 low = hn::Set(d16, row.low);
    const V16 band = hn::Set(d16, row.band);
    const V16 one = hn::Set(d16, std::uint16_t{1});
    const auto unit = hn::Set(d, row.unit_mm);
    for (int i = 0; i < row.count; i += lanes) {
        // The last vector overlaps the one before it instead of running over the end.
        const int at = i + lanes <= row.count ? i : row.count - lanes;
        const std::uint16_t* const from = row.depth + static_cast<std::ptrdiff_t>(at) * kScale;
        V16 first = none;
        V16 second = none;
        each_pixel<kScale>(from, row.stride, [&](V16 raw) HWY_ATTR {
            const V16 v = hn::IfThenElse(hn::Eq(hn::Max(raw, low), raw), raw, none);
            if constexpr (kRobust) {
                second = hn::Min(second, hn::Max(first, v));
            }
            first = hn::Min(first, v);
        });
        const V16 nearest = kRobust ? second : first;
        const V16 begin = kRobust ? hn::Max(hn::SaturatedSub(nearest, band), low) : nearest;
        const V16 most = hn::Min(hn::SaturatedAdd(nearest, band), hn::Sub(none, one));
        const auto nothing = hn::Eq(nearest, none);
        // Unsigned: what lies before the beginning is far beyond the end.
        const V16 range = hn::Sub(most, begin);
        V16 sum = hn::Zero(d16);
        V16 count = hn::Zero(d16);
        each_pixel<kScale>(from, row.stride, [&](V16 raw) HWY_ATTR {
            const V16 above = hn::Sub(raw, begin);
            const auto same = hn::Eq(hn::Min(above, range), above);
            sum = hn::Add(sum, hn::IfThenElseZero(same, above));
            count = hn::Add(count, hn::IfThenElseZero(same, one));
        });
        const auto real = [&](V16 v) HWY_ATTR { return hn::ConvertTo(d, hn::PromoteTo(d32, v)); };
        const auto mean = hn::Div(real(sum), real(hn::Max(count, one)));
        const auto z = hn::Mul(unit, hn::Add(real(hn::IfThenZeroElse(nothing, begin)), mean));
        hn::StoreU(
            hn::IfThenZeroElse(hn::Eq(real(hn::IfThenZeroElse(nothing, count)), hn::Zero(d)), z), d,
            row.z_mm + at);
    }
}

void blocks(const BlockRow& row) {
    if (row.count < static_cast<int>(hn::Lanes(D())) || row.scale > kBlockSamples) {
        block_row_scalar(row);
        return;
    }
    switch (row.scale) {
        case 1: blocks_of<1>(row); break;
        case 2: blocks_of<2>(row); break;
        case 3: blocks_of<3>(row); break;
        default: blocks_of<4>(row); break;
    }
}

}  // namespace
}  // namespace xtrack::segment::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace xtrack::segment {

HWY_EXPORT(blocks);

void block_row_highway(const BlockRow& row) noexcept { HWY_DYNAMIC_DISPATCH(blocks)(row); }

}  // namespace xtrack::segment
#endif
