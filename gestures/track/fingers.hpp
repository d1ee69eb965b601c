// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <xtrack/hand.hpp>
#include <xtrack/hand_region.hpp>

#include "gestures/segment/components.hpp"
#include "gestures/segment/grid.hpp"
#include "gestures/track/contour.hpp"

namespace xtrack::track {

/// A distal extreme of the hand's outline.
struct Tip {
    Vec3f position_mm = Vec3f::Zero();
    int contour_index = 0;
    float distance_mm = 0.0F;    ///< from the palm's centre
    float prominence_mm = 0.0F;  ///< above the higher of its two valleys
    float width_mm = 0.0F;       ///< of the finger, a little below the tip
    float angle_rad = 0.0F;  ///< round the palm from the finger direction, clockwise in the image
    Vec3f pad_before_mm = Vec3f::Zero();  ///< skin a pad's length below the tip, along the outline
    Vec3f pad_after_mm = Vec3f::Zero();   ///< the same on its other side, clockwise of it
    Finger finger = Finger::index;
};

inline constexpr std::size_t kTipsMax = 8;
inline constexpr std::size_t kReachBins = 60;

/// What one frame says about a hand's fingers.
struct FingerReading {
    std::array<Tip, kTipsMax> tips{};
    std::size_t count = 0;
    int thumb = -1;            ///< index into tips, or -1
    float thumb_score = 0.0F;  ///< 0..1, how clearly it is one
    int thumb_side = 0;        ///< +1: clockwise (in the image) of the fingers; -1: the other way
    Vec3f finger_direction = Vec3f::Zero();  ///< unit, from the palm to the fingers
    float finger_area_mm2 = 0.0F;            ///< hand surface beyond the palm's circle
    float curl_mm = 0.0F;  ///< mean height of the tips above the palm's plane, toward the camera
    bool ring = false;     ///< thumb and index close a ring round a hole
    Vec3f ring_tip_mm = Vec3f::Zero();  ///< where it closes
    /// Ends too wide for one finger: two that lie together, or have met.
    std::array<Vec3f, kTipsMax> wide_mm{};
    std::size_t wide_count = 0;
    /// How far the hand goes from the palm's centre, mm, by direction in the image plane.
    std::array<float, kReachBins> reach_mm{};

    /// The same for the direction of a vector from the palm's centre.
    [[nodiscard]] float reach_toward(const Vec3f& from_palm) const;
};

/// Reads fingertips off a hand's outline: peaks of the distance from the palm's centre that stand
/// out from the valleys beside them and are as narrow as a finger.
class FingerReader {
 public:
    void create(const segment::Grid& grid);

    /// @param side_hint thumb side known from earlier frames, or 0
    /// @param tip_prominence_mm least prominence of a tip
    void read(const segment::Grid& grid, std::span<const std::uint8_t> labels,
              const HandRegion& region, const Vec3f& palm_normal, int side_hint,
              float tip_prominence_mm, FingerReading& out);

 private:
    void measure_profile(const segment::Grid& grid, std::span<const std::uint8_t> labels,
                         const HandRegion& region);
    void find_tips(const HandRegion& region, float tip_prominence_mm, FingerReading& out) const;
    void find_ring(const segment::Grid& grid, std::span<const std::uint8_t> labels,
                   const HandRegion& region, FingerReading& out);
    void measure_reach(const HandRegion& region, FingerReading& out) const;

    Contour contour_;
    std::vector<Vec3f> points_;    ///< of the contour, with the depth of the skin beside them
    std::vector<float> distance_;  ///< from the palm, smoothed; 0 on the wrist's cut
    std::vector<float> scratch_;
    struct Hole {
        float pixels = 0.0F;
        Vec2f sum_px = Vec2f::Zero();
    };
    segment::Components gaps_;  ///< what is not hand in a box round it
    std::vector<Hole> holes_;   ///< by component of gaps_
};

/// Says which tip is which finger: the thumb by its gap and length, the others in order from it.
/// @param side_hint +1 or -1 when the thumb's side is known from before, 0 if not
void name_fingers(const HandRegion& region, int side_hint, FingerReading& reading);

}  // namespace xtrack::track
