// SPDX-License-Identifier: Apache-2.0
#include "core/decode/colour_cost.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/decode/colour_cost_highway.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "core/decode/arctangent_highway.hpp"
#include "core/decode/colour_cost_weights.hpp"

#include <numbers>

HWY_BEFORE_NAMESPACE();
namespace xtrack::HWY_NAMESPACE {
namespace {

using D = hn::ScalableTag<float>;
using V = hn::Vec<D>;

struct Seen {
    V contrast;
    V coordinate_px;
    hn::Mask<D> possible;
};

HWY_INLINE Seen see(const ColourModel::Inverse& inverse, const std::array<const float*, 3>& light,
                    const ColourPeriod& period, int at) {
    const D d;
    const V value[3] = {hn::LoadU(d, light[0] + at), hn::LoadU(d, light[1] + at),
                        hn::LoadU(d, light[2] + at)};
    V out[3];
    for (int row = 0; row < 3; ++row) {
        V sum = hn::Mul(hn::Set(d, inverse(row, 0)), value[0]);
        sum = hn::MulAdd(hn::Set(d, inverse(row, 1)), value[1], sum);
        out[row] = hn::MulAdd(hn::Set(d, inverse(row, 2)), value[2], sum);
    }
    constexpr float kTurn = 2.0F * std::numbers::pi_v<float>;
    const V power = hn::MulAdd(out[1], out[1], hn::Mul(out[2], out[2]));
    const V contrast = hn::Div(hn::Sqrt(power), out[0]);
    const V angle = arctangent2(d, out[2], out[1]);
    const V from = hn::Sub(angle, hn::Set(d, static_cast<float>(period.phase_rad)));
    const V x = hn::Mul(from, hn::Set(d, static_cast<float>(period.period_px) / kTurn));
    const auto possible = hn::And(hn::Gt(out[0], hn::Zero(d)),
                                  hn::Le(contrast, hn::Set(d, colour_cost_weights::kMostContrast)));
    return {contrast, x, possible};
}

HWY_INLINE V nearest_whole(V value) { return hn::Floor(hn::Add(value, hn::Set(D(), 0.5F))); }

// The lines follow colour_cost_scalar().
void measure(const ColourCost& row) {
    const D d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    if (row.count < lanes) {
        colour_cost_scalar(row);
        return;
    }
    const V fine_period = hn::Set(d, static_cast<float>(row.fine.period_px));
    const V coarse_period = hn::Set(d, static_cast<float>(row.coarse.period_px));
    const V most = hn::Set(d, kMostColourCost);
    for (int i = 0; i < row.count; i += lanes) {
        // The last vector overlaps the one before it instead of running over the end.
        const int at = i + lanes <= row.count ? i : row.count - lanes;
        const Seen fine = see(row.inverse, row.samples.fine, row.fine, at);
        auto possible = fine.possible;
        V contrast = hn::Set(d, row.contrast);
        V reference = hn::LoadU(d, row.samples.reference_px + at);
        if (row.has_coarse) {
            const Seen coarse = see(row.inverse, row.samples.coarse, row.coarse, at);
            contrast = coarse.contrast;
            possible = hn::And(possible, coarse.possible);
            const V x = coarse.coordinate_px;
            const V turns = nearest_whole(hn::Div(hn::Sub(reference, x), coarse_period));
            const V unwrapped = hn::MulAdd(coarse_period, turns, x);
            reference = hn::IfThenElse(hn::Eq(reference, reference), unwrapped, x);
        }
        V apart = hn::Div(hn::Sub(fine.coordinate_px, reference), fine_period);
        apart = hn::Sub(apart, nearest_whole(apart));
        apart = hn::IfThenElseZero(hn::Eq(reference, reference), apart);
        const V between = hn::Sub(fine.contrast, contrast);
        const V apart_cost =
            hn::Mul(hn::Set(d, colour_cost_weights::kApart), hn::Mul(apart, apart));
        const V cost = hn::MulAdd(hn::Set(d, colour_cost_weights::kContrast),
                                  hn::Mul(between, between), apart_cost);
        hn::StoreU(hn::IfThenElse(possible, hn::Min(cost, most), most), d, row.cost + at);
    }
}

}  // namespace
}  // namespace xtrack::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace xtrack {

HWY_EXPORT(measure);

void colour_cost_highway(const ColourCost& row) noexcept { HWY_DYNAMIC_DISPATCH(measure)(row); }

}  // namespace xtrack
#endif
