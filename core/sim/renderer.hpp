// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <xtrack/image.hpp>
#include <xtrack/sim.hpp>

#include "core/sim/hand_model.hpp"
#include "core/sim/hand_pose.hpp"
#include "core/sim/motion.hpp"
#include "core/sim/scene.hpp"
#include "core/sim/timing.hpp"

namespace xtrack::sim {

/// The nearest moving surface at a camera pixel.
struct Surfel {
    float depth_mm = kFarAway;
    std::array<float, 3> normal{};
    float albedo = 0.0F;
    SimPart part = SimPart::none;
    std::uint8_t hand = 0;  ///< index of the moving hand
};

/// Draws the hands at a moment and adds what the projector makes of them and of the background to
/// a frame of light. Buffers live as long as the renderer.
/// @thread one at a time
class Renderer {
 public:
    Renderer(const SimSettings& settings, std::size_t channels);
    Renderer(const Renderer&) = delete;
    Renderer& operator=(const Renderer&) = delete;

    /// The light of one frame, grey levels before noise; width is channels times the camera's.
    /// @param light overwritten
    void expose(std::uint64_t frame, ImageView<float> light);

    /// Moves the hands to the middle of a frame's exposure and draws their geometry alone.
    void draw_geometry(std::uint64_t frame);
    [[nodiscard]] const Image<Surfel>& surfels() const noexcept { return surfels_; }
    [[nodiscard]] const PixelRect& drawn() const noexcept { return drawn_; }

    [[nodiscard]] const StaticScene& scene() const noexcept { return scene_; }
    [[nodiscard]] const Timing& timing() const noexcept { return timing_; }
    [[nodiscard]] const Lens& camera() const noexcept { return camera_; }
    [[nodiscard]] const HandModel& model() const noexcept { return model_; }
    [[nodiscard]] const std::vector<HandMotion>& hands() const noexcept { return hands_; }
    [[nodiscard]] float hand_scale() const noexcept { return hand_scale_; }

 private:
    struct Corner {
        ScreenPoint camera;
        ScreenPoint lamp;
        float inverse_z = 0.0F;
        float lamp_depth_mm = 0.0F;
    };
    struct Curves {
        std::array<const float*, kMaxChannels> of_channel{};
    };

    void move_hand(std::size_t hand, double middle_s);
    void draw_hand(std::size_t hand);
    void draw_all(double middle_s);
    void clear();
    void draw_camera(std::size_t hand, const std::array<std::uint32_t, 3>& triangle);
    void draw_shadow(const std::array<std::uint32_t, 3>& triangle);
    [[nodiscard]] int motion_samples(double stamp_s) const;
    [[nodiscard]] Curves curves_for(const PatternMix& mix);
    void light_row(int y, const Curves& curves, float share, float* row) const;
    void light_surfel(int x, int y, const Surfel& s, const Curves& curves, float share,
                      float* pixel) const;

    SimSettings settings_;
    std::size_t channels_;
    Timing timing_;
    Lens camera_;
    Lamp lamp_;
    StaticScene scene_;
    PatternCurves curves_;
    HandModel model_;
    float hand_scale_;
    std::vector<HandMotion> hands_;
    std::array<Tint, 8> tints_{};  ///< by SimPart

    std::array<std::vector<Vec3f>, 3> skinned_mm_;  ///< first row, middle, last row of the shutter
    std::vector<Vec3f> normals_;
    std::vector<Corner> corners_;
    Image<Surfel> surfels_;
    Image<float> shadow_mm_;
    PixelRect drawn_;
    PixelRect shadowed_;
    std::vector<float> blended_;
    PatternMix blended_mix_;
};

}  // namespace xtrack::sim
