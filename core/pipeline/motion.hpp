// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <xtrack/frame.hpp>
#include <xtrack/image.hpp>

#include "core/decode/taps.hpp"
#include "core/pipeline/frame_window.hpp"

namespace xtrack {

/// Whole camera pixels.
struct Shift {
    int dx = 0;
    int dy = 0;
};

/// Finds what moves in front of the camera and how, so that the images of a window can be laid on
/// top of each other before they are decoded.
///
/// Two images of the same pattern differ only where something moved; rows that either of them did
/// not see cleanly are left out. The move is the one shift that brings most of what differs into
/// agreement (block matching, coarse to fine). Where every pattern is shown once, the images are a
/// cycle apart and the move is assumed even over the window. Where patterns are held for two frames
/// or more, the images are one frame apart, and the path is put together from such short moves.
/// Each cell of 8 x 8 pixels then follows the move, or stands still, whichever explains its images
/// better.
class MotionEstimator {
 public:
    static constexpr int kCellPx = 8;

    struct Settings {
        float noise_levels = 4.0F;  ///< mean difference of a cell that counts as moving
        int max_shift_px = 120;     ///< between two images of one pattern
        /// Phase of each pattern where they are one cycle of three equal steps, else empty.
        std::vector<double> phases_rad;
    };

    MotionEstimator(Size image, int patterns, const Settings& settings);

    /// Takes the window after `newest` was pushed into it. No allocation.
    void update(const FrameWindow& window, const Frame& newest) noexcept;
    void clear() noexcept;

    /// False: nothing moves, every answer below is empty.
    [[nodiscard]] bool moving() const noexcept { return moving_; }
    /// True where the cell holds, or lately held, something that moved.
    [[nodiscard]] bool disturbed(int cell_x, int cell_y) const noexcept {
        return age_.at(cell_x, cell_y) > 0;
    }
    /// True where the cell follows the move.
    [[nodiscard]] bool follows(int cell_x, int cell_y) const noexcept {
        return moving_ && follows_.at(cell_x, cell_y) != 0;
    }
    /// True if any cell of this row of cells is disturbed.
    [[nodiscard]] bool row_disturbed(int cell_y) const noexcept {
        return row_disturbed_[static_cast<std::size_t>(cell_y)] != 0;
    }
    /// From a pixel of the newest frame to where `frame` shows the same point.
    [[nodiscard]] Shift to(const Frame& frame) const noexcept;
    /// Image motion, px a second.
    [[nodiscard]] Vec2f velocity_px() const noexcept { return velocity_; }
    /// Time between two images of one pattern, s.
    [[nodiscard]] double seconds_per_cycle() const noexcept { return seconds_per_cycle_; }
    /// Largest difference between the two newest images of a pattern, over all patterns, at a pixel
    /// of the newest frame that follows the move or stands still; grey levels.
    [[nodiscard]] int worst_difference(int x, int y, bool follow) const noexcept;
    /// The same where two whole cycles of three were seen, but of the fringes that the images of
    /// each give, and their mean: free of what the drift of the phase changes in the images.
    [[nodiscard]] float mismatch(int x, int y, bool follow) const noexcept;
    /// True where mismatch() is free of the drift, and drift_rad_since() knows it.
    [[nodiscard]] bool knows_drift() const noexcept { return whole_cycles_ || !stretches_.empty(); }
    /// Phase of what moves when `frame` was exposed, less that of now: what the move adds along the
    /// fringes' axis, and what was measured beyond, such as a change of depth.
    [[nodiscard]] float drift_rad_since(const Frame& frame) const noexcept;
    /// What a cell's phase moved by in a cycle beyond all that, as it stands still or follows, rad:
    /// a finger, a forearm or a slope is not as fast as the whole.
    [[nodiscard]] float cell_drift_rad(int cell_x, int cell_y) const noexcept {
        return cell_drift_rad_.at(cell_x, cell_y);
    }
    /// Before update(): how the phase of what moves changes along the image at its depth, rad / px.
    void set_gradient(const Vec2f& gradient_rad) noexcept { gradient_rad_ = gradient_rad; }
    /// Image motion of what moves, from when `frame` was exposed to the newest frame, px.
    [[nodiscard]] Vec2f path_since(const Frame& frame) const noexcept;
    /// Centre of the cells that follow, px of the newest frame.
    [[nodiscard]] Vec2f centre_px() const noexcept { return centre_; }
    [[nodiscard]] int cells_x() const noexcept { return age_.width(); }
    [[nodiscard]] int cells_y() const noexcept { return age_.height(); }

 private:
    static constexpr std::size_t kCycle = 3;
    static constexpr float kNoMatch = 255.0F;
    // Means of cells. Found again by the frame's count in the window: another frame may come to
    // lie where one was that the window let go.
    struct Small {
        Image<std::uint8_t> cells;
        const Frame* frame = nullptr;  // the window holds it while its count is there
        std::uint64_t count = 0;       // 0: empty
    };
    using SmallSlot = std::array<Small, FrameWindow::kDepth + 1>;  // one more than the window keeps
    void shrink(const Frame& frame, Image<std::uint8_t>& cells) const noexcept;
    [[nodiscard]] Small& take_small(const FrameWindow& window, int pattern) noexcept;
    /// Null when there is no such entry, or its frame was not shrunk.
    [[nodiscard]] const Small* find_small(const FrameWindow::Entry* entry) const noexcept;
    /// Lists the cells that differ and makes them young.
    void mark_moving(const Small& now, const Small& before, int lifetime) noexcept;
    [[nodiscard]] const Small* find_last(const FrameWindow& window, const Small& now,
                                         std::uint64_t ago) const noexcept;
    [[nodiscard]] bool saw_alike(const Small& now, const Small& before, int cy) const noexcept;
    /// True where a row of cells in both shows one pattern, or `before` a blend that is known.
    [[nodiscard]] bool comparable(const Small& now, const Small& before, int cy) const noexcept;
    /// Finds what the unclean rows of the frame before the newest are mixed of.
    void find_blend(const Small& now, const Small& before, const Small* earlier) noexcept;
    void fill_shares() noexcept;
    /// Grey levels by which a cell of `now` and the one that is so many cells on in `before`
    /// differ.
    [[nodiscard]] int cells_differ(const Small& now, const Small& before, int cx, int cy, int dx,
                                   int dy) const noexcept;
    [[nodiscard]] int pixels_differ(const Small& now, const Small& before, int x, int y, int dx,
                                    int dy) const noexcept;
    [[nodiscard]] int blend_differs(int now, int mixed, int earlier, int mixed_row,
                                    int earlier_row) const noexcept;
    void age_cells() noexcept;
    /// From now to before, by the listed cells.
    [[nodiscard]] Shift search(const Small& now, const Small& before,
                               double seconds) const noexcept;
    /// The same of the means of whole cycles.
    [[nodiscard]] Shift search_cycles(double seconds) const noexcept;
    [[nodiscard]] Shift search_cells(const Small& now, const Small& before,
                                     double seconds) const noexcept;
    /// @param differ grey levels by which pixel (x, y) and the one that is (dx, dy) on in the
    ///        image before differ
    template <class Differ>
    [[nodiscard]] Shift search_pixels(const Differ& differ, Shift around, int radius,
                                      int step) const noexcept;
    [[nodiscard]] bool enough_moved() const noexcept;
    void follow_cycle(const Small& now, const Small& before) noexcept;
    void follow_held(const Small& now, const Small* before) noexcept;
    void remember(Stamp when) noexcept;
    void bend_path() noexcept;
    void choose_cells() noexcept;
    void pair_images(const FrameWindow& window) noexcept;

    // How a cycle's images are laid on top of each other, and decoded.
    struct View {
        TapSet taps;
        float mean_re = 0.0F;  // of e^{i phase}
        float mean_im = 0.0F;
        // Of each image, what the newest frame's pixel (0, 0) shows, be it outside or not.
        std::array<const std::uint8_t*, kCycle> origin{};
        std::array<std::ptrdiff_t, kCycle> stride{};
        std::array<int, kCycle> step{};
        // Pixels that every image has.
        int left = 0, right = 0, top = 0, bottom = 0;
    };
    struct Cycle {
        std::array<const Frame*, kCycle> frames{};  // by pattern; the window holds them
        std::array<const Small*, kCycle> cells{};
        std::array<View, 2> views;  // standing still, following
    };
    struct Fringe {
        float re = 0.0F;  // amplitude and phase
        float im = 0.0F;
        float mean = 0.0F;
    };
    // Sum of unit vectors: how far the phase turned.
    struct Turn {
        float re = 0.0F;
        float im = 0.0F;
        int samples = 0;
    };
    // Where patterns are held: rows whose newest clean images are the same.
    struct Stretch {
        int end = 0;  // first row after it
        Cycle cycle;
    };
    /// Empty where some row has not seen every pattern.
    void find_stretches(const FrameWindow& window) noexcept;
    void prepare_stretches() noexcept;
    /// Differences of the images before from what the newest fringes let expect: the largest.
    [[nodiscard]] float surprise(int x, int y, bool follow) const noexcept;
    [[nodiscard]] bool find_cycles(const FrameWindow& window, const Frame& newest) noexcept;
    [[nodiscard]] static int mean_at(const Cycle& cycle, int x, int y) noexcept;
    void mean_cells(const Cycle& cycle, Image<std::uint8_t>& cells) const noexcept;
    void prepare_views() noexcept;
    /// Of the fringes that a point of the newest frame shows in `frame`, of `pattern`.
    [[nodiscard]] double phase_in(const Frame& frame, int pattern, bool follow) const noexcept;
    void prepare_view(const Cycle& cycle, bool follow, View& view) const noexcept;
    /// False where a shifted image has no such pixel.
    [[nodiscard]] static bool look(const Cycle& cycle, bool follow, int x, int y,
                                   Fringe& out) noexcept;
    /// Adds the turn of the phase from now to before of a cell's samples that are of one point.
    void add_turns(int cell_x, int cell_y, bool follow, int step_px, Turn& turn) const noexcept;
    /// Takes the drift that the move leaves. @return the mismatch of what moves, grey levels
    float measure_drift() noexcept;
    void take_move(const Shift& shift, double cycles_ago) noexcept;
    /// From the end of a path back to where it began.
    [[nodiscard]] static Shift shift_along(const Vec2f& path_px) noexcept;
    /// Of the move that the newest images of one pattern found, that of the cycles' means, and the
    /// one before: the one after which two cycles of fringes agree best.
    void choose_move(const Shift& by_pattern) noexcept;
    void measure_cell_drift() noexcept;

    // A frame that saw the switch from one pattern to the next: row by row, what it shows is so
    // much of the pattern that it is of, the rest of the one before. `earlier` saw that alone.
    struct Blend {
        const Small* of = nullptr;  // null: there is none
        const Small* earlier = nullptr;
        std::vector<int> shares;  // of each row of cells, of kWhole; negative: unknown
    };
    static constexpr int kWhole = 256;
    // Every frame that the window keeps of a cycle may begin and end one.
    static constexpr std::size_t kMostStretches = 2 * kCycle * FrameWindow::kDepth + 1;

    Size size_;
    int patterns_;
    Settings settings_;
    Stamp now_;
    double seconds_per_cycle_ = 0.0;
    bool moving_ = false;
    bool held_ = false;  // patterns are held: the path is in the history
    Vec2f velocity_ = Vec2f::Zero();
    Vec2f acceleration_ = Vec2f::Zero();
    Vec2f centre_ = Vec2f::Zero();
    bool whole_cycles_ = false;    // cycles_ hold
    std::array<Cycle, 2> cycles_;  // newest, the one before
    std::array<Small, 2> mean_cells_;
    Blend blend_;
    std::vector<Stretch> stretches_;  // empty: none
    std::vector<std::uint8_t> stretch_of_row_;
    Image<Turn> turns_;
    Image<float> cell_drift_rad_;
    float extra_rad_per_s_ = 0.0F;  // beyond the move along the image
    float lag_s_ = 0.0F;            // from when the velocity was what it is, to now
    Vec2f gradient_rad_ = Vec2f::Zero();
    std::vector<SmallSlot> small_;
    Image<std::uint8_t> age_;  // pushes for which a cell stays disturbed
    Image<std::uint8_t> follows_;
    Image<float> still_cost_, follow_cost_;
    std::vector<std::uint8_t> row_disturbed_;
    std::vector<std::array<std::int16_t, 2>> active_cells_;
    struct Pair {
        const Frame* now;
        const Frame* before;
        Shift to_now, to_before;
        // Of the fringes in `before`, standing still and following.
        std::array<float, 2> cosine{}, sine{};
    };
    std::vector<Pair> pairs_;
    struct Past {
        Stamp stamp;
        Vec2f velocity = Vec2f::Zero();
    };
    std::array<Past, 16> history_{};  // newest first
    std::size_t history_count_ = 0;
};

}  // namespace xtrack
