// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include <xtrack/paper_decoder.hpp>

#include "core/decode/taps.hpp"
#include "core/depth/pixel_rays.hpp"
#include "core/depth/triangulation.hpp"
#include "core/pipeline/component_orders.hpp"
#include "core/pipeline/decode_plan.hpp"
#include "core/pipeline/frame_window.hpp"
#include "core/pipeline/still_scene.hpp"
#include "core/unwrap/spatial.hpp"

namespace xtrack {

// paper_decoder.cpp: set-up, frames and modes; paper_rows.cpp: what happens to the images.
struct PaperDecoder::Impl {
    Impl(DecodePlan decode_plan, Size image, const DecodeSettings& paper_settings,
         SpatialUnwrapper made, std::optional<Triangulation> rig_geometry, const Pinhole& camera);

    Result<void> prepare_phases_and_scene(const DecodeSettings& wanted);
    DecodeStatus push(const FramePtr& frame) noexcept;
    Result<void> learn_background();

    /// Everything, from the images in `shown`.
    /// @param fresh of images that no decode has seen yet: they say which way is nearer
    void decode(bool fresh) noexcept;
    void decode_phase() noexcept;
    void take_phase() noexcept;
    void decode_phase_rows(int begin, int end) noexcept;
    const std::uint8_t* grey_row(const Frame& frame, int y, std::size_t buffer) noexcept;
    /// The background's phase off each pixel's. False while there is none.
    bool subtract_background() noexcept;
    /// Solves and writes the phase as it is, and finds the plane of its largest surface.
    bool learn_plane(bool keep_seen);
    void write_results(bool fresh) noexcept;
    [[nodiscard]] double front_of_phase() const noexcept;
    void forget_scene() noexcept;  ///< heights are before another background now
    /// Whether it says now what it did not before.
    [[nodiscard]] bool find_front() noexcept;
    void order_scene_anew() noexcept;
    void write_still_row(int y) noexcept;
    void learn_still() noexcept;
    void write_row(int y) noexcept;  ///< turns and components
    void fill_outlines() noexcept;
    void close_bands() noexcept;
    void close_band(int x, int y, int dx, int dy, int length) noexcept;
    void fill_outline(int x, int y) noexcept;
    void write_depth_row(int y) noexcept;
    void mask_results() noexcept;
    void stamp_results() noexcept;

    Rig rig;  // this and the next: to be made anew
    PatternSequence patterns;
    DecodeSettings settings;
    DecodePlan plan;
    const SinePlan* period;          // of plan: the one that is used
    std::vector<std::uint8_t> used;  // by pattern
    Size size;
    FrameWindow window;  // of what comes
    FrameWindow shown;   // of what was decoded last
    std::optional<Stamp> last_stamp;
    bool decoded = false;

    /// Of periods that are one image, in colours or in space, and of steps whose motion is
    /// followed; other steps are decoded here.
    std::optional<DepthDecoder> phases;
    bool phases_are_stale = false;  // they were decoded under other settings
    bool from_phases = false;       // what was decoded last took its phase from there
    bool carrier_falls = false;     // the phase of a carrier falls with the pixel's index
    /// Where what moves is told from what stands still.
    std::optional<StillScene> scene;

    SpatialUnwrapper unwrapper;
    std::optional<Triangulation> geometry;
    PixelRays rays;
    ComponentOrders orders;
    std::vector<PaperComponent> components;

    PhaseMap phase_map;
    Image<float> difference;          // from the background; without a rig alone
    Image<float> background_wrapped;  // as taken off; empty: none is known
    Image<float> background;          // the same with its turns
    Image<float> unwrapped, unwrapped_before;
    Image<std::uint16_t> component, component_before;
    double front = 1.0;  // -1: less phase is nearer
    // What says so, over the images.
    int shadows = 0;
    bool front_is_sure = false;
    double standing_out = 0.0;
    DepthFrame depth;
    Image<float> points;  // 3 values a pixel

    // Scratch rows, small enough to stay in the first-level cache.
    Image<float> row_coordinate, row_rays;
    Image<std::uint8_t> row_grey;
};

}  // namespace xtrack
