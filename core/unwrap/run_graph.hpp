// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <xtrack/geometry.hpp>

#include "core/unwrap/order_forest.hpp"
#include "core/unwrap/region_links.hpp"
#include "core/unwrap/step_maps.hpp"

namespace xtrack {

/// Pixels first ... last of a 64-pixel word of a row, joined by sound steps. Its order is that of
/// its first pixel.
struct Run {
    std::uint8_t first = 0;
    std::uint8_t last = 0;

    [[nodiscard]] int pixels() const noexcept { return last - first + 1; }
    [[nodiscard]] StepMaps::Word mask() const noexcept {
        return (~StepMaps::Word{0} >> (64U - static_cast<unsigned>(pixels()))) << first;
    }
};

/// The runs of an image, joined into regions. Short as they are, a run that crosses a depth step
/// by mistake does little harm, and what it says is outvoted by the rows above and below.
class RunGraph {
 public:
    /// Runs begin ... end - 1.
    struct Range {
        std::uint32_t begin = 0;
        std::uint32_t end = 0;
    };

    explicit RunGraph(Size size);

    /// @param support see RegionLinks::join_all()
    void build(const StepMaps& maps, double support);

    [[nodiscard]] std::uint32_t size() const noexcept { return forest_.size(); }
    [[nodiscard]] Run run(std::uint32_t index) const noexcept { return runs_[index]; }
    [[nodiscard]] Range runs_of(int word, int y) const noexcept {
        const std::size_t i = cell(word, y);
        return {first_run_[i], first_run_[i + 1]};
    }
    [[nodiscard]] OrderForest& forest() noexcept { return forest_; }

 private:
    /// Column of words after column of words, so that a run is made soon after those it touches.
    [[nodiscard]] std::size_t cell(int word, int y) const noexcept {
        return static_cast<std::size_t>(word) * static_cast<std::size_t>(size_.height) +
               static_cast<std::size_t>(y);
    }
    void add_runs(const StepMaps& maps, int word, int y);
    void link_right(const StepMaps& maps, std::uint32_t a, std::uint32_t b, std::size_t at);
    void link_along(const StepMaps& maps, int word, int y);
    void link_down(const StepMaps& maps, int word, int y);
    void link_contact(const StepMaps& maps, std::uint32_t upper, std::uint32_t lower,
                      std::size_t at, bool clear);

    Size size_;
    std::vector<Run> runs_;
    std::vector<std::uint32_t> first_run_;  ///< by cell, and one more for the end
    OrderForest forest_;
    RegionLinks links_;
};

}  // namespace xtrack
