// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include <xtrack/depth_decoder.hpp>

#include "core/decode/taps.hpp"
#include "core/depth/triangulation.hpp"
#include "core/pipeline/decode_plan.hpp"
#include "core/pipeline/frame_window.hpp"
#include "core/pipeline/motion.hpp"
#include "core/pipeline/order_reference.hpp"

namespace xtrack {

// depth_decoder.cpp: set-up and what happens once a frame; decode_rows.cpp: what happens to every
// row; moving_rows.cpp: what more happens to rows in which something moves.
struct DepthDecoder::Impl {
    Impl(DecodePlan decode_plan, const DecodeSettings& decode_settings, Size image);

    // The images that one period is decoded from, in one stretch of rows.
    struct Images {
        TapSet taps;
        std::array<const Frame*, kMaxTaps> frames{};
    };
    // Where a row's results go.
    struct RowOut {
        float* phase = nullptr;
        float* modulation = nullptr;
        float* coordinate = nullptr;
    };

    Result<void> prepare(const Rig& rig);
    DecodeStatus push(const FramePtr& frame) noexcept;
    void register_depth(const Frame& newest) noexcept;

    void decode_rows(int begin, int end) noexcept;
    void mask_rows(int begin, int end) noexcept;
    bool choose_images(std::size_t sine, int y, Images& images) const noexcept;
    const std::uint8_t* grey_row(const Frame& frame, int y, std::size_t buffer) noexcept;
    void decode_sine_row(std::size_t sine, const Images& images, int y, const RowOut& out) noexcept;
    void decode_gray_row(int y, float* coordinate, float* modulation) noexcept;
    /// Decodes and unwraps every period; out.coordinate is not touched without geometry.
    void decode_row_chain(const std::vector<Images>& chain, int y, const RowOut& out) noexcept;
    void average_row(const Images& images, int y) noexcept;
    void triangulate_row(int y, const RowOut& row) noexcept;

    /// The chosen images once more, moved along with what moves, their taps corrected.
    void follow_images() noexcept;
    [[nodiscard]] double find_moving_depth_mm() noexcept;
    void set_phase_gradient() noexcept;
    [[nodiscard]] double drift_px_since(const Frame& frame) const noexcept;
    void decode_moving_row(int y, const RowOut& out) noexcept;
    void add_cell_drift(int cx, int cy, int begin, int end, bool follow,
                        const RowOut& out) noexcept;
    void mask_disagreeing(int y, int begin, int end, bool follow, const RowOut& out) noexcept;

    DecodeSettings settings;
    DecodePlan plan;
    Size size;
    FrameWindow window;
    std::optional<MotionEstimator> motion;
    std::optional<Triangulation> geometry;
    OrderReference order;
    Image<float> order_px;  // from set_order_depth()
    std::optional<Stamp> last_stamp;
    Stamp oldest_image;  // of those that the depth at hand is made of
    DepthFrame depth;
    PhaseMap phase_map;
    Image<float> coordinate;
    Image<float> average;
    std::vector<Images> still;      // by period, for the rows at hand
    std::vector<Images> following;  // the same, for what moves
    bool can_follow = false;
    double moving_depth_mm = 0.0;      // of what moves; 0: unknown
    double drift_rad_per_cycle = 0.0;  // of the shortest period, at what moves
    std::vector<std::uint16_t> moving_depths;
    // Scratch rows, small enough to stay in the first-level cache.
    Image<float> row_phase, row_modulation, row_coordinate, row_reference, row_ideal, row_rays;
    Image<float> moving_phase, moving_modulation, moving_coordinate;
    Image<std::uint8_t> row_grey;
};

}  // namespace xtrack
