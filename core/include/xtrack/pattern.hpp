// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <xtrack/frame.hpp>
#include <xtrack/geometry.hpp>
#include <xtrack/image.hpp>
#include <xtrack/result.hpp>
#include <xtrack/rig.hpp>

namespace xtrack {

/// The projector axis that a pattern codes: intensities change along it only.
enum class Axis { x, y };

enum class PatternKind {
    sine,
    rgb_sine,
    gray_code,
    flat,
    ramp,  ///< from dark to light within each period, then dark again
};

/// What the projector shows in one refresh. Intensities are 0..1 of full light, before gamma;
/// x is the projector pixel index along the coded axis, 0 at the centre of the first pixel.
/// Fields that a kind does not name are ignored for it.
/// @since 0.1
struct Pattern {
    PatternKind kind = PatternKind::flat;
    /// sine, rgb_sine: I(x) = 0.5 + 0.5 cos(2 pi x / period_px + phase_rad)
    double period_px = 0.0;
    /// ramp: I(x) = x / period_px - floor(x / period_px)
    /// sine: [0] alone. rgb_sine: red, green, blue.
    std::array<double, 3> phase_rad{};
    /// gray_code: bit 0 is the most significant of `bits`; cell = floor((x + offset_px) / cell_px)
    int bit = 0;
    int bits = 0;
    double cell_px = 0.0;
    double offset_px = 0.0;
    bool inverted = false;
    /// flat: one level everywhere
    double level = 0.0;

    friend bool operator==(const Pattern&, const Pattern&) = default;
};

/// Steps that each curve of a ProjectorResponse may have.
inline constexpr std::size_t kMinResponseSteps = 5;
inline constexpr std::size_t kMaxResponseSteps = 256;

/// What a projector makes of the values it is handed: light at equal steps of the value from 0 to
/// 1, straight between them. Each curve begins with 0, ends with 1 and never falls; all have as
/// many steps. A grey camera sees one mix of the colours, which then stands for all three.
/// @since 0.1
struct ProjectorResponse {
    std::array<std::vector<double>, 3> light;  ///< of red, green, blue; shares of full light

    friend bool operator==(const ProjectorResponse&, const ProjectorResponse&) = default;
};

/// The patterns a projector shows, in order, again and again.
/// @since 0.1
struct PatternSequence {
    Axis axis = Axis::x;
    Size projector_size;
    /// light = value^gamma of the projector; absent = unknown, 1 = linear
    std::optional<double> gamma;
    /// Its measured response; where it is known gamma is passed over.
    std::optional<ProjectorResponse> response;
    std::vector<Pattern> patterns;

    /// Projector pixels along the coded axis.
    [[nodiscard]] int coded_length_px() const noexcept {
        return axis == Axis::x ? projector_size.width : projector_size.height;
    }
    friend bool operator==(const PatternSequence&, const PatternSequence&) = default;
};

/// Bounds of what validate() accepts.
inline constexpr std::size_t kMaxPatterns = 1024;
inline constexpr int kMaxGrayBits = 16;

/// Checks every field that the kinds in use name: sizes 1..kMaxImageSide_px, periods of at least
/// two pixels (fewer cannot be shown), bits 1..kMaxGrayBits, levels 0..1, nothing NaN or infinite,
/// 1..kMaxPatterns patterns, a response that is one.
/// @return an Error that names the field (`sequence[3].period_px`) and the mend
/// @thread any
/// @since 0.1
[[nodiscard]] Result<void> validate(const PatternSequence& sequence);

/// Light of a pattern at projector pixel `x_px` of the coded axis, 0..1, before gamma. Gray codes
/// take the integer pixel nearest to `x_px`; cells before the first count as the first.
/// @param channel 0 red, 1 green, 2 blue; only rgb_sine tells them apart
/// @pre a pattern that validate() accepts, channel 0..2
/// @thread any; pure
/// @since 0.1
[[nodiscard]] double intensity(const Pattern& pattern, double x_px, int channel = 0) noexcept;

/// What to do about the projector's response when a pattern becomes pixel values.
/// @since 0.1
enum class GammaCompensation {
    none,           ///< value = light: what a projector set to linear wants, and the plain sequence
    precompensate,  ///< the value whose light it is: the wall then shows the sequence as written
};

/// Draws one pattern as the projector shall be handed it: grey8, or bgr8 (in bytes: blue, green,
/// red) for rgb_sine, and for all where the colours are compensated differently. Sizes `out` to the
/// projector; rounds to the nearest of 256 values.
/// @param index into sequence.patterns
/// @param out keeps its memory from call to call
/// @return the format, or an Error: the sequence is not valid, the index is out of range, or
///         compensation is asked for while neither response nor gamma is known
/// @thread any; allocates only when `out` must grow, and one row's buffer
/// @since 0.1
[[nodiscard]] Result<PixelFormat> render_pattern(const PatternSequence& sequence, int index,
                                                 Image<std::uint8_t>& out,
                                                 GammaCompensation gamma = GammaCompensation::none);

// Common sequences. Phases step by -2 pi / steps: 0, -2 pi / N, -4 pi / N ... None is validated
// here; hand the result to validate() when its arguments come from outside.

/// `steps` sines of one period.
/// @thread any
/// @since 0.1
[[nodiscard]] PatternSequence n_step_sequence(Axis axis, Size projector_size, double period_px,
                                              int steps);

/// Three sines of one period: the least that gives phase (Zhang, Huang 2006).
/// @thread any
/// @since 0.1
[[nodiscard]] PatternSequence three_step_sequence(Axis axis, Size projector_size, double period_px);

/// Three steps of a coarse period, then three of a fine one (2x3): the coarse one orders the fine.
/// @thread any
/// @since 0.1
[[nodiscard]] PatternSequence dual_sequence(Axis axis, Size projector_size, double coarse_period_px,
                                            double fine_period_px);

/// White, black, a Gray code whose cells are one period wide, then three sines of that period.
/// @thread any
/// @since 0.1
[[nodiscard]] PatternSequence gray_code_sequence(Axis axis, Size projector_size, double period_px);

/// One coloured pattern for each period, its three phases in red, green and blue.
/// @thread any
/// @since 0.1
[[nodiscard]] PatternSequence rgb_sequence(Axis axis, Size projector_size,
                                           const std::vector<double>& periods_px);

/// The least period, px, that is unique within the rig's working volume for every camera pixel: the
/// geometric constraint of An, Hyun and Zhang 2016. Lens distortion is left out of it; the 2 %
/// that are added cover that.
/// @return an Error if the rig has no projector or no working volume, if the volume reaches
///         behind the projector, or if the axis lies across the baseline
/// @thread any
/// @since 0.1
[[nodiscard]] Result<double> volume_wide_period_px(const Rig& rig, Axis axis);

}  // namespace xtrack
