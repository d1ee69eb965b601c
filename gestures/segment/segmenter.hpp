// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include <xtrack/hand.hpp>
#include <xtrack/hand_region.hpp>
#include <xtrack/tracker_settings.hpp>

#include "gestures/segment/background.hpp"
#include "gestures/segment/grid.hpp"
#include "gestures/segment/palm_search.hpp"
#include "gestures/segment/parts.hpp"

namespace xtrack::segment {

/// Depth image to hand regions. All buffers are made by create().
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
    [[nodiscard]] const Grid& grid() const noexcept { return grid_; }
    /// Label of a grid index (padding counted).
    [[nodiscard]] std::span<const std::uint8_t> labels() const noexcept { return labels_; }
    [[nodiscard]] HandSegmentation view() const noexcept;
    [[nodiscard]] const Parts& parts() const noexcept { return parts_; }

 private:
    void choose(std::span<const PalmPrior> priors);
    void paint(const PalmCandidate& c, HandRegion& region);
    void centre_palm(HandRegion& region);
    [[nodiscard]] bool hidden_behind(const PalmCandidate& c) const;

    TrackerSettings settings_;
    Grid grid_;
    Background background_;
    Parts parts_;
    std::vector<float> foreground_;
    std::vector<std::uint8_t> labels_;  ///< hands
    std::vector<std::uint8_t> limbs_;   ///< hands with their arms: protected from learning
    std::vector<int> stack_;
    struct RidgePoint {
        int x = 0, y = 0;
        float radius_px = 0.0F;
    };
    std::vector<RidgePoint> ridge_;       ///< places where the palm's centre may be
    std::vector<int> rim_x_, rim_y_;      ///< outermost pixels of the hand
    std::vector<std::int32_t> distance_;  ///< to the rim of the hand
    std::array<PalmCandidate, kCandidatesMax> scratch_;
    std::vector<PalmCandidate> candidates_;
    std::array<HandRegion, kMaxHands> regions_;
    int count_ = 0;
    float near_mm_ = 0.0F;
    float far_mm_ = 0.0F;
};

}  // namespace xtrack::segment
