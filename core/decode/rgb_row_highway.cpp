// SPDX-License-Identifier: Apache-2.0
#include "core/decode/rgb_row.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/decode/rgb_row_highway.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "core/decode/arctangent_highway.hpp"

#include <limits>

HWY_BEFORE_NAMESPACE();
namespace xtrack::HWY_NAMESPACE {
namespace {

using D = hn::ScalableTag<float>;
using V = hn::Vec<D>;
using D8 = hn::Rebind<std::uint8_t, D>;
using V8 = hn::Vec<D8>;

HWY_INLINE V widened(V8 bytes) {
    return hn::ConvertTo(D(), hn::PromoteTo(hn::RebindToSigned<D>(), bytes));
}

// The lines follow rgb_row_scalar().
void decode(const RgbRow& row) {
    const D d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    if (row.count < lanes) {
        rgb_row_scalar(row);
        return;
    }
    const V least_power = hn::Set(d, row.min_modulation * row.min_modulation);
    const V limit = hn::Set(d, static_cast<float>(row.saturation_limit));
    const V nan = hn::Set(d, std::numeric_limits<float>::quiet_NaN());
    for (int i = 0; i < row.count; i += lanes) {
        // The last vector overlaps the one before it instead of running over the end.
        const int at = i + lanes <= row.count ? i : row.count - lanes;
        V re = hn::Zero(d);
        V im = hn::Zero(d);
        V brightest = hn::Zero(d);
        for (std::size_t n = 0; n < row.frames; ++n) {
            V8 blue;
            V8 green;
            V8 red;
            hn::LoadInterleaved3(D8(), row.bgr[n] + 3 * static_cast<std::ptrdiff_t>(at), blue,
                                 green, red);
            // No array of vectors: those of SVE have no size that a compiler knows.
            const V b = widened(blue);
            const V g = widened(green);
            const V r = widened(red);
            brightest = hn::Max(hn::Max(brightest, b), hn::Max(g, r));
            const auto sum = [&](const std::array<const float*, 3>& taps) {
                const V part = hn::MulAdd(hn::LoadU(d, taps[1] + at), g,
                                          hn::Mul(hn::LoadU(d, taps[0] + at), b));
                return hn::MulAdd(hn::LoadU(d, taps[2] + at), r, part);
            };
            const V frame_re = sum(row.re);
            const V frame_im = sum(row.im);
            const V turn_re = hn::Set(d, row.turn[n].real());
            const V turn_im = hn::Set(d, row.turn[n].imag());
            re = hn::NegMulAdd(turn_im, frame_im, hn::MulAdd(turn_re, frame_re, re));
            im = hn::MulAdd(turn_im, frame_re, hn::MulAdd(turn_re, frame_im, im));
        }
        const V power = hn::MulAdd(re, re, hn::Mul(im, im));
        const auto good = hn::And(hn::Ge(power, least_power), hn::Lt(brightest, limit));
        hn::StoreU(hn::IfThenElse(good, arctangent2(d, im, re), nan), d, row.phase_rad + at);
        hn::StoreU(hn::IfThenElseZero(good, hn::Sqrt(power)), d, row.modulation + at);
    }
}

}  // namespace
}  // namespace xtrack::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace xtrack {

HWY_EXPORT(decode);

void rgb_row_highway(const RgbRow& row) noexcept { HWY_DYNAMIC_DISPATCH(decode)(row); }

}  // namespace xtrack
#endif
