// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <compare>
#include <cstdint>

namespace xtrack {

/// A length of time. Nanoseconds; `std::chrono` converts.
using Duration = std::chrono::nanoseconds;

/// A moment on CLOCK_MONOTONIC (or on a recording's own clock), in nanoseconds. The stamp of an
/// image is the middle of its exposure. Stages are handed stamps and never read a clock.
/// @since 0.1
struct Stamp {
    std::int64_t ns = 0;

    [[nodiscard]] static constexpr Stamp from_us(std::int64_t us) noexcept { return {us * 1000}; }
    /// Whole microseconds, rounded to the nearest.
    [[nodiscard]] constexpr std::int64_t us() const noexcept {
        return (ns >= 0 ? ns + 500 : ns - 500) / 1000;
    }

    friend constexpr auto operator<=>(const Stamp&, const Stamp&) = default;
    friend constexpr Duration operator-(Stamp a, Stamp b) noexcept { return Duration{a.ns - b.ns}; }
    friend constexpr Stamp operator+(Stamp a, Duration d) noexcept { return {a.ns + d.count()}; }
    friend constexpr Stamp operator-(Stamp a, Duration d) noexcept { return {a.ns - d.count()}; }
};

/// Seconds as a double, for filters and fits.
/// @thread any
/// @since 0.1
[[nodiscard]] constexpr double to_seconds(Duration d) noexcept {
    return static_cast<double>(d.count()) * 1e-9;
}

}  // namespace xtrack
