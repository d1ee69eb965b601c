// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include <xtrack/decode_settings.hpp>
#include <xtrack/depth.hpp>
#include <xtrack/frame.hpp>
#include <xtrack/pattern.hpp>
#include <xtrack/phase_map.hpp>
#include <xtrack/result.hpp>
#include <xtrack/rig.hpp>

namespace xtrack {

/// What a pushed frame led to.
/// @since 0.1
enum class DecodeState {
    need_more,    ///< taken, but no new depth: not every pattern has been seen yet, or it is the
                  ///< coarse image of a colour sequence
    depth_ready,  ///< taken; depth() is new
    rejected,     ///< not taken; `reason` says why. depth() is as before.
};

/// Why a frame was not taken.
/// @since 0.1
enum class RejectReason {
    none,
    damaged,               ///< no frame, or its status says so
    wrong_size,            ///< not the size the decoder was made for
    unknown_pattern,       ///< nobody knows which pattern it saw
    pattern_out_of_range,  ///< its pattern index is not in the sequence
    no_colour,             ///< a grey image of a colour pattern
    time_backwards,        ///< its stamp is before that of the frame pushed last
    on_hold,               ///< the decoder was told to take none (PaperDecoder)
};

/// One sentence for logs. Static storage.
/// @thread any
/// @since 0.1
[[nodiscard]] const char* describe(RejectReason reason) noexcept;

/// What push() says of a frame.
/// @since 0.1
struct DecodeStatus {
    DecodeState state = DecodeState::need_more;
    RejectReason reason = RejectReason::none;
};

/// Fringe images in, depth images out: decode, unwrap and triangulate, a few rows at a time.
///
/// A sliding window: once every pattern has been seen, each further frame gives a depth image from
/// the newest image of every pattern, wherever in the sequence that is; lost frames are bridged by
/// older ones. Rows outside a frame's clean rows use the pattern's image before, or are masked.
/// The depth image's stamp and sequence are those of the frame it is registered to: the newest
/// where motion is followed (DecodeSettings), else the centre of the window that gave its phase.
///
/// What is used of a sequence: sines by period, from the longest (three or more phases each, or one
/// colour pattern with its phases in red, green and blue); a Gray code with white and black images
/// or inverted bits; other flat patterns are passed over. Where the projector's response or
/// gamma is known, the phase error it causes is subtracted: a bent sine has harmonics that depend
/// on the bend alone, so the error is a function of the phase, whatever the skin's shade and the
/// ambient light.
///
/// Colour fringes give a phase with every image of the shortest period, and no motion tears it:
/// a depth image comes with each such image, other colour periods only order it. What surfaces do
/// to the colours is learnt while it runs; Rig::camera_from_projector_rgb undoes what camera and
/// projector do.
///
/// Where a pattern is held for some camera frames, the clean rows of two of them are averaged, and
/// motion is measured from one frame to the next.
/// @thread one at a time
/// @ownership holds the FramePtrs of the window, at most two a pattern, four where patterns are
///            held for more than one frame; copies no pixels
/// @since 0.1
class DepthDecoder {
 public:
    /// @param image width and height of the frames that will be pushed, px
    /// @return unsupported for sequences this decoder has no method for (colour fringes, a period
    ///         whose order nothing gives, a Gray code alone where no order is wanted);
    ///         invalid_argument for settings out of range, an image that is_image_size() does not
    ///         hold for, singular geometry, a rig without projector, a projector size that
    ///         disagrees with the pattern; io where memory runs out
    [[nodiscard]] static Result<DepthDecoder> create(const Rig& rig,
                                                     const PatternSequence& patterns, Size image,
                                                     const DecodeSettings& settings);

    DepthDecoder(DepthDecoder&&) noexcept;
    DepthDecoder& operator=(DepthDecoder&&) noexcept;
    ~DepthDecoder();

    /// Takes one frame. Equal stamps are allowed. No heap allocation.
    DecodeStatus push(const FramePtr& frame) noexcept;

    /// Decodes the images at hand once more, under the settings of now.
    /// @return need_more where there was no decode yet, or an image came since that gave none
    DecodeStatus decode_again() noexcept;

    /// Settings of the next decode; results stay those of the last one until then. Images at hand
    /// stay, and what was learnt of colours; a change of `taps`, `order`, `motion`,
    /// `max_motion_px`, `keep_maps` or `threads` allocates, and forgets how things move.
    /// @return as create(), and nothing changed
    Result<void> set_settings(const DecodeSettings& settings);
    [[nodiscard]] const DecodeSettings& settings() const noexcept;
    /// Whether a setting means anything to a DepthDecoder.
    [[nodiscard]] static bool uses(const DecodeField& field) noexcept;

    /// The newest depth image; no depth in any pixel before the first depth_ready. Valid until the
    /// next decode.
    [[nodiscard]] const DepthFrame& depth() const noexcept;

    /// Gives OrderSource::depth_image its depth: pixels of the same camera, 0 = unknown there.
    /// @param depth copied; @return invalid_argument on another size or a unit that is not positive
    Result<void> set_order_depth(ImageView<const std::uint16_t> depth, double unit_mm);

    /// Phase and modulation of the shortest period, set by the first depth_ready; empty without
    /// DecodeSettings::keep_maps, and the phase also for a Gray code without sines. Valid until the
    /// next decode, as are the two below.
    [[nodiscard]] const PhaseMap& phase() const noexcept;
    /// Absolute coordinate along the coded axis, projector px (as shown, lens included), NaN where
    /// there is none; empty without keep_maps or without an order.
    [[nodiscard]] const Image<float>& coordinate_px() const noexcept;
    /// The scene without its fringes: mean of the images of the shortest period (or of white and
    /// black, or of a bit and its inverse), grey levels; empty without keep_maps.
    [[nodiscard]] const Image<float>& average() const noexcept;

    /// Standard deviation of each depth that the camera's noise causes, mm, 0 where there is none:
    /// sigma_Z = sigma_phi (P / 2 pi) / |dx/dZ|, with sigma_phi from modulation, brightness and
    /// DecodeSettings' noise. What moves, or takes a wrong order, errs by more. Empty without
    /// keep_maps or without an order.
    [[nodiscard]] const Image<float>& sigma_mm() const noexcept;

    /// Forgets all frames, as after a cut; settings and the order depth stay.
    void reset() noexcept;

    /// Frames until the first depth when none is lost.
    [[nodiscard]] int frames_needed() const noexcept;
    /// Instruction set of the kernels on this CPU, for reports.
    [[nodiscard]] static const char* instruction_set() noexcept;

 private:
    struct Impl;
    explicit DepthDecoder(std::unique_ptr<Impl> impl) noexcept;
    std::unique_ptr<Impl> impl_;
};

}  // namespace xtrack
