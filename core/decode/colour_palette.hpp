// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <xtrack/image.hpp>

#include "core/decode/colour_search.hpp"
#include "core/decode/colour_surface.hpp"

namespace xtrack {

/// Tells surfaces of different colours apart under colour fringes, and learns what each does to the
/// colours, so that every pixel is decoded with the taps of its own surface.
///
/// A few surfaces are enough: skin, clothes, a wall. Each cell of 8 x 8 pixels is of the surface
/// under which its periods agree best on a coordinate, and on a contrast. What a surface does is
/// refined from the cells that chose it (ColourFit). New surfaces come from single pixels that
/// ColourSearch explains: many that agree on their gains are one.
///
/// Without a coarse colour period there is no such search: grey, skin and other tints about as
/// strong are given, each of which may become what it is like only so far that it does not become
/// its neighbour. Where nothing orders the period either, a cell is of the surface under which its
/// contrast is the same at every phase; whatever it is, as it depends on the light of the room.
///
/// Where something moves the coarse image, which is older, shows it at another place: its light
/// there is a second chance of a sample to agree with itself.
///
/// A frame: begin(), add_row() for every kSampleStep-th row, choose(), then surface_at() and taps()
/// are of this frame; learn() last.
/// @thread one at a time but where said; no allocation after create()
class ColourPalette {
 public:
    static constexpr int kCellPx = 8;
    static constexpr int kSampleStepPx = 4;  ///< of rows and columns
    static constexpr int kFineStepPx = 2;
    static constexpr int kFineSamples = kCellPx / kFineStepPx + 2;
    static constexpr std::size_t kMostSurfaces = 8;

    ColourPalette() = default;
    /// @param coarse the period that orders the fine one; empty: something else does
    /// @param first_px, last_px coordinates that are possible, one pixel a sample; copied
    ColourPalette(Size image, const ColourModel& model, const ColourPeriod& fine,
                  const std::optional<ColourPeriod>& coarse, const Image<float>& first_px,
                  const Image<float>& last_px);

    [[nodiscard]] static Size samples(Size image) noexcept {
        return {(image.width + kSampleStepPx - 1) / kSampleStepPx,
                (image.height + kSampleStepPx - 1) / kSampleStepPx};
    }

    /// @param moved_px how much larger than now the coordinates of what moves were when the coarse
    ///        image was taken
    void begin(float moved_px = 0.0F) noexcept;
    /// Where to put the samples of the pixels x = 0, kSampleStepPx, ... of a row; light of zero
    /// says that there is nothing to learn.
    /// @param y row of the image, a multiple of kSampleStepPx
    [[nodiscard]] ColourSamplesOut row(int y) noexcept;
    /// The same for the light of the coarse image where it shows what moves; zero: nothing does.
    [[nodiscard]] std::array<float*, 3> moved_row(int y) noexcept;
    /// Takes what was put into row(y). Rows of different cells may be filled and taken by threads
    /// of their own.
    void add_row(int y) noexcept;
    void choose() noexcept;
    /// True where a cell next to this one, or at its corner, is of another surface.
    [[nodiscard]] bool at_border(int cell_x, int cell_y) const noexcept;
    /// Draws the border within a cell, kFineStepPx at a time.
    /// @param samples kFineSamples x kFineSamples of them, kFineStepPx apart, row by row; they
    ///        reach one beyond the cell on each side
    /// @param moved light of the coarse image where it shows what moves
    /// @thread different cells may be drawn at a time
    void draw_border(int cell_x, int cell_y, const ColourSamples& samples,
                     const std::array<const float*, 3>& moved) noexcept;
    void learn() noexcept;
    /// True once surfaces were found and refined since the last clear().
    [[nodiscard]] bool settled() const noexcept { return frames_ >= kFirstFrames; }
    void clear() noexcept;

    /// By pairs of rows and columns: pixel (x, y) is of surfaces().at(x / kFineStepPx, ...), which
    /// surface_of() and is_moved() read.
    [[nodiscard]] const Image<std::uint8_t>& surfaces() const noexcept { return surfaces_; }
    [[nodiscard]] static std::size_t surface_of(std::uint8_t value) noexcept {
        return value & (kMoved - 1U);
    }
    /// True where the coarse image agrees at another place.
    [[nodiscard]] static bool is_moved(std::uint8_t value) noexcept { return value >= kMoved; }
    [[nodiscard]] int cells_x() const noexcept { return cells_.width(); }
    [[nodiscard]] int cells_y() const noexcept { return cells_.height(); }
    /// Of a surface; its phase is that of a pattern whose red has the phase 0.
    [[nodiscard]] const ColourModel::Taps& taps(std::size_t surface) const noexcept {
        return entries_[surface].taps;
    }
    [[nodiscard]] std::size_t count() const noexcept { return used_; }
    [[nodiscard]] const ColourSurface& surface(std::size_t surface) const noexcept {
        return entries_[surface].surface;
    }

 private:
    static constexpr std::uint8_t kMoved = 128;
    static constexpr int kFirstFrames = 9;
    static constexpr std::size_t kGiven = 2;  // surfaces that are always there: grey and skin
    static constexpr int kVoteCells = 40;     // along each axis of E
    struct Entry {
        ColourSurface surface;
        std::array<float, 2> given{};  ///< its log_gain at first, where it may not leave it far
        ColourModel::Inverse inverse = ColourModel::Inverse::Identity();
        ColourModel::Inverse coarse_inverse = ColourModel::Inverse::Identity();
        ColourModel::Taps taps{};
        ColourFit fit;
        int cells = 0;            // that chose it lately
        float commonness = 0.0F;  // the logarithm of that, of the image before
    };
    struct Evidence {
        float pixels = 0.0F;
        float light = 0.0F;
        std::array<float, kMostSurfaces> cost{};
        std::array<float, kMostSurfaces> moved{};
        // Of samples that have nothing but their contrast to go by.
        float alone = 0.0F;
        std::array<float, kMostSurfaces> contrast{};
        std::array<float, kMostSurfaces> square{};
    };

    void set(std::size_t entry, const ColourSurface& surface) noexcept;
    void measure(const Entry& entry, const ColourSamples& samples, float moved_px, int count,
                 float* cost, float* fine_contrast = nullptr) const noexcept;
    [[nodiscard]] ColourSamples row_samples(int row) const noexcept;
    [[nodiscard]] ColourModel::Light fine_at(int sx, int sy) const noexcept;
    [[nodiscard]] ColourModel::Light coarse_at(int sx, int sy) const noexcept;
    [[nodiscard]] bool is_alone(int sx, int sy) const noexcept;
    [[nodiscard]] bool is_unlit(int sx, int sy) const noexcept;
    /// As bright: of one surface, as far as that goes.
    [[nodiscard]] static bool alike(const Evidence& a, const Evidence& b) noexcept {
        constexpr float kAlike = 1.4F;
        const float x = a.light * b.pixels;
        const float y = b.light * a.pixels;
        return x < kAlike * y && y < kAlike * x;
    }
    [[nodiscard]] std::size_t index_of(int cell_x, int cell_y) const noexcept {
        return static_cast<std::size_t>(cell_y) * static_cast<std::size_t>(cells_.width()) +
               static_cast<std::size_t>(cell_x);
    }
    [[nodiscard]] Evidence around(const std::vector<Evidence>& cells, int x, int y, int step_x,
                                  int step_y) const noexcept;
    [[nodiscard]] Evidence around_or_along(int x, int y) const noexcept;
    void gather() noexcept;
    void judge_contrasts(Evidence& sum) const noexcept;
    [[nodiscard]] bool teaches(std::size_t surface, int sx, int sy) const noexcept;
    void refine() noexcept;
    void search() noexcept;
    void vote(const ColourHypothesis& hypothesis, float weight) noexcept;
    void drop_twins() noexcept;
    void found_surfaces() noexcept;

    Size size_;
    ColourModel model_;
    ColourPeriod fine_;
    std::optional<ColourPeriod> coarse_;
    ColourSearch search_;
    std::array<Entry, kMostSurfaces> entries_{};
    std::size_t used_ = 0;
    Size samples_;
    Image<float> first_px_, last_px_;
    // Of all samples: fine and coarse light, the reference, coarse light of what moves.
    std::array<Image<float>, 10> planes_;
    float moved_px_ = 0.0F;
    // Of a row of samples, in each row of cells.
    Image<float> moved_costs_, contrasts_;
    std::array<Image<float>, kMostSurfaces> costs_;  // of each surface in each sample
    Image<std::uint8_t> cells_;                      // surface, and kMoved
    Image<std::uint8_t> surfaces_;
    std::vector<Evidence> evidence_;
    std::vector<Evidence> smoothed_;
    Image<float> votes_;          // over E
    Image<float> vote_contrast_;  // the same times contrast
    Image<float> blurred_;
    std::size_t next_search_ = 0;
    int frames_ = 0;
};

}  // namespace xtrack
