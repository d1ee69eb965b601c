// SPDX-License-Identifier: Apache-2.0
#include "core/unwrap/unwrap_row.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/unwrap/unwrap_row_highway.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <numbers>

HWY_BEFORE_NAMESPACE();
namespace xtrack::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

void unwrap(const UnwrapRow& row) {
    const hn::ScalableTag<float> d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    if (row.count < lanes) {
        unwrap_row_scalar(row);
        return;
    }
    const auto period = hn::Set(d, static_cast<float>(row.period_px));
    const auto px_per_rad =
        hn::Set(d, static_cast<float>(row.period_px / (2.0 * std::numbers::pi)));
    const auto per_period = hn::Set(d, 1.0F / static_cast<float>(row.period_px));
    const auto limit = hn::Set(d, row.tolerance * static_cast<float>(row.period_px));
    const auto lowest = hn::Set(d, row.coordinate_min_px);
    const auto highest = hn::Set(d, row.coordinate_max_px);
    const auto nan = hn::Set(d, std::numeric_limits<float>::quiet_NaN());
    for (int i = 0; i < row.count; i += lanes) {
        // The last vector overlaps the one before it instead of running over the end.
        const int at = i + lanes <= row.count ? i : row.count - lanes;
        const auto reference = hn::LoadU(d, row.reference_px + at);
        const auto within = hn::Mul(hn::LoadU(d, row.phase_rad + at), px_per_rad);
        const auto order = hn::Round(hn::Mul(hn::Sub(reference, within), per_period));
        const auto x = hn::MulAdd(order, period, within);
        // Comparisons with NaN are false, which carries the mask of either input along.
        const auto near = hn::Le(hn::Abs(hn::Sub(x, reference)), limit);
        const auto inside = hn::And(hn::Ge(x, lowest), hn::Le(x, highest));
        hn::StoreU(hn::IfThenElse(hn::And(near, inside), x, nan), d, row.coordinate_px + at);
    }
}

}  // namespace
}  // namespace xtrack::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace xtrack {

HWY_EXPORT(unwrap);

void unwrap_row_highway(const UnwrapRow& row) noexcept { HWY_DYNAMIC_DISPATCH(unwrap)(row); }

}  // namespace xtrack
#endif
