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

/// The nearest moving surface at a camera pixel: a place in a triangle of a hand.
struct Surfel {
    float depth_mm = kFarAway;
    std::uint32_t triangle = 0;  ///< of the model; the second hand's follow the first's
    float w0 = 0.0F;             ///< weights of the triangle's corners; the third completes 1
    float w1 = 0.0F;
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
    /// Which hand a surfel is of, and which part of it; none where the background is nearer.
    [[nodiscard]] std::size_t hand_of(const Surfel& s) const {
        return s.triangle / model_.triangles.size();
    }
    [[nodiscard]] SimPart part_of(const Surfel& s) const {
        return model_.vertices[model_.triangles[s.triangle % model_.triangles.size()][0]].part;
    }
    [[nodiscard]] const PixelRect& drawn() const noexcept { return drawn_; }

    [[nodiscard]] const StaticScene& scene() const noexcept { return scene_; }
    [[nodiscard]] const Timing& timing() const noexcept { return timing_; }
    [[nodiscard]] const Lens& camera() const noexcept { return camera_; }
    [[nodiscard]] const HandModel& model() const noexcept { return model_; }
    [[nodiscard]] const std::vector<HandMotion>& hands() const noexcept { return hands_; }
    [[nodiscard]] float hand_scale() const noexcept { return hand_scale_; }

 private:
    struct Vertex {
        Corner camera;
        Corner lamp;
        float inverse_z = 0.0F;  ///< of the camera; negative = behind it
        float lamp_depth_mm = 0.0F;
    };
    struct Curves {
        std::array<const float*, kMaxChannels> of_channel{};
    };

    void move_hand(std::size_t hand, double middle_s);
    void draw_hand(std::size_t hand);
    void draw_all(double middle_s);
    void clear();
    [[nodiscard]] int motion_samples(double stamp_s) const;
    [[nodiscard]] Curves curves_for(const PatternMix& mix);
    void light_background(int y, const Curves& curves, float* row) const;
    void light_hands(int y, const Curves& curves, float share, float* row) const;
    void cast_shadow(int y, const Curves& curves, float share, float* row) const;
    void light_surfel(int x, int y, const Surfel& s, const Curves& curves, float share,
                      float* pixel) const;
    /// What the background shows at a pixel.
    void add_background(int x, int y, const Curves& curves, float share, float* pixel) const;

    SimSettings settings_;
    std::size_t channels_;
    Timing timing_;
    Lens camera_;
    Lamp lamp_;
    StaticScene scene_;
    PatternCurves curves_;
    const HandModel& model_;
    float hand_scale_;
    std::vector<HandMotion> hands_;
    std::array<Tint, 8> tints_{};  ///< by SimPart

    std::array<std::vector<Vec3f>, 3> skinned_mm_;  ///< first row, middle, last row of the shutter
    std::vector<std::vector<Vec3f>> normals_;       ///< of each hand
    std::vector<Vertex> corners_;
    Image<Surfel> surfels_;
    std::vector<float> shadow_mm_;  ///< the hands' projector Z, one a cell of the map
    PixelRect drawn_ = kNoPixels;
    PixelRect shadowed_ = kNoPixels;  ///< cells of the map
    std::vector<float> blended_;
    PatternMix blended_mix_;
};

}  // namespace xtrack::sim
