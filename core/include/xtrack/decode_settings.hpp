// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

#include <xtrack/result.hpp>

namespace xtrack {

/// How the images of one period are combined into a phase.
/// @since 0.1
enum class PhaseTaps {
    /// three_plus_two where the sequence is one cycle of three equal steps, else least_squares
    automatic,
    least_squares,   ///< the newest image of each pattern, any number and phases
    three_plus_one,  ///< four images of a cycle: linear detuning removed
    three_plus_two,  ///< five images of a cycle: drift of the background removed as well
    four_plus_one,   ///< five images of a cycle of four (Hariharan)
};

/// Where the fringe order comes from.
/// @since 0.1
enum class OrderSource {
    automatic,    ///< Gray code, coarser periods, or a period unique in the working volume
    depth_image,  ///< DepthDecoder::set_order_depth(): a depth known from elsewhere
    none,         ///< none: phase and modulation only, no depth; the rig is not read
};

/// What is done about things that move while the projector goes through its patterns. All but `off`
/// need a second image of every pattern, so they begin with the second cycle, and do nothing in
/// sequences with a Gray code.
/// @since 0.1
enum class MotionHandling {
    /// Nothing: static scenes, scanning. Depth is that of the centre of the window.
    off,
    /// Pixels whose images of the same pattern disagree are masked.
    mask,
    /// The images of the largest moving thing are laid on top of each other, in whole pixels, with
    /// taps corrected for the phase that the move adds; what still disagrees is masked. Depth is
    /// that of the newest frame.
    follow,
};

/// Which images a decode of the PaperDecoder is made of: the three modes of the paper.
/// @since 0.1
enum class CaptureMode {
    sliding,  ///< "Default": every image gives a decode, from the newest of each pattern
    burst,    ///< only whole sets: each decode is of images that no other decode has used
    hold,     ///< "On Hold": takes no images; the last set again, under new settings
};

/// Settings of both decoders; which of them a field is for, decode_fields() says. Defaults suit a
/// hand before a projector at 60 images a second. All may change while a decoder runs.
/// @since 0.1
struct DecodeSettings {
    /// Fringe amplitude B below which a pixel is masked, grey levels, 0 ... 127. Phase noise is
    /// sigma_I / B, so at 6 levels and 1.5 levels of camera noise it is 0.2 rad.
    double min_modulation = 6.0;
    /// Mask pixels that reach 255 in any image of a phase: clipped sines have wrong phases.
    bool mask_saturated = true;
    PhaseTaps taps = PhaseTaps::automatic;
    OrderSource order = OrderSource::automatic;
    /// Largest distance between a phase's coordinate and the one that gives its order, in shares of
    /// the period, 0.05 ... 0.5. 0.5 accepts all; less masks pixels whose order is a guess.
    double order_tolerance = 0.5;
    /// Share of white - black around its threshold where a Gray code bit is uncertain, 0 ... 0.45.
    double gray_edge_guard = 0.2;
    MotionHandling motion = MotionHandling::follow;
    /// Two images of the same pattern, one cycle apart, may differ by this much where something
    /// moved, in shares of the fringe amplitude, 0.05 ... 10; more is masked.
    double motion_tolerance = 0.6;
    /// Largest move from one image of a pattern to the next, camera px, 8 ... 400. Its square is
    /// the cost of the search.
    int max_motion_px = 120;
    /// The camera's noise, for DepthDecoder::sigma_mm(): rms where no light falls, grey levels, 0
    /// ... 20; quantisation alone is 0.29.
    double read_noise_levels = 0.5;
    /// Electrons that make a grey level, 1 ... 1e5: the variance of shot noise is the grey value
    /// over it. Webcams have 20 to 80.
    double electrons_per_level = 50.0;
    /// Keep phase, modulation, coordinate, average and sigma of each depth, or the PaperDecoder's
    /// points; costs memory traffic.
    bool keep_maps = false;
    /// Threads that share the rows of an image, 1 ... 16, the one that pushes included. Results are
    /// the same, bit by bit. Waking them costs about 0.2 ms: for images of 1280x720 and more.
    int threads = 1;
    CaptureMode mode = CaptureMode::sliding;
    /// Unwrapping in space: steps between neighbours that deviate by more from those beside them do
    /// not connect, rad, 0.1 ... 3.1.
    double step_limit_rad = 2.0;
    /// Share of the contact of two surfaces that must agree before they are joined, 0 ... 1.
    double min_support = 0.5;
    /// Surfaces of fewer pixels are masked, 1 ... kMaxImagePixels.
    int min_component_px = 64;

    friend bool operator==(const DecodeSettings&, const DecodeSettings&) = default;
};

/// Whom a field of DecodeSettings means something to.
/// @since 0.1
enum class FieldUse {
    both,
    pattern,  ///< DepthDecoder
    paper,    ///< PaperDecoder
    phases,   ///< DepthDecoder, and a PaperDecoder that takes its phases from one: of colours, of
              ///< one grey image, of three steps whose motion is followed
};

/// One field of DecodeSettings, for whatever lists, shows or changes settings by name: command
/// line, viewer, bindings.
/// @since 0.1
struct DecodeField {
    const char* name = "";     ///< as in the struct
    const char* unit = "";     ///< "" for shares, switches and choices
    const char* summary = "";  ///< one line
    double least = 0.0;
    double most = 1.0;
    bool whole = false;                    ///< whole numbers only
    std::span<const char* const> choices;  ///< names of the values 0, 1 ...; empty: a number
    double (*get)(const DecodeSettings&) = nullptr;
    void (*set)(DecodeSettings&, double) = nullptr;
    FieldUse use = FieldUse::both;

    [[nodiscard]] double standard() const { return get(DecodeSettings{}); }
};

/// All fields, in the struct's order.
/// @thread any @ownership static
/// @since 0.1
[[nodiscard]] std::span<const DecodeField> decode_fields() noexcept;

/// The value of a field as it is written: a number, or a choice's name.
/// @thread any
/// @since 0.1
[[nodiscard]] std::string text_of(const DecodeField& field, const DecodeSettings& settings);

/// Sets a field by its name; nothing changes on an Error.
/// @param text a number with a point, or a choice's name
/// @return invalid_argument that names the field and what it takes
/// @thread any
/// @since 0.1
[[nodiscard]] Result<void> set_field(DecodeSettings& settings, std::string_view name,
                                     std::string_view text);

/// @return invalid_argument that names the first setting out of its documented range
/// @thread any
/// @since 0.1
[[nodiscard]] Result<void> validate(const DecodeSettings& settings);

}  // namespace xtrack
