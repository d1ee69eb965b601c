// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <xtrack/pattern_timeline.hpp>
#include <xtrack/sim.hpp>

namespace xtrack::sim {

/// How much of an exposure belongs to which pattern.
struct PatternShare {
    std::size_t pattern = 0;
    float weight = 0.0F;
};
inline constexpr std::size_t kMaxShares = 4;
struct PatternMix {
    std::array<PatternShare, kMaxShares> shares{};
    std::size_t count = 0;
    friend bool operator==(const PatternMix& a, const PatternMix& b) noexcept {
        if (a.count != b.count) {
            return false;
        }
        for (std::size_t i = 0; i < a.count; ++i) {
            if (a.shares[i].pattern != b.shares[i].pattern ||
                a.shares[i].weight != b.shares[i].weight) {
                return false;
            }
        }
        return true;
    }
};

/// When the camera's rows are open and what the projector shows then.
class Timing {
 public:
    explicit Timing(const SimSettings& settings);

    [[nodiscard]] Stamp stamp(std::uint64_t frame) const;
    /// Seconds from the frame's stamp to the middle of a row's exposure; `row` may lie between
    /// rows.
    [[nodiscard]] double row_offset_s(double row) const {
        return (row + 0.5 - 0.5 * rows_) / rows_ * readout_s_;
    }
    /// What is shown during [begin, end), s of simulated time.
    [[nodiscard]] PatternMix shown(double begin_s, double end_s) const;
    /// What a driver that knows the show times and its latency would say of the frame.
    [[nodiscard]] PatternAssignment assign(std::uint64_t frame) const;

    [[nodiscard]] double exposure_s() const noexcept { return exposure_s_; }
    [[nodiscard]] double readout_s() const noexcept { return readout_s_; }

 private:
    [[nodiscard]] std::int64_t show_at(double t_s) const;
    [[nodiscard]] double show_start_s(std::int64_t show) const;
    [[nodiscard]] std::size_t pattern_of(std::int64_t show) const;

    std::int64_t patterns_;
    int rows_;
    double frame_s_;
    double exposure_s_;
    double readout_s_;
    double first_stamp_s_;
    double first_show_s_;
    double show_s_;
    double latency_error_s_;
    double guard_s_;
};

}  // namespace xtrack::sim
