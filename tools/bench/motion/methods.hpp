// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <string_view>

#include <xtrack/decode_settings.hpp>
#include <xtrack/pattern.hpp>
#include <xtrack/result.hpp>
#include <xtrack/rig.hpp>

namespace xtrack::tools::bench {

/// A figure of the reference that it does not give.
inline constexpr double kNoFigure = std::numeric_limits<double>::quiet_NaN();

/// RMS, share off and share missing of a hand at one speed, from the numpy simulation that the
/// method was chosen by.
struct ReferenceCell {
    double rms_mm = kNoFigure;
    double off_percent = kNoFigure;
    double missing_percent = kNoFigure;
};

/// Moves from one frame to the next, along the axis that the fringes change along, mm.
inline constexpr std::array<double, 8> kSideways_mm{0.0, 2.5, 5.0, 8.0, 10.0, 17.0, 20.0, 33.0};
/// Moves toward the camera, mm.
inline constexpr std::array<double, 2> kToward_mm{5.0, 10.0};

/// A way to measure something that moves: what is projected, and how it is decoded.
struct MotionMethod {
    std::string_view name;  ///< for programs, such as `grey`
    std::string_view says;  ///< for people
    PatternSequence patterns;
    bool colour = false;  ///< wants a colour camera
    DecodeSettings settings;
    std::array<ReferenceCell, kSideways_mm.size()> sideways{};
    std::array<ReferenceCell, kToward_mm.size()> toward{};
};

/// What the project wants of a method: at most so much of the hand off at a speed.
struct MotionTarget {
    std::string_view method;
    double move_mm;  ///< a frame, sideways
    double off_percent;
};
inline constexpr std::array<MotionTarget, 2> kMotionTargets{
    {{"rgb", 10.0, 5.0}, {"grey", 5.0, 5.0}}};

/// All methods, in the order of the reference; those with the same patterns follow each other.
inline constexpr std::size_t kMotionMethods = 8;
[[nodiscard]] Result<std::array<MotionMethod, kMotionMethods>> motion_methods(const Rig& rig);

}  // namespace xtrack::tools::bench
