// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <xtrack/gesture_settings.hpp>
#include <xtrack/method.hpp>
#include <xtrack/sim.hpp>

namespace xtrack::tools {

/// Settings of `sim` or `sim:PRESET`.
/// @return invalid_argument for other sources
[[nodiscard]] Result<SimSettings> preset_of(const std::string& source);

/// What a simulated camera and these gestures ask of a method.
[[nodiscard]] MethodNeeds needs_of(const SimSettings& settings, const GestureSettings& gestures);

/// Makes a simulated projector show a method's patterns. A method that is asked for by its name is
/// given a camera that sees colour where it needs one.
/// @param name a method's, or `auto`
/// @return why it was chosen; invalid_argument for a name that is none; unsupported where the
///         method cannot carry the gestures on this camera
[[nodiscard]] Result<MethodVerdict> show_method(const std::string& name,
                                                const GestureSettings& gestures,
                                                SimSettings& settings);

}  // namespace xtrack::tools
