// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include <xtrack/depth_decoder.hpp>

#include "core/decode/carrier.hpp"
#include "core/decode/colour_palette.hpp"
#include "core/decode/taps.hpp"
#include "core/depth/order_reference.hpp"
#include "core/depth/triangulation.hpp"
#include "core/pipeline/decode_plan.hpp"
#include "core/pipeline/frame_window.hpp"
#include "core/pipeline/motion.hpp"
#include "core/pipeline/row_team.hpp"

namespace xtrack {

// depth_decoder.cpp: set-up and what happens once a frame; decode_rows.cpp: what happens to every
// row; moving_rows.cpp: what more happens to rows in which something moves.
struct DepthDecoder::Impl {
    Impl(DecodePlan decode_plan, const DecodeSettings& decode_settings, Size image);

    // The images that one period is decoded from, in one stretch of rows. Of a colour period the
    // taps are turns of the phase that its channels give.
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

    // Rows of one member of the team, small enough to stay in the first-level cache.
    struct Scratch {
        explicit Scratch(int width);

        Image<float> phase, modulation, coordinate, reference, ideal, rays;
        Image<float> moving_phase, moving_modulation, moving_coordinate;
        Image<std::uint8_t> grey;
        Image<float> taps;  // ColourModel::kTaps rows, for the row at hand
        int row_of_taps = -1;
    };

    Result<void> prepare();
    DecodeStatus push(const FramePtr& frame) noexcept;
    void decode(const Frame& frame) noexcept;
    void register_depth(const Frame& frame) noexcept;

    void decode_rows(int begin, int end) noexcept;
    void decode_one_row(int y, Scratch& scratch) noexcept;
    void mask_rows(int begin, int end) noexcept;
    bool choose_images(std::size_t sine, int y, Images& images) const noexcept;
    bool choose_carrier_image(const SinePlan& period, int y, Images& images) const noexcept;
    void find_carrier(const Frame& frame) noexcept;
    void choose_colour_images(const SinePlan& period, int y, Images& images) const noexcept;
    const std::uint8_t* grey_row(const Frame& frame, int y, std::size_t buffer,
                                 Scratch& scratch) const noexcept;
    void decode_sine_row(std::size_t sine, const Images& images, int y, const RowOut& out,
                         Scratch& scratch) const noexcept;
    void decode_ramp_row(std::size_t sine, int y, const RowOut& out,
                         Scratch& scratch) const noexcept;
    void decode_gray_row(int y, float* coordinate, float* modulation, Scratch& scratch) noexcept;
    /// Decodes and unwraps every period; out.coordinate is not touched without geometry.
    void decode_row_chain(const std::vector<Images>& chain, int y, const RowOut& out,
                          Scratch& scratch) noexcept;
    // colour_rows.cpp: which surface every pixel is of.
    struct ColourRow {                       // what samples of a row are taken from
        const std::uint8_t* fine = nullptr;  // bgr; null: not seen cleanly
        const std::uint8_t* coarse = nullptr;
        const float* reference_px = nullptr;  // null: nothing known
        const std::uint8_t* moved = nullptr;  // of the coarse image, where it shows what moves
        int moved_dx = 0;
        int cell_y = 0;  // of the motion's cells
    };
    Result<void> prepare_colours();
    void tell_surfaces() noexcept;
    void choose_surfaces() noexcept;
    void draw_borders(int first_cell_y, int last_cell_y) noexcept;
    [[nodiscard]] ColourRow colour_row(int y) const noexcept;
    void sample_colours(const ColourRow& row, int x, std::size_t at, const ColourSamplesOut& out,
                        const std::array<float*, 3>& moved) const noexcept;
    [[nodiscard]] bool moves() const noexcept;
    [[nodiscard]] float coarse_drift_px() const noexcept;
    void decode_moved_colours(int y, const RowOut& out, Scratch& scratch) noexcept;
    void colours_of_row(int y, Scratch& scratch) const noexcept;
    void average_row(const Images& images, int y, Scratch& scratch) noexcept;
    void triangulate_row(int y, const RowOut& row, Scratch& scratch) noexcept;
    void noise_gain_row(int y, float* gain) const noexcept;

    /// The chosen images once more, moved along with what moves, their taps corrected.
    void follow_images() noexcept;
    [[nodiscard]] double find_moving_depth_mm() noexcept;
    void set_phase_gradient() noexcept;
    [[nodiscard]] double drift_px_since(const Frame& frame) const noexcept;
    void decode_moving_row(int y, const RowOut& out, Scratch& scratch) noexcept;
    void add_cell_drift(int cx, int cy, int begin, int end, bool follow,
                        const RowOut& out) noexcept;
    void mask_disagreeing(int y, int begin, int end, bool follow, const RowOut& out) noexcept;

    [[nodiscard]] const Impl& results() const noexcept { return before ? *before : *this; }

    Rig rig;  // this and the next: to be made anew
    PatternSequence patterns;
    DecodeSettings settings;
    DecodePlan plan;
    Size size;
    FrameWindow window;
    std::optional<MotionEstimator> motion;
    std::optional<ColourPalette> palette;  // only where the sequence has colour fringes
    ColourModel colours;
    TapSet carrier;                    // of a sequence of one grey sine; empty: none found yet
    Image<std::uint8_t> carrier_grey;  // a colour frame's luma
    double carrier_sign = 1.0;         // -1: the phase falls with the pixel's index
    std::optional<Triangulation> geometry;
    OrderReference order;
    Image<float> order_px;  // from set_order_depth()
    std::optional<Stamp> last_stamp;
    FramePtr newest;        // pushed and taken
    FramePtr last_decoded;  // the newest of the last decode
    // What was there before the settings changed: its results are those of now until the next
    // decode.
    std::unique_ptr<Impl> before;
    Stamp oldest_image;  // of those that the depth at hand is made of
    DepthFrame depth;
    PhaseMap phase_map;
    Image<float> coordinate;
    Image<float> average;
    Image<float> sigma;
    std::vector<Images> still;      // by period, for the rows at hand
    std::vector<Images> following;  // the same, for what moves
    bool can_follow = false;
    double moving_depth_mm = 0.0;      // of what moves; 0: unknown
    double drift_rad_per_cycle = 0.0;  // of the shortest period, at what moves
    std::vector<std::uint16_t> moving_depths;
    std::optional<RowTeam> team;
    std::vector<Scratch> scratches;  // of the team's members
};

}  // namespace xtrack
