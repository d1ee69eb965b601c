// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <xtrack/stamp.hpp>

namespace xtrack {

/// Quantiles of many durations in constant memory: bins whose widths grow by 2 %, 0.1 us to 100 s.
class TimeHistogram {
 public:
    void add(Duration d) noexcept {
        const double us = static_cast<double>(d.count()) * 1e-3;
        ++bins_[bin_of(us)];
        ++count_;
        max_us_ = std::max(max_us_, us);
    }

    [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
    [[nodiscard]] double max_us() const noexcept { return max_us_; }

    /// The duration below which a share `q` (0..1) of them lies; 0 if there are none.
    [[nodiscard]] double quantile_us(double q) const noexcept {
        if (count_ == 0) {
            return 0.0;
        }
        const auto wanted = static_cast<std::uint64_t>(std::ceil(q * static_cast<double>(count_)));
        std::uint64_t seen = 0;
        for (std::size_t i = 0; i < kBins; ++i) {
            seen += bins_[i];
            if (seen >= wanted) {
                return std::min(kLowestUs * std::pow(kGrowth, static_cast<double>(i)), max_us_);
            }
        }
        return max_us_;
    }

 private:
    static constexpr std::size_t kBins = 1050;  // kLowestUs * kGrowth^1050 > 100 s
    static constexpr double kLowestUs = 0.1;
    static constexpr double kGrowth = 1.02;

    static std::size_t bin_of(double us) noexcept {
        if (us <= kLowestUs) {
            return 0;
        }
        const double i = std::ceil(std::log(us / kLowestUs) / std::log(kGrowth));
        return std::min(static_cast<std::size_t>(i), kBins - 1);
    }

    std::array<std::uint64_t, kBins> bins_{};
    std::uint64_t count_ = 0;
    double max_us_ = 0.0;
};

}  // namespace xtrack
