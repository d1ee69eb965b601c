// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <xtrack/gesture_settings.hpp>
#include <xtrack/method.hpp>
#include <xtrack/sim.hpp>

namespace xtrack::tools {

/// True for `sim` and `sim:ANYTHING`.
[[nodiscard]] bool is_simulator(const std::string& source);

/// Settings of `sim` or `sim:PRESET`.
/// @return invalid_argument for other sources
[[nodiscard]] Result<SimSettings> preset_of(const std::string& source);

/// What a simulated camera and these gestures ask of a method.
[[nodiscard]] MethodNeeds needs_of(const SimSettings& settings, const GestureSettings& gestures);

/// Tests the colours of a simulated camera, and says of `needs` what came out; a grey one has none.
/// @return the result in words; empty: there was nothing to test
[[nodiscard]] std::string test_colours_of(const SimSettings& settings, MethodNeeds& needs);

/// What a simulated projector was made to show.
struct ShownMethod {
    MethodVerdict verdict;
    std::string colours;  ///< what the colour self-test said; empty: none was made
};

/// Makes a simulated projector show a method's patterns. A method that is asked for by its name is
/// given a camera that sees colour where it needs one.
/// @param name a method's, or `auto`, which tests a colour camera first
/// @return why it was chosen; invalid_argument for a name that is none; unsupported where the
///         method cannot carry the gestures on this camera
[[nodiscard]] Result<ShownMethod> show_method(const std::string& name,
                                              const GestureSettings& gestures,
                                              SimSettings& settings);

}  // namespace xtrack::tools
