// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <CLI/App.hpp>
#include <xtrack/decode_settings.hpp>
#include <xtrack/gesture_settings.hpp>
#include <xtrack/session.hpp>

namespace xtrack::tools {

/// `--set NAME=VALUE`, as often as needed; its help lists every setting with unit, range and
/// standard value.
/// @param uses which of them the command may look at
void add_settings_option(CLI::App& command, std::vector<std::string>& changes,
                         const std::function<bool(const DecodeField&)>& uses);

/// @errors invalid_argument: what is no NAME=VALUE, a name that is none, a value out of range
[[nodiscard]] Result<void> apply_settings(const std::vector<std::string>& changes,
                                          DecodeSettings& settings);

/// Whether all of them mean something to what decodes.
/// @param method Session::method(), or how a command decodes
/// @param uses whether the decoder at hand looks at a field
/// @errors invalid_argument: one that would do nothing
[[nodiscard]] Result<void> check_settings(const std::vector<std::string>& changes,
                                          DecodeMethod method,
                                          const std::function<bool(const DecodeField&)>& uses);

/// Whether it changes a setting of the gestures, switches included.
[[nodiscard]] bool is_gesture_setting(const std::string& change);

/// `--set NAME=VALUE` of gestures; its help lists every threshold with range and standard value.
void add_gesture_settings_option(CLI::App& command, std::vector<std::string>& changes);

/// @errors invalid_argument: as apply_settings(), and values that contradict each other
[[nodiscard]] Result<void> apply_gesture_settings(const std::vector<std::string>& changes,
                                                  GestureSettings& settings);

}  // namespace xtrack::tools
