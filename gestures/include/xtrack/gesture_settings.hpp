// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <xtrack/result.hpp>

namespace xtrack {

/// Every threshold of the recognisers, each with its unit in its name and its source beside it.
/// @since 0.1
struct GestureSettings {
    bool swipe = true;
    bool push = true;
    bool pinch = true;
};

}  // namespace xtrack
