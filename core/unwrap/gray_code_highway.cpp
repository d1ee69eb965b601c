// SPDX-License-Identifier: Apache-2.0
#include "core/unwrap/gray_code.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/unwrap/gray_code_highway.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <limits>

HWY_BEFORE_NAMESPACE();
namespace xtrack::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::ScalableTag<std::int32_t>;
using V = hn::Vec<D>;

HWY_INLINE V load(const std::uint8_t* pixels) {
    const D d;
    return hn::PromoteTo(d, hn::LoadU(hn::Rebind<std::uint8_t, D>(), pixels));
}

HWY_INLINE V cell_of(V code) {
    code = hn::Xor(code, hn::ShiftRight<1>(code));
    code = hn::Xor(code, hn::ShiftRight<2>(code));
    code = hn::Xor(code, hn::ShiftRight<4>(code));
    return hn::Xor(code, hn::ShiftRight<8>(code));
}

// The lines follow gray_code_row_scalar(), which says why.
void gray_code(const GrayRow& row) {
    const D d;
    const hn::RebindToFloat<D> df;
    const int lanes = static_cast<int>(hn::Lanes(d));
    if (row.count < lanes) {
        gray_code_row_scalar(row);
        return;
    }
    const bool flats = row.white != nullptr && row.black != nullptr;
    const auto cell = hn::Set(df, static_cast<float>(row.cell_px));
    const auto origin = hn::Set(df, static_cast<float>(-0.5 - row.offset_px));
    const auto half = hn::Set(df, 0.5F);
    const auto one = hn::Set(d, 1);
    for (int i = 0; i < row.count; i += lanes) {
        // The last vector overlaps the one before it instead of running over the end.
        const int at = i + lanes <= row.count ? i : row.count - lanes;
        V span = hn::Zero(d);
        V middle = hn::Zero(d);
        V amplitude2 = hn::Set(d, std::numeric_limits<std::int32_t>::max());
        if (flats) {
            const V white = load(row.white + at);
            const V black = load(row.black + at);
            amplitude2 = hn::Sub(white, black);
            span = hn::Add(amplitude2, amplitude2);
            middle = hn::Add(white, black);
        }
        V code = hn::Zero(d);
        V brightest = hn::Zero(d);
        V least_bit = hn::Zero(d);
        auto least_certain = hn::Set(df, std::numeric_limits<float>::infinity());
        for (int b = 0; b < row.bits; ++b) {
            const auto n = static_cast<std::size_t>(b);
            const V value = load(row.image[n] + at);
            const bool inverted = row.inverse[n] != nullptr;
            const V twice = hn::Add(value, value);
            V reference = middle;
            if (inverted) {
                const V inverse = load(row.inverse[n] + at);
                reference = hn::Add(inverse, inverse);
            }
            const V difference = hn::Sub(twice, reference);
            const V mask = hn::Set(d, 1 << (row.bits - 1 - b));
            code = hn::Or(code, hn::IfThenElseZero(hn::Gt(difference, hn::Zero(d)), mask));
            brightest = hn::Max(brightest, value);
            const V swing = hn::Abs(difference);
            if (!flats) {
                amplitude2 = hn::Min(amplitude2, hn::ShiftRight<1>(swing));
            }
            const auto certainty =
                hn::Mul(hn::ConvertTo(df, swing), hn::Set(df, inverted ? 0.5F : 1.0F));
            const auto less = hn::Lt(certainty, least_certain);
            least_certain = hn::Min(certainty, least_certain);
            least_bit = hn::IfThenElse(hn::RebindMask(d, less), mask, least_bit);
        }
        const auto modulation = hn::Mul(half, hn::ConvertTo(df, amplitude2));
        const V c = cell_of(code);
        auto position = hn::Add(hn::ConvertTo(df, c), half);
        auto good =
            hn::And(hn::Ge(modulation, hn::Set(df, row.min_modulation)),
                    hn::RebindMask(df, hn::Lt(brightest, hn::Set(d, row.saturation_limit))));
        if (flats) {
            const auto uncertain = hn::Lt(
                least_certain, hn::Mul(hn::Set(df, row.edge_guard), hn::ConvertTo(df, span)));
            const V other = cell_of(hn::Xor(code, least_bit));
            const auto beside = hn::RebindMask(df, hn::Eq(hn::Abs(hn::Sub(other, c)), one));
            if (!row.centre_only) {
                position = hn::IfThenElse(hn::And(uncertain, beside),
                                          hn::ConvertTo(df, hn::Max(c, other)), position);
            }
            good = hn::And(good, hn::Or(beside, hn::Not(uncertain)));
        }
        const auto x = hn::MulAdd(position, cell, origin);
        const auto none = hn::Set(df, std::numeric_limits<float>::quiet_NaN());
        hn::StoreU(hn::IfThenElse(good, x, none), df, row.coordinate_px + at);
        hn::StoreU(hn::IfThenElseZero(good, modulation), df, row.modulation + at);
    }
}

}  // namespace
}  // namespace xtrack::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace xtrack {

HWY_EXPORT(gray_code);

void gray_code_row_highway(const GrayRow& row) noexcept { HWY_DYNAMIC_DISPATCH(gray_code)(row); }

}  // namespace xtrack
#endif
