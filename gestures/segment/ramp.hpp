// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

namespace xtrack {

/// 0 up to `from`, 1 from `to` on, and in proportion between them.
[[nodiscard]] inline float ramp(float value, float from, float to) noexcept {
    return std::clamp((value - from) / (to - from), 0.0F, 1.0F);
}

}  // namespace xtrack
