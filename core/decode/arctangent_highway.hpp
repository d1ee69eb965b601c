// SPDX-License-Identifier: Apache-2.0
// Included once for each instruction set: the guard is Highway's, not #pragma once.
#if defined(XTRACK_CORE_DECODE_ARCTANGENT_HIGHWAY) == defined(HWY_TARGET_TOGGLE)
#ifdef XTRACK_CORE_DECODE_ARCTANGENT_HIGHWAY
#undef XTRACK_CORE_DECODE_ARCTANGENT_HIGHWAY
#else
#define XTRACK_CORE_DECODE_ARCTANGENT_HIGHWAY
#endif

#include <cstddef>
#include <limits>
#include <numbers>

#include <hwy/highway.h>

#include "core/decode/arctangent.hpp"

HWY_BEFORE_NAMESPACE();
namespace xtrack::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// arctangent2() of arctangent.hpp, a vector at a time.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V arctangent2(D d, V y, V x) {
    const V ax = hn::Abs(x);
    const V ay = hn::Abs(y);
    // A tiny divisor keeps 0 / 0 from becoming NaN: black pixels have phase 0 before the mask.
    const V larger = hn::Max(hn::Max(ax, ay), hn::Set(d, std::numeric_limits<float>::min()));
    const V t = hn::Div(hn::Min(ax, ay), larger);
    const V t2 = hn::Mul(t, t);
    V p = hn::Set(d, kArctangent[5]);
    for (std::size_t k = 5; k-- > 0;) {
        p = hn::MulAdd(p, t2, hn::Set(d, kArctangent[k]));
    }
    V angle = hn::Mul(p, t);
    angle = hn::IfThenElse(hn::Gt(ay, ax),
                           hn::Sub(hn::Set(d, std::numbers::pi_v<float> / 2.0F), angle), angle);
    angle = hn::IfThenElse(hn::Lt(x, hn::Zero(d)),
                           hn::Sub(hn::Set(d, std::numbers::pi_v<float>), angle), angle);
    // The angle has no sign yet.
    return hn::Or(angle, hn::And(y, hn::SignBit(d)));
}

}  // namespace xtrack::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
