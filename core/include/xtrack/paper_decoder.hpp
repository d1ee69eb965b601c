// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include <xtrack/decode_settings.hpp>
#include <xtrack/depth.hpp>
#include <xtrack/depth_decoder.hpp>
#include <xtrack/frame.hpp>
#include <xtrack/image.hpp>
#include <xtrack/pattern.hpp>
#include <xtrack/phase_map.hpp>
#include <xtrack/result.hpp>
#include <xtrack/rig.hpp>

namespace xtrack {

/// Pixels that are connected: their fringe orders are right against each other.
/// @since 0.1
struct PaperComponent {
    std::uint16_t id = 0;  ///< value in components(): 1, 2, ...; the most pixels first
    int pixels = 0;
    /// Whole fringes that were added to all of it.
    int order = 0;
    /// More than one order was possible, and nothing said which: it may lie whole fringes off.
    bool ambiguous = false;
};

/// Fringe images in, depth out, as the 2012 paper does it: phase from the plain steps of one
/// period, the fringe order from the picture itself, outward from what is clearest
/// (quality-guided unwrapping in space). Colour fringes and Gray codes are not used; of several
/// periods the shortest is, and frames of other patterns are passed over.
///
/// Surfaces that nothing connects leave open by how many whole fringes they lie apart. What stands
/// still keeps its place where DecodeSettings::motion is not off, and what moves is before it.
/// Where a shadow of the projector parts them, the fringe that leaves one edge arrives at the
/// other, which says it. Else a component lies where it was a frame ago. Else, and always within
/// it:
///  - with a rig, where its depths lie in the working volume: the largest component as far away as
///    it can be, others in the middle of that. depth() is in millimetres.
///  - without one, nearest to the background; depth() is relative (`metric` false): the phase less
///    that of the background, kMmPerProjectorPx for each projector pixel, before kBackground_mm.
///    The background is what learn_background() was shown; until then, the plane in which the
///    largest surface of the first decode lies along the image's border. Which way
///    is in front is what shadows say; until enough were seen, what stands out most is.
///
/// push() allocates nothing, except while no background is known without a rig.
/// @thread one at a time
/// @ownership holds the FramePtrs of its window, at most eight a pattern; copies no pixels
/// @since 0.1
class PaperDecoder {
 public:
    /// @param image width and height of the frames that will be pushed, px
    /// @param rig null, or without a projector: relative depth. Copied.
    /// @errors unsupported: no sines, or linear ramps;
    ///         invalid_argument: settings out of range, an image that is_image_size() does not hold
    ///         for, singular geometry, a projector or camera size that disagrees; io: no memory
    /// @thread any
    [[nodiscard]] static Result<PaperDecoder> create(const PatternSequence& patterns, Size image,
                                                     const DecodeSettings& settings = {},
                                                     const Rig* rig = nullptr);
    PaperDecoder(PaperDecoder&&) noexcept;
    PaperDecoder& operator=(PaperDecoder&&) noexcept;
    ~PaperDecoder();

    /// Takes one frame; on hold it is rejected. Equal stamps are allowed.
    DecodeStatus push(const FramePtr& frame) noexcept;

    /// Decodes the images of the last decode once more, under the settings of now.
    /// @return need_more where there was none yet
    DecodeStatus decode_again() noexcept;

    /// Settings of the next decode; a change of `mode` begins with the next frame. On hold the
    /// images at hand are decoded again at once.
    /// @errors invalid_argument; io: no memory; nothing changed
    Result<void> set_settings(const DecodeSettings& settings);
    [[nodiscard]] const DecodeSettings& settings() const noexcept;
    /// Whether a setting means anything to this decoder, with its patterns and as it is set.
    [[nodiscard]] bool uses(const DecodeField& field) const noexcept;

    /// Takes the last decode for the empty scene: relative depth is then before it, until this is
    /// called again. Takes tens of milliseconds; allocates.
    /// @errors unsupported: nothing was decoded yet; io: no memory
    Result<void> learn_background();
    /// Forgets the background: the next decode shows a plane again.
    void forget_background() noexcept;

    /// The newest depth, of the stamp in the middle of its images, or of the newest where motion is
    /// followed; no depth in any pixel before the
    /// first depth_ready. All results are valid until the next call that is not const.
    [[nodiscard]] const DepthFrame& depth() const noexcept;
    /// The depth as points of the camera frame, mm: rows of x, y, z for every pixel, NaN where
    /// there is no depth. Without a rig of a camera whose image is as wide as it is far. Empty
    /// without DecodeSettings::keep_maps.
    [[nodiscard]] ImageView<const float> points_mm() const noexcept;
    /// Wrapped phase and modulation.
    [[nodiscard]] const PhaseMap& phase() const noexcept;
    /// With a rig: the projector phase with all its whole turns, rad. Without: what it is off the
    /// background's. NaN where masked.
    [[nodiscard]] const Image<float>& unwrapped_rad() const noexcept;
    /// Id of each pixel's component, 0 = none, kStill = it stands still; and what is known of them.
    [[nodiscard]] const Image<std::uint16_t>& component() const noexcept;
    [[nodiscard]] std::span<const PaperComponent> components() const noexcept;

    /// Forgets all frames, and where components were; settings and background stay.
    void reset() noexcept;

    /// Frames until the first depth when none is lost.
    [[nodiscard]] int frames_needed() const noexcept;

    /// In component(): what stands still is of none.
    static constexpr std::uint16_t kStill = 65535;
    /// Where relative depth has its background, and how much nearer a projector pixel is.
    static constexpr double kBackground_mm = 1000.0;
    static constexpr double kMmPerProjectorPx = 2.0;

 private:
    struct Impl;
    explicit PaperDecoder(std::unique_ptr<Impl> impl) noexcept;
    std::unique_ptr<Impl> impl_;
};

}  // namespace xtrack
