// SPDX-License-Identifier: Apache-2.0
#include <xtrack/decode_settings.hpp>

#include <string>

namespace xtrack {
namespace {

Result<void> in_range(const char* name, double value, double low, double high) {
    if (value >= low && value <= high) {  // false for NaN
        return {};
    }
    return Error{ErrorCode::invalid_argument,
                 std::string("decode settings: ") + name + " is " + std::to_string(value) +
                     ", must be " + std::to_string(low) + " ... " + std::to_string(high)};
}

}  // namespace

Result<void> validate(const DecodeSettings& settings) {
    const Result<void> checks[] = {
        in_range("min_modulation", settings.min_modulation, 0.0, 127.0),
        in_range("order_tolerance", settings.order_tolerance, 0.05, 0.5),
        in_range("gray_edge_guard", settings.gray_edge_guard, 0.0, 0.45),
        in_range("motion_tolerance", settings.motion_tolerance, 0.05, 10.0),
        in_range("max_motion_px", settings.max_motion_px, 8.0, 400.0),
    };
    for (const Result<void>& check : checks) {
        if (!check) {
            return check;
        }
    }
    return {};
}

}  // namespace xtrack
