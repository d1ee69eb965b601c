// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>

#include <xtrack/frame.hpp>
#include <xtrack/geometry.hpp>
#include <xtrack/pattern.hpp>
#include <xtrack/result.hpp>
#include <xtrack/rig.hpp>

namespace xtrack {

/// What a ramp of grey levels says of the projector, seen through a camera that is taken to be
/// linear.
/// @since 0.1
struct MeasuredResponse {
    ProjectorResponse response;  ///< a colour camera's freed of crosstalk
    /// The power nearest to each colour's curve: red, green, blue; for words.
    std::array<double, 3> gamma{1.0, 1.0, 1.0};
    double spread = 0.0;     ///< of single pixels about the curve, rms share of full light
    std::size_t pixels = 0;  ///< that were measured
};

/// Whether a camera tells the projector's colours apart.
/// @since 0.1
struct ColourSelfTest {
    bool passed = false;
    std::string reason;  ///< one clause: what is wrong, or how good it is
    /// As Rig has it. What a wall does to the colours is part of it: use a white or grey one.
    Mat3d camera_from_projector_rgb = Mat3d::Identity();
    double condition = 0.0;  ///< largest through smallest singular value, of rows that sum to one
    double residual = 0.0;   ///< of the images about what the matrix says, rms share of full light
    /// What the camera's gain differed between the white and the colour images, worst channel;
    /// 0: it was locked
    double gain_change = 0.0;
    /// That the fringes of the shortest colour period keep against those of the longest: blur, and
    /// coarse colours, take it
    double contrast = 1.0;
    double phase_error_rad = 0.0;  ///< of the shortest colour period, rms, noise included
    /// What the projector's response adds to it, rms, unless pictures are compensated by it
    /// (GammaCompensation): what surfaces do to colours is then mistaken, and more is lost
    double bend_rad = 0.0;
    /// phase_error_rad in depth 600 mm away (or where the working volume is nearest to that);
    /// absent: no rig
    std::optional<double> depth_error_mm;
    std::size_t pixels = 0;  ///< that were measured and agree
};

/// Bends from which colour fringes must be compensated, rad: a pixel of a period of 96.
inline constexpr double kMostBend_rad = 0.05;

/// True where colour fringes will do as they were shown: the test passed, and its response needs no
/// compensation.
/// @thread any
/// @since 0.1
[[nodiscard]] inline bool works_as_shown(const ColourSelfTest& test) noexcept {
    return test.passed && test.bend_rad <= kMostBend_rad;
}

/// What is known of the light between a projector and a camera.
/// @since 0.1
struct LightCalibration {
    std::optional<MeasuredResponse> response;  ///< absent: no ramp was shown
    std::optional<ColourSelfTest> colour;      ///< absent: no colour patterns, or a grey camera
};

/// Measures the projector's response and the camera's colours from images of light_sequence() on a
/// wall at rest, exposure, gain and white balance locked.
///
/// Black and white take ambient light, albedo and vignetting out of every pixel, so what is left of
/// a flat is a share of full light. The grey fringes say which projector coordinate a pixel sees,
/// and with it the values of the colour fringes there; the rows of the crosstalk matrix follow by
/// least squares, in turn with the responses of the single colours.
///
/// Without flats, grey fringes of a projector that is known to be linear give black and white, and
/// the colours are still measured. Those fringes may be grey images: the camera's white is then
/// taken as balanced, which tells its colours from those of the surfaces.
/// @thread one at a time
/// @since 0.1
class LightCalibrator {
 public:
    /// @param sequence what is shown: flats of level 0 and 1 with at least 7 between (or a gamma of
    ///        1 and no flats); for colour also grey sines, whose longest period is as long as the
    ///        coded axis or unique in the rig's working volume, and rgb_sine patterns
    /// @param rig for such orders and for depth_error_mm; absent: not calibrated
    /// @return an Error: the sequence is not valid or lacks what is needed; the image is no size,
    ///         or not the rig's
    /// @thread any
    [[nodiscard]] static Result<LightCalibrator> create(const PatternSequence& sequence, Size image,
                                                        const std::optional<Rig>& rig = {});
    LightCalibrator(LightCalibrator&&) noexcept;
    LightCalibrator& operator=(LightCalibrator&&) noexcept;
    ~LightCalibrator();

    /// Takes the clean rows of one image; several of a pattern are averaged. Frames that are
    /// damaged or whose pattern nobody knows are passed over.
    /// @return an Error for frames of another size, or of a pattern that the sequence has not
    [[nodiscard]] Result<void> add(const Frame& frame);

    /// @return unsupported where the images do not tell: a pattern was not seen, it is too dark or
    ///         clipped, a brighter level is darker in the image. Colours that are not good enough
    ///         are no error: ColourSelfTest says so.
    [[nodiscard]] Result<LightCalibration> finish() const;

 private:
    class Impl;
    explicit LightCalibrator(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace xtrack
