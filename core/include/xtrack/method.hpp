// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <xtrack/pattern.hpp>
#include <xtrack/result.hpp>
#include <xtrack/rig.hpp>

namespace xtrack {

/// Ways to put depth into light, by the names that the command line uses.
/// @since 0.1
enum class Method {
    paper,       ///< three steps of a short period, unwrapped in space: the 2012 paper's
    grey,        ///< three steps of one period that is unique in the working volume
    rgb,         ///< two colour patterns in turn: a coarse one orders a fine one
    rgb_static,  ///< one colour pattern that never changes
    dual,        ///< three steps of a coarse and of a fine period
    triple,      ///< the same of three periods
    gray_code,   ///< black and white stripes alone
    gray_phase,  ///< the same, and three steps within a stripe
    four_step,   ///< four steps of one period that is unique in the working volume
    ftp,         ///< one grey pattern that never changes; relative depth
    ramp,        ///< one linear ramp, white and black: for comparison
    ramp_four,   ///< the same, and four ramps side by side
};

/// What can be said of a method before any light.
/// @since 0.1
struct MethodInfo {
    Method method = Method::paper;
    const char* name = "";     ///< as on the command line: `gray-code`
    const char* summary = "";  ///< one line
    bool colour = false;       ///< needs a colour camera
    bool changes = true;       ///< false: the pattern never changes, nothing flickers
    /// False: relative depth, unless the order comes from elsewhere. With a rig it is in mm all the
    /// same, but may lie whole fringes off.
    bool metric = true;
    int images = 0;  ///< camera images that one depth image is made of
    /// How far a hand may move from one pattern to the next before more than 5 % of its pixels are
    /// off by over 20 mm or 15 % are missing; measured on the simulated rig, sideways
    /// (docs/measurements/depth.md), of one image as of the colour pair. 0: the hand must rest.
    double motion_mm = 0.0;
};

/// All methods, in the order of the enum.
/// @thread any @ownership static
/// @since 0.1
[[nodiscard]] std::span<const MethodInfo> methods() noexcept;
[[nodiscard]] const MethodInfo& info(Method method) noexcept;
/// @return nothing for names that are none
[[nodiscard]] std::optional<Method> method_of(std::string_view name) noexcept;

/// The patterns of a method for a rig: periods follow from its projector and working volume.
/// @return invalid_argument where the rig lacks what the method needs (a projector, a working
///         volume), or the axis cannot measure depth
/// @thread any
/// @since 0.1
[[nodiscard]] Result<PatternSequence> method_sequence(Method method, const Rig& rig, Axis axis);

/// What a LightCalibrator wants to see: flats of equal steps from black to white, then the patterns
/// of `dual` (where on the projector each pixel looks) and of `rgb`.
/// @param levels flats, 9 to 256; 16, 18, 52 and 256 are shown exactly in 8 bits
/// @thread any
/// @since 0.1
[[nodiscard]] PatternSequence light_sequence(Axis axis, Size projector_size, int levels = 18);

/// What decides between methods.
/// @since 0.1
struct MethodNeeds {
    bool colour = false;     ///< the camera gives colour
    double frame_hz = 60.0;  ///< camera images a second
    /// Camera images for which a pattern must be held: 1 where camera and projector are locked, 2
    /// where they run free.
    int hold_frames = 1;
    /// The camera's colour self-test (works_as_shown()); empty: not made, colour is not
    /// trusted with metric depth but still tried when nothing else will do.
    std::optional<bool> colour_works;
    bool metric = true;        ///< depth must be in mm
    double hand_mmps = 0.0;    ///< the fastest hand that must be followed
    bool static_only = false;  ///< no pattern may change, as kiosks want it
};

/// What speaks for or against one method.
/// @since 0.1
struct MethodVerdict {
    Method method = Method::paper;
    bool possible = false;
    double hand_mmps = 0.0;  ///< the fastest hand that it follows here
    std::string reason;      ///< one clause: why not, or what it can do
};

/// Judges one method.
/// @thread any
/// @since 0.1
[[nodiscard]] MethodVerdict judge(Method method, const MethodNeeds& needs);

/// The method that `auto` stands for: of those that are possible, patterns that never change come
/// first, then the one that follows the fastest hand. Its reason says so.
/// @return unsupported when none is possible; the message names the nearest and what is in its way
/// @thread any
/// @since 0.1
[[nodiscard]] Result<MethodVerdict> choose_method(const MethodNeeds& needs);

}  // namespace xtrack
