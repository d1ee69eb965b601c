// SPDX-License-Identifier: Apache-2.0
#include "core/decode/decode_row.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/decode/decode_row_highway.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "core/decode/arctangent_highway.hpp"

#include <limits>

HWY_BEFORE_NAMESPACE();
namespace xtrack::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::ScalableTag<float>;
using V = hn::Vec<D>;

// kTaps > 0 fixes the number of images at compile time, which keeps the coefficients in registers.
template <int kTaps>
void decode_pixels(const DecodeRow& shared) {
    const D d;
    // A copy, as what is stored could be part of `shared` for all that the compiler knows.
    const DecodeRow row = shared;
    const hn::Rebind<std::uint8_t, D> d8;
    const hn::RebindToSigned<D> di;
    const int lanes = static_cast<int>(hn::Lanes(d));
    const auto taps = static_cast<std::size_t>(kTaps > 0 ? kTaps : row.taps);
    const V least_power = hn::Set(d, row.min_modulation * row.min_modulation);
    const V limit = hn::Set(d, static_cast<float>(row.saturation_limit));
    const V nan = hn::Set(d, std::numeric_limits<float>::quiet_NaN());
    for (int i = 0; i < row.count; i += lanes) {
        // The last vector overlaps the one before it instead of running over the end.
        const int at = i + lanes <= row.count ? i : row.count - lanes;
        V re = hn::Zero(d);
        V im = hn::Zero(d);
        V brightest = hn::Zero(d);
        for (std::size_t n = 0; n < taps; ++n) {
            const V value = hn::ConvertTo(d, hn::PromoteTo(di, hn::LoadU(d8, row.source[n] + at)));
            brightest = hn::Max(brightest, value);
            re = hn::MulAdd(hn::Set(d, row.re[n]), value, re);
            im = hn::MulAdd(hn::Set(d, row.im[n]), value, im);
        }
        const V power = hn::MulAdd(re, re, hn::Mul(im, im));
        const auto good = hn::And(hn::Ge(power, least_power), hn::Lt(brightest, limit));
        hn::StoreU(hn::IfThenElse(good, arctangent2(d, im, re), nan), d, row.phase_rad + at);
        hn::StoreU(hn::IfThenElseZero(good, hn::Sqrt(power)), d, row.modulation + at);
    }
}

void decode(const DecodeRow& row) {
    if (row.count < static_cast<int>(hn::Lanes(D()))) {
        decode_row_scalar(row);
        return;
    }
    if (row.taps == 3) {
        decode_pixels<3>(row);
    } else if (row.taps == 5) {
        decode_pixels<5>(row);
    } else {
        decode_pixels<0>(row);
    }
}

}  // namespace
}  // namespace xtrack::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace xtrack {

HWY_EXPORT(decode);

void decode_row_highway(const DecodeRow& row) noexcept { HWY_DYNAMIC_DISPATCH(decode)(row); }

}  // namespace xtrack
#endif
