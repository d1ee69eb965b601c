// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <xtrack/depth.hpp>
#include <xtrack/rig.hpp>

#include "gestures/segment/grid.hpp"

namespace xtrack::segment {

/// Relative depth as if it were metric, in *nominal* millimetres in which a palm is 80 mm wide:
/// what finds, follows and understands hands then works on it, and its thresholds are palm widths.
///
/// What fringes give without a calibration is how many projector pixels h a surface is off the
/// background. Pinholes make that 1/Z = 1/Z0 + h/K. The focal length is taken for the image's width
/// (a field of view of 53 degrees). K and Z0 follow from the hand, which is what stands out most of
/// what moves: the largest circle in it is a palm's, 40 mm, which says how far away it is, and the
/// background is taken to lie kBackgroundShare times as far away. A hand that is found smaller or
/// larger again and again makes a new scale. Until something moves, what rests is taken for it.
class RelativeScene {
 public:
    static constexpr double kPalmRadius_mm = 40.0;
    static constexpr double kBackgroundShare = 1.6;

    /// @param background_mm, mm_per_px how the depth images that will come code h
    RelativeScene(Size image, double background_mm, double mm_per_px);

    /// A camera whose image is as wide as it is far.
    [[nodiscard]] static Rig nominal_rig(Size image);

    /// Takes the next relative depth image. Allocates nothing.
    /// @param component PaperDecoder::component() of it
    /// @param moving_ids the components up to this one move, and are no scraps; negative: nobody
    ///        knows what moves
    /// @param followed a hand was found in the last depth()
    /// @return whether the scale is new: what was learnt of the scene before is void
    bool update(const DepthFrame& relative, const Image<std::uint16_t>& component, int moving_ids,
                bool followed);

    [[nodiscard]] bool has_scale() const noexcept { return inverse_background_ > 0.0; }
    /// What stands out from the background, in nominal mm, 0 elsewhere; once something has moved,
    /// of what stands still only what is about as near as the hand; all 0 while nothing has
    /// stood out yet. Valid until the next update().
    [[nodiscard]] const DepthFrame& depth() const noexcept { return depth_; }

    /// What was measured in the last image. @{
    [[nodiscard]] double palm_radius_px() const noexcept { return palm_radius_px_; }  ///< 0: none
    [[nodiscard]] double palm_height_px() const noexcept { return palm_height_px_; }
    /// @}

 private:
    struct Palm {
        double radius_px = 0.0;
        double height_px = 0.0;
    };

    /// Looks for the palm among components up to `moving_ids`; negative: among all. @return found
    bool measure(const Image<std::uint16_t>& component, int moving_ids);
    [[nodiscard]] Palm usual_palm(std::size_t count);
    /// Whether most of those that usual_palm() looked at are like it.
    [[nodiscard]] bool agree(std::size_t count, const Palm& usual) const noexcept;
    bool rescale(bool moves, bool followed);
    void convert(const DepthFrame& relative, const Image<std::uint16_t>& component);
    [[nodiscard]] double height_px(double depth_mm) const noexcept {
        return (background_mm_ - depth_mm) / mm_per_px_;
    }

    double background_mm_;
    double mm_per_px_;
    double focal_px_;
    Grid grid_;
    std::vector<float> heights_;
    std::vector<std::uint16_t> nearness_;  ///< to what is no palm
    DepthFrame depth_;
    double palm_radius_px_ = 0.0;
    double palm_height_px_ = 0.0;
    static constexpr std::size_t kRemembered = 21;
    std::array<Palm, kRemembered> palms_{};
    std::array<Palm, kRemembered> sorted_{};
    std::size_t seen_ = 0;
    bool moved_ = false;               ///< what is remembered moved
    double inverse_background_ = 0.0;  ///< 1/Z0, 1/mm; 0: no scale yet
    double usual_height_px_ = 0.0;
    double inverse_per_px_ = 0.0;  ///< 1/K
};

}  // namespace xtrack::segment
