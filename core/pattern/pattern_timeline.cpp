// SPDX-License-Identifier: Apache-2.0
#include <xtrack/pattern_timeline.hpp>

#include <cstddef>
#include <cstdint>

namespace xtrack {

namespace {

/// Walks the shows as rows move on in time, so a frame costs rows + shows steps.
class ShowWalk {
 public:
    explicit ShowWalk(std::span<const PatternShow> shows) noexcept : shows_(shows) {}

    /// The pattern that is shown during the whole of [begin, end), or unknown. `begin` must not
    /// decrease from call to call.
    [[nodiscard]] int pattern_during(Stamp begin, Stamp end) noexcept {
        while (next_ < shows_.size() && shows_[next_].start <= begin) {
            ++next_;
        }
        if (next_ == 0) {
            return kUnknownPattern;
        }
        const int pattern = shows_[next_ - 1].pattern;
        for (std::size_t i = next_; i < shows_.size() && shows_[i].start < end; ++i) {
            if (shows_[i].pattern != pattern) {
                return kUnknownPattern;
            }
        }
        return pattern;
    }

 private:
    std::span<const PatternShow> shows_;
    std::size_t next_ = 0;  // the first show that begins after the row
};

}  // namespace

PatternAssignment assign_pattern(std::span<const PatternShow> shows,
                                 const FrameTiming& timing) noexcept {
    PatternAssignment best;
    if (timing.rows <= 0 || timing.exposure < Duration::zero() ||
        timing.readout < Duration::zero()) {
        return best;
    }
    const std::int64_t rows = timing.rows;
    ShowWalk walk(shows);
    PatternAssignment run;
    for (int row = 0; row < timing.rows; ++row) {
        const Duration from_middle{(2 * static_cast<std::int64_t>(row) + 1 - rows) *
                                   timing.readout.count() / (2 * rows)};
        const Stamp begin = timing.stamp + from_middle - timing.exposure / 2;
        const int pattern = walk.pattern_during(begin, begin + timing.exposure);
        if (pattern != run.pattern) {
            run = {pattern, row, row};
        }
        run.clean_row_end = row + 1;
        const int longest = best.clean_row_end - best.clean_row_begin;
        if (run.pattern != kUnknownPattern && run.clean_row_end - run.clean_row_begin > longest) {
            best = run;
        }
    }
    return best;
}

}  // namespace xtrack
