// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace xtrack::sim {

/// A number from a counter and a key: no state, so any frame can be made without those before it.
/// The mixer is the finaliser of SplitMix64 (Steele, Lea, Flood 2014).
[[nodiscard]] constexpr std::uint64_t mix(std::uint64_t x) noexcept {
    x += 0x9E3779B97F4A7C15ULL;
    x = (x ^ (x >> 30U)) * 0xBF58476D1CE4E5B9ULL;
    x = (x ^ (x >> 27U)) * 0x94D049BB133111EBULL;
    return x ^ (x >> 31U);
}

[[nodiscard]] constexpr std::uint64_t mix(std::uint64_t key, std::uint64_t counter) noexcept {
    return mix(mix(key) ^ (counter * 0xD1342543DE82EF95ULL));
}

/// A stream of numbers for set-up code.
class Random {
 public:
    explicit constexpr Random(std::uint64_t seed) noexcept : key_(mix(seed)) {}

    [[nodiscard]] constexpr std::uint64_t bits() noexcept { return mix(key_, counter_++); }
    /// [0, 1)
    [[nodiscard]] constexpr double unit() noexcept {
        return static_cast<double>(bits() >> 11U) * 0x1.0p-53;
    }
    [[nodiscard]] constexpr double between(double low, double high) noexcept {
        return low + (high - low) * unit();
    }

 private:
    std::uint64_t key_;
    std::uint64_t counter_ = 0;
};

}  // namespace xtrack::sim
