// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <xtrack/gesture_settings.hpp>
#include <xtrack/scoring.hpp>

#include "tools/eval/evaluation.hpp"

namespace xtrack::tools {

/// One value of the setting that is swept, and what became of it in all recordings.
struct SweepPoint {
    double value = 0.0;
    GestureSettings settings;
    GestureScorer scorer;
};

/// A gesture setting through some of its values.
struct Sweep {
    std::string setting;
    std::vector<SweepPoint> points;
    std::vector<FailedRecording> failed;
};

/// @param text `NAME=FROM:TO:STEPS`, so many values with both ends, or `NAME=a,b,c`
/// @param settings all others
/// @errors invalid_argument: neither of these, a name that is none, a value out of its range or at
///         odds with the others
[[nodiscard]] Result<Sweep> parse_sweep(const std::string& text, const GestureSettings& settings);

/// A row a value.
void print_table(const Sweep& sweep);
/// One JSON object.
void print_json(const Sweep& sweep);

}  // namespace xtrack::tools
