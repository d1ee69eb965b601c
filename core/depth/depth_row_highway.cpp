// SPDX-License-Identifier: Apache-2.0
#include "core/depth/depth_row.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/depth/depth_row_highway.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <xtrack/depth.hpp>

HWY_BEFORE_NAMESPACE();
namespace xtrack::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// Added to 2^23, a number is rounded to a whole one, which a float's last bits then are.
constexpr float kRounding = 8388608.0F;

template <bool kAffine>
void depth_pixels(const DepthRow& shared) {
    const hn::ScalableTag<float> d;
    // A copy, as what is stored could be part of `shared` for all that the compiler knows.
    const DepthRow row = shared;
    const hn::RebindToUnsigned<decltype(d)> du;
    const hn::Rebind<std::uint16_t, decltype(d)> d16;
    const hn::Rebind<std::uint8_t, decltype(d)> d8;
    const int lanes = static_cast<int>(hn::Lanes(d));
    const auto rounding = hn::Set(d, kRounding);
    const auto steps_per_mm = hn::Set(d, static_cast<float>(1.0 / kDepthUnitMm));
    const auto a_step = hn::Set(d, row.a_step);
    const auto c_step = hn::Set(d, row.c_step);
    const auto a0 = hn::Set(d, row.a0);
    const auto c0 = hn::Set(d, row.c0);
    const auto minus_b = hn::Set(d, -row.b);
    const auto slope = hn::Set(d, row.d);
    const auto nearest = hn::Set(d, row.near_mm);
    const auto farthest = hn::Set(d, row.far_mm);
    const auto least_trust = hn::Set(d, 1.0F);
    const auto most_trust = hn::Set(d, 255.0F);
    for (int i = 0; i < row.count; i += lanes) {
        // The last vector overlaps the one before it instead of running over the end.
        const int at = i + lanes <= row.count ? i : row.count - lanes;
        auto a = a0;
        auto c = c0;
        if constexpr (kAffine) {
            const auto column = hn::Iota(d, static_cast<float>(at));
            a = hn::MulAdd(column, a_step, a0);
            c = hn::MulAdd(column, c_step, c0);
        } else {
            a = hn::LoadU(d, row.a + at);
            c = hn::LoadU(d, row.c + at);
        }
        const auto x = hn::LoadU(d, row.coordinate_px + at);
        const auto z = hn::Div(hn::MulAdd(slope, x, minus_b), hn::NegMulAdd(c, x, a));
        const auto good = hn::And(hn::Ge(z, nearest), hn::Le(z, farthest));
        const auto steps = hn::IfThenElseZero(good, hn::MulAdd(z, steps_per_mm, rounding));
        hn::StoreU(hn::TruncateTo(d16, hn::BitCast(du, steps)), d16, row.depth + at);
        const auto trust =
            hn::Min(hn::Max(hn::LoadU(d, row.modulation + at), least_trust), most_trust);
        const auto levels = hn::IfThenElseZero(good, hn::Add(trust, rounding));
        hn::StoreU(hn::TruncateTo(d8, hn::BitCast(du, levels)), d8, row.quality + at);
    }
}

void depth(const DepthRow& row) {
    if (row.count < static_cast<int>(hn::Lanes(hn::ScalableTag<float>()))) {
        depth_row_scalar(row);
    } else if (row.a == nullptr) {
        depth_pixels<true>(row);
    } else {
        depth_pixels<false>(row);
    }
}

}  // namespace
}  // namespace xtrack::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace xtrack {

HWY_EXPORT(depth);

void depth_row_highway(const DepthRow& row) noexcept { HWY_DYNAMIC_DISPATCH(depth)(row); }

}  // namespace xtrack
#endif
