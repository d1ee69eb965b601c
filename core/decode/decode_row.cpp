// SPDX-License-Identifier: Apache-2.0
#include "core/decode/decode_row.hpp"

#if XTRACK_WITH_HIGHWAY
#include <hwy/highway.h>
#endif

namespace xtrack {

#if XTRACK_WITH_HIGHWAY

void decode_row(const DecodeRow& row) noexcept { decode_row_highway(row); }

const char* decode_instruction_set() noexcept {
    // The lowest set bit is the best target this CPU supports.
    const auto supported = hwy::SupportedTargets() & HWY_TARGETS;  // and is compiled
    return hwy::TargetName(supported & -supported);
}

#else

void decode_row(const DecodeRow& row) noexcept { decode_row_scalar(row); }
const char* decode_instruction_set() noexcept { return "scalar"; }

#endif

}  // namespace xtrack
