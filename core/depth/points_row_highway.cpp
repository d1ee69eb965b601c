// SPDX-License-Identifier: Apache-2.0
#include "core/depth/points_row.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/depth/points_row_highway.cpp"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <cstddef>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace xtrack::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

template <bool kAffine>
void points_pixels(const PointsRow& row) {
    const hn::ScalableTag<float> d;
    const hn::RebindToSigned<decltype(d)> di;
    const hn::Rebind<std::uint16_t, decltype(d)> d16;
    const int lanes = static_cast<int>(hn::Lanes(d));
    const auto unit = hn::Set(d, row.unit_mm);
    const auto none = hn::Set(d, std::numeric_limits<float>::quiet_NaN());
    const auto x0 = hn::Set(d, row.x0);
    const auto y0 = hn::Set(d, row.y0);
    const auto x_step = hn::Set(d, row.x_step);
    const auto y_step = hn::Set(d, row.y_step);
    const bool aligned =
        reinterpret_cast<std::uintptr_t>(row.xyz_mm) % (sizeof(float) * hn::Lanes(d)) == 0;
    for (int i = 0; i < row.count; i += lanes) {
        // The last vector overlaps the one before it instead of running over the end.
        const int at = i + lanes <= row.count ? i : row.count - lanes;
        auto x = x0;
        auto y = y0;
        if constexpr (kAffine) {
            const auto column = hn::Iota(d, static_cast<float>(at));
            x = hn::MulAdd(column, x_step, x0);
            y = hn::MulAdd(column, y_step, y0);
        } else {
            x = hn::LoadU(d, row.ray_x + at);
            y = hn::LoadU(d, row.ray_y + at);
        }
        const auto steps = hn::ConvertTo(d, hn::PromoteTo(di, hn::LoadU(d16, row.depth + at)));
        const auto z = hn::IfThenElse(hn::Gt(steps, hn::Zero(d)), hn::Mul(steps, unit), none);
        float* const out = row.xyz_mm + 3 * static_cast<std::ptrdiff_t>(at);
        if (at != i || !aligned) {
            hn::StoreInterleaved3(hn::Mul(x, z), hn::Mul(y, z), z, d, out);
            continue;
        }
        // Points are more bytes than all else together, and read by nobody soon: past the caches.
        HWY_ALIGN float three[3 * hn::MaxLanes(d)];
        hn::StoreInterleaved3(hn::Mul(x, z), hn::Mul(y, z), z, d, three);
        for (int part = 0; part < 3; ++part) {
            hn::Stream(hn::Load(d, three + part * lanes), d, out + part * lanes);
        }
    }
    hwy::FlushStream();
}

void points(const PointsRow& row) {
    if (row.count < static_cast<int>(hn::Lanes(hn::ScalableTag<float>()))) {
        points_row_scalar(row);
    } else if (row.ray_x == nullptr) {
        points_pixels<true>(row);
    } else {
        points_pixels<false>(row);
    }
}

}  // namespace
}  // namespace xtrack::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace xtrack {

HWY_EXPORT(points);

void points_row_highway(const PointsRow& row) noexcept { HWY_DYNAMIC_DISPATCH(points)(row); }

}  // namespace xtrack
#endif
