// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <xtrack/hand.hpp>
#include <xtrack/hand_region.hpp>
#include <xtrack/tracker_settings.hpp>

#include "gestures/segment/chamfer.hpp"
#include "gestures/segment/components.hpp"
#include "gestures/segment/grid.hpp"
#include "gestures/segment/palm_search.hpp"
#include "gestures/segment/parts.hpp"

namespace xtrack::segment {

/// The image as the coarse grid shows it.
struct CoarseScene {
    const Grid& grid;
    const Parts& parts;
    std::span<const float> background_mm;  ///< by grid index; 0 = not known
    float margin_mm = 0.0F;                ///< what is nearer than the background by more is not it
    std::span<const PalmPrior> expected;   ///< a hand ends halfway to the palm of another
};

/// Cuts hands out of a depth image on the fine grid. Where one is has been found on the coarse
/// grid, so only a box round it is looked at.
class HandCut {
 public:
    /// @param coarse has the scale of fine_scale(), or twice that
    /// @param near_mm nearer is no depth
    void create(const Rig& rig, Size size, const Grid& coarse, float near_mm);

    /// Forgets the hands of the image before.
    void begin();

    /// Fills labels() and the region with one more hand.
    /// @return whether it is one: as large as the settings want
    bool cut(const DepthFrame& depth, const CoarseScene& coarse, const PalmCandidate& palm,
             const TrackerSettings& settings, HandRegion& region);

    /// Filled in the boxes of this image's hands.
    [[nodiscard]] const Grid& grid() const noexcept { return grid_; }
    /// Label of a grid index (padding counted).
    [[nodiscard]] std::span<const std::uint8_t> labels() const noexcept { return labels_; }

 private:
    struct Depths {
        float low_mm = 0.0F, high_mm = 0.0F;  ///< low > high: the hand is not here
        bool whole = false;                   ///< all of it is within reach, and beyond the wrist
    };
    struct RidgePoint {
        int x = 0, y = 0;
        float worth_px = 0.0F;  ///< of the circle there: its radius, less where none is expected
    };

    /// A plane at which a hand ends, from its palm's centre.
    struct End {
        Vec3f direction = Vec3f::Zero();  ///< unit, out of the hand
        float distance_mm = 0.0F;
    };

    void set_ends(const PalmCandidate& palm, std::span<const PalmPrior> expected);
    /// How much farther from the palm's centre than the ends allow; negative: less.
    [[nodiscard]] float beyond_ends(const Vec3f& from_palm) const noexcept {
        float most = from_palm.dot(ends_[0].direction) - ends_[0].distance_mm;
        for (std::size_t k = 1; k < end_count_; ++k) {
            most = std::max(most, from_palm.dot(ends_[k].direction) - ends_[k].distance_mm);
        }
        return most;
    }
    Box mark_coarse(const CoarseScene& coarse, const PalmCandidate& palm);
    Box adopt_fingers(const CoarseScene& coarse, const PalmCandidate& palm,
                      std::span<const int> pixels, Box box);
    Box grow_finger(const CoarseScene& coarse, const PalmCandidate& palm, int from);
    [[nodiscard]] static bool is_another(const CoarseScene& coarse, const PalmCandidate& palm,
                                         int i);
    [[nodiscard]] bool may_be_finger(const CoarseScene& coarse, const PalmCandidate& palm,
                                     int i) const;
    void find_pixels(const CoarseScene& coarse, const PalmCandidate& palm, const Box& cells,
                     const Box& box);
    [[nodiscard]] int component_at(const CoarseScene& coarse, const PalmCandidate& palm,
                                   const Box& box) const;
    void paint(int component, HandRegion& region);
    void clear(const HandRegion& region);
    void centre_palm(const PalmCandidate& palm, HandRegion& region);
    [[nodiscard]] float exact_radius_px(int x, int y) const;
    [[nodiscard]] float skin_mm(const HandRegion& region, float otherwise) const;

    float near_mm_ = 0.0F;
    int ratio_shift_ = 0;  ///< a coarse pixel is so many times two fine ones wide: 0 or 1
    Grid grid_;
    Components components_;
    static constexpr Depths kNowhere{1e9F, 0.0F, false};
    static constexpr Depths kNoFinger{1e9F, -1.0F, false};  ///< nowhere, and looked at
    std::array<End, kMaxHands + 1> ends_{};                 ///< the wrist, and towards other hands
    std::size_t end_count_ = 0;
    std::vector<Depths> own_;  ///< of the hand in a coarse pixel; kNowhere between calls
    std::array<bool, Parts::kPartsMax> adopted_{};  ///< parts that are fingers of the hand
    std::vector<int> finger_;     ///< coarse pixels that were looked at for fingers behind the hand
    std::vector<Depths> rows_;    ///< in it and its neighbours along the row
    std::vector<Depths> depths_;  ///< in it and all its neighbours, with what noise may add
    std::vector<float> low_mm_, high_mm_;  ///< of one row, by pixel of the fine grid
    std::vector<std::uint8_t> inside_;
    std::vector<std::uint8_t> labels_;
    std::vector<std::uint16_t> nearness_;          ///< to the rim of the hand
    std::vector<int> rim_x_, rim_y_;               ///< pixels just outside the hand
    std::vector<RidgePoint> ridge_;                ///< places where the palm's centre may be
    std::array<HandRegion, kMaxHands> painted_{};  ///< what begin() clears
    std::size_t painted_count_ = 0;
};

}  // namespace xtrack::segment
