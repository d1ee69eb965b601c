// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gestures/segment/chamfer.hpp"
#include "gestures/segment/components.hpp"
#include "gestures/segment/grid.hpp"

namespace xtrack::segment {

/// A connected piece of the scene that is thin enough to be a limb: pixels()[begin..end).
struct Part {
    int begin = 0, end = 0;
    float area_mm2 = 0.0F;
    float thickest_mm = 0.0F;  ///< largest inscribed radius
    int body = -1;             ///< label of the surface it belongs to
    bool touches_border = false;
    int root_pixels = 0;            ///< that touch the thick body it grew from
    Vec3f root_mm = Vec3f::Zero();  ///< their mean
};

/// A surface that is too thick for a limb.
struct Body {
    int label = 0;          ///< as Part::body
    float area_mm2 = 0.0F;  ///< of its thick core
    float depth_mm = 0.0F;  ///< mean of its thick core
    float front_mm = 0.0F;  ///< of the nearest tenth of it
};

/// Cuts a depth image at its discontinuities into surfaces, and every surface into a thick body
/// (torso, head, wall) and the thin limbs that grow from it: a morphological opening in
/// millimetres, whose residue is what may hold a hand. A limb that is its own surface comes through
/// whole.
class Parts {
 public:
    void create(const Grid& grid);

    /// @param foreground grid depth without background
    /// @param thick_mm radius above which a surface is body
    /// @param area_min_mm2 smaller pieces are dropped
    void find(const Grid& grid, std::span<const float> foreground, float thick_mm,
              float area_min_mm2);

    [[nodiscard]] std::span<const Part> parts() const noexcept { return parts_; }
    [[nodiscard]] std::span<const int> pixels(const Part& p) const noexcept {
        return {pixels_.data() + p.begin, static_cast<std::size_t>(p.end - p.begin)};
    }
    /// Number of the part that a grid pixel belongs to; kNone or kOther, both negative.
    [[nodiscard]] int part_of(int i) const noexcept {
        return part_of_[static_cast<std::size_t>(i)];
    }
    static constexpr int kNone = -1;   ///< background, no depth, a crumb
    static constexpr int kOther = -2;  ///< a surface that is no part: a body, a small limb

    /// Radius of the largest circle round a pixel that stays on its surface, mm and grid px.
    /// The image's border does not end a surface.
    [[nodiscard]] float radius_px(int i) const noexcept {
        return distance_px(nearness_[static_cast<std::size_t>(i)]) - 0.5F;
    }
    [[nodiscard]] float radius_mm(const Grid& grid, int i) const noexcept {
        return radius_px(i) * grid.pitch_mm(grid.z[static_cast<std::size_t>(i)]);
    }
    /// Whether a pixel of a part is on a middle line of its surface: no neighbour is clearly
    /// farther from the rim.
    [[nodiscard]] bool ridge(int i) const noexcept {
        return ridge_[static_cast<std::size_t>(i)] != 0;
    }
    [[nodiscard]] std::span<const Body> bodies() const noexcept { return bodies_; }

    static constexpr int kPartsMax = 32;

 private:
    void label_surfaces(const Grid& grid, std::span<const float> foreground, float area_min_mm2);
    void repeat_border(const Grid& grid);
    void measure_distance(const Grid& grid);
    void mark_ridges(const Grid& grid);
    void mark_body(const Grid& grid, float thick_mm);
    void collect(const Grid& grid, float area_min_mm2);
    void measure_body(const Grid& grid, int component);
    void measure(const Grid& grid, Part& part);

    /// What is known of a component before it is a part or a body.
    struct Piece {
        float area_mm2 = 0.0F;
        int pixels = 0;
        int number = kOther;  ///< of the part that it is
    };

    Components components_;
    std::vector<Piece> pieces_;
    std::vector<std::uint8_t> has_core_;   ///< by label: somewhere it is thick
    bool any_core_ = false;                ///< something is thick
    Box box_;                              ///< of all surfaces
    std::vector<std::uint16_t> label_;     ///< surface of a pixel, 0 = none
    std::vector<std::uint16_t> nearness_;  ///< to the rim of the surface
    std::vector<std::uint16_t> ridge_;     ///< in box_; not 0: see ridge()
    std::vector<std::uint16_t> ball_;      ///< > 0: inside a ball of the thick core
    std::vector<std::int8_t> part_of_;
    std::vector<int> pixels_;
    std::vector<Part> parts_;
    std::vector<Body> bodies_;
};

}  // namespace xtrack::segment
