// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include <xtrack/image.hpp>
#include <xtrack/result.hpp>

namespace xtrack {

/// Settings of the SpatialUnwrapper. None is fitted to a scene: what is noise and what is a step is
/// measured in every image.
struct SpatialUnwrapSettings {
    /// Largest difference between a step from one pixel to the next and the steps beside it along
    /// the same line, rad, 0.1 ... 3.1; beyond it neighbours are not connected. Above pi - the
    /// steepest slope of a surface (rad per pixel) nothing is gained.
    double step_limit_rad = 2.0;
    /// Share of the contact of two surfaces that must agree on their fringe order before they are
    /// joined, 0 ... 1. A surface that goes on agrees nearly everywhere; across a depth step a
    /// part of the border agrees by chance.
    double min_support = 0.5;
    /// Components of fewer pixels are masked, 1 ... kMaxImagePixels.
    int min_component_px = 64;
};

/// @return invalid_argument that names the first setting out of its documented range
/// @thread any
[[nodiscard]] Result<void> validate(const SpatialUnwrapSettings& settings);

/// Pixels that are connected, and so know their fringe order against each other.
struct PhaseComponent {
    std::uint16_t id = 0;  ///< 1, 2, ...: the most pixels first
    int pixels = 0;
    int seed_x_px = 0;  ///< the pixel of highest modulation (the first such, row by row): it keeps
    int seed_y_px = 0;  ///< its wrapped phase
    int left_px = 0;    ///< bounding box, all four within
    int top_px = 0;
    int right_px = 0;
    int bottom_px = 0;
};

/// The component of a pixel, and the whole turns that its phase lacks within it.
struct PhasePlace {
    std::uint16_t component = 0;  ///< 0: none
    std::int32_t turns = 0;       ///< 0 at the component's seed
};

/// Largest number of components in an image; of more, the smallest are masked. One id is left for
/// callers.
inline constexpr int kMaxPhaseComponents = 65534;

/// Unwraps a phase image from its own content: the order of a pixel is that of its neighbour, plus
/// or minus one where the phase jumps. Paths must keep away from noise and depth steps, so places
/// are taken by quality, best first (quality-guided: Ghiglia, Pritt 1998, "Two-Dimensional Phase
/// Unwrapping"; Zhang, Li, Yau 2007, "Multilevel quality-guided phase unwrapping algorithm for
/// real-time three-dimensional shape reconstruction").
///
/// What is ranked here is not pixels but pieces of rows. A step between neighbours is *sound* if it
/// deviates from the steps beside it by no more than the noise, which is measured once in an image
/// and scaled by the modulation, and if no loop of four pixels contradicts it (a residue). Sound
/// steps join pixels of a row into runs of up to 64; a run and the one below it are joined at once
/// where nearly all of a wide contact is sound. This leaves few regions, joined in the order of the
/// votes of all their contacts (RegionLinks).
///
/// Surfaces apart, a component's phase is relative: 2 pi times an unknown whole number is missing.
class SpatialUnwrapper {
 public:
    /// Takes all memory that an image of this size can need, some 200 bytes a pixel, most of it
    /// touched by badly broken images alone.
    /// @errors invalid_argument: the size or a setting; io: no memory
    /// @thread any
    [[nodiscard]] static Result<SpatialUnwrapper> create(Size size,
                                                         const SpatialUnwrapSettings& settings);
    SpatialUnwrapper(SpatialUnwrapper&&) noexcept;
    SpatialUnwrapper& operator=(SpatialUnwrapper&&) noexcept;
    ~SpatialUnwrapper();

    /// Unwraps one image. The same input gives the same bits, whatever came before.
    /// @param phase_rad wrapped phase, -pi ... pi; all else (NaN, infinite) is masked
    /// @param modulation quality, grey levels; all but 0 ... 1e6 counts as 0
    /// @param unwrapped_rad out: phase plus whole turns, NaN where masked or in no component; may
    ///        be the memory of `phase_rad`
    /// @param component out: id of the pixel's component, 0 = none
    /// @return the components, valid until the next call; none, and nothing written, where an
    ///         image is not of the size given to create()
    /// @thread one at a time
    /// @ownership borrows the images for the call; the result is the unwrapper's
    [[nodiscard]] std::span<const PhaseComponent> unwrap(ImageView<const float> phase_rad,
                                                         ImageView<const float> modulation,
                                                         ImageView<float> unwrapped_rad,
                                                         ImageView<std::uint16_t> component);

    /// The same in parts, for callers that choose where each component lies before anything is
    /// written, or take rows further while they are in the cache: solve(), then ask and write.
    /// @return as unwrap()
    /// @thread one at a time
    [[nodiscard]] std::span<const PhaseComponent> solve(ImageView<const float> phase_rad,
                                                        ImageView<const float> modulation);
    /// @pre 0 <= x < width, 0 <= y < height; solve() or unwrap() before
    [[nodiscard]] PhasePlace place(int x, int y) const noexcept;
    /// One row of what unwrap() writes.
    /// @param phase_rad the row that was solved
    /// @param turns added to the pixels of component i + 1; empty: none
    /// @pre 0 <= y < height; solve() or unwrap() before
    void write_row(int y, const float* phase_rad, std::span<const std::int32_t> turns,
                   float* unwrapped_rad, std::uint16_t* component) noexcept;

    /// Of the next image on; allocates nothing.
    /// @errors invalid_argument, and nothing changed
    [[nodiscard]] Result<void> set_settings(const SpatialUnwrapSettings& settings);

 private:
    class Impl;
    explicit SpatialUnwrapper(std::unique_ptr<Impl> impl) noexcept;
    std::unique_ptr<Impl> impl_;
};

}  // namespace xtrack
