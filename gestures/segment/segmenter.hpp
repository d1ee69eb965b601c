// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include <xtrack/depth.hpp>
#include <xtrack/hand.hpp>
#include <xtrack/hand_region.hpp>
#include <xtrack/tracker_settings.hpp>

#include "gestures/segment/background.hpp"
#include "gestures/segment/grid.hpp"
#include "gestures/segment/hand_cut.hpp"
#include "gestures/segment/palm_search.hpp"
#include "gestures/segment/parts.hpp"

namespace xtrack::segment {

/// Depth image to hand regions. The whole image is looked at on a coarse grid, which finds palms;
/// hands are cut out round them on a fine one. All buffers are made by create().
class Segmenter {
 public:
    void create(const Rig& rig, Size size, const TrackerSettings& settings);
    void reset();

    /// @param elapsed_ms since the image before; 0 for the first
    /// @param priors where hands are expected, at most kMaxHands
    void segment(const DepthFrame& depth, std::int64_t elapsed_ms,
                 std::span<const PalmPrior> priors);

    [[nodiscard]] std::span<const HandRegion> regions() const noexcept {
        return {regions_.data(), static_cast<std::size_t>(count_)};
    }
    /// The fine grid, filled where the regions are.
    [[nodiscard]] const Grid& grid() const noexcept { return cut_.grid(); }
    /// Label of an index of grid() (padding counted).
    [[nodiscard]] std::span<const std::uint8_t> labels() const noexcept { return cut_.labels(); }
    [[nodiscard]] HandSegmentation view() const noexcept;

 private:
    void choose(const DepthFrame& depth, std::span<const PalmPrior> priors);
    [[nodiscard]] bool hidden_behind(const PalmCandidate& c) const;

    TrackerSettings settings_;
    Grid grid_;  ///< coarse
    Background background_;
    Parts parts_;
    PalmSearch search_;
    HandCut cut_;
    std::vector<float> foreground_;
    std::vector<std::uint8_t> limbs_;  ///< hands with their arms: protected from learning
    std::array<PalmCandidate, kCandidatesMax> scratch_;
    std::vector<PalmCandidate> candidates_;
    std::array<HandRegion, kMaxHands> regions_;
    int count_ = 0;
    float near_mm_ = 0.0F;
    float far_mm_ = 0.0F;
};

}  // namespace xtrack::segment
