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

// Vectors of SVE have no size that a compiler knows: none in arrays or structs.
HWY_INLINE V see(const ColourModel::Inverse& inverse, int row, V red, V green, V blue) {
    const D d;
    const V part =
        hn::MulAdd(hn::Set(d, inverse(row, 1)), green, hn::Mul(hn::Set(d, inverse(row, 0)), red));
    return hn::MulAdd(hn::Set(d, inverse(row, 2)), blue, part);
}

/// @return the light; contrast and the coordinate within one period by the way
HWY_INLINE V see(const ColourModel::Inverse& inverse, const std::array<const float*, 3>& light,
                 const ColourPeriod& period, int at, V& contrast, V& coordinate_px) {
    const D d;
    const V red = hn::LoadU(d, light[0] + at);
    const V green = hn::LoadU(d, light[1] + at);
    const V blue = hn::LoadU(d, light[2] + at);
    const V whole = see(inverse, 0, red, green, blue);
    const V re = see(inverse, 1, red, green, blue);
    const V im = see(inverse, 2, red, green, blue);
    constexpr float kTurn = 2.0F * std::numbers::pi_v<float>;
    const V power = hn::MulAdd(re, re, hn::Mul(im, im));
    contrast = hn::Div(hn::Sqrt(power), whole);
    const V angle = arctangent2(d, im, re);
    const V from = hn::Sub(angle, hn::Set(d, static_cast<float>(period.phase_rad)));
    coordinate_px = hn::Mul(from, hn::Set(d, static_cast<float>(period.period_px) / kTurn));
    return whole;
}

HWY_INLINE hn::Mask<D> possible_at(V light, V contrast) {
    const D d;
    return hn::And(hn::Gt(light, hn::Zero(d)),
                   hn::Le(contrast, hn::Set(d, colour_cost_weights::kMostContrast)));
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
    const float transfer = row.has_coarse ? row.transfer : 1.0F;
    const V same_noise = hn::Set(d, colour_cost_weights::equal_noise(transfer));
    for (int i = 0; i < row.count; i += lanes) {
        // The last vector overlaps the one before it instead of running over the end.
        const int at = i + lanes <= row.count ? i : row.count - lanes;
        V fine_contrast = hn::Zero(d);
        V fine_px = hn::Zero(d);
        const V fine_light =
            see(row.inverse, row.samples.fine, row.fine, at, fine_contrast, fine_px);
        auto possible = possible_at(fine_light, fine_contrast);
        V contrast = hn::Set(d, row.contrast);
        V reference = hn::LoadU(d, row.samples.reference_px + at);
        if (row.has_coarse) {
            V x = hn::Zero(d);
            const V light =
                see(row.coarse_inverse, row.samples.coarse, row.coarse, at, contrast, x);
            possible = hn::And(possible, possible_at(light, contrast));
            const V turns = nearest_whole(hn::Div(hn::Sub(reference, x), coarse_period));
            const V unwrapped = hn::MulAdd(coarse_period, turns, x);
            reference = hn::IfThenElse(hn::Eq(reference, reference), unwrapped, x);
            contrast = hn::Mul(contrast, hn::Set(d, transfer));
        }
        V apart = hn::Div(hn::Sub(fine_px, reference), fine_period);
        apart = hn::Sub(apart, nearest_whole(apart));
        apart = hn::IfThenElseZero(hn::Eq(reference, reference), apart);
        if (row.fine_contrast != nullptr) {
            hn::StoreU(fine_contrast, d, row.fine_contrast + at);
        }
        const V between = hn::Mul(hn::Sub(fine_contrast, contrast), same_noise);
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
