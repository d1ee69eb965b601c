// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>
#include <xtrack/scoring.hpp>

#include "tools/eval/evaluation.hpp"

namespace xtrack::tools {

// Figures as the tables of eval show them.

/// `0.94 [0.84, 0.98]`
[[nodiscard]] std::string to_text(const Estimate& e);
/// `-` where it is a share of nothing.
[[nodiscard]] std::string to_text(const Estimate& e, int of);
/// Median and 95th percentile, ms; `-` of none.
[[nodiscard]] std::string to_text(const std::vector<double>& ms);
/// `-` where nothing was labelled.
[[nodiscard]] std::string jaccard_text(const GestureScore& s);

// Figures as eval's JSON holds them.

[[nodiscard]] nlohmann::json to_json(const Estimate& e);
[[nodiscard]] nlohmann::json to_json(const GestureScore& s);
/// Events of streams without labels.
[[nodiscard]] nlohmann::json unlabelled_json(const GestureScorer& scorer);
[[nodiscard]] nlohmann::json to_json(const std::vector<FailedRecording>& failed);

/// Prints one object. Names of folders need not be UTF-8, of which JSON is made.
void print(const nlohmann::json& out);

}  // namespace xtrack::tools
