// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <xtrack/labels.hpp>
#include <xtrack/scoring.hpp>

#include "tools/eval/player.hpp"
#include "tools/eval/stills.hpp"

namespace xtrack::tools {

/// A recording's events beside its labels.
struct EvaluatedRecording {
    std::string name;  ///< of its folder
    Stamp begin;       ///< of the first hands
    double seconds = 0.0;
    std::vector<GestureLabel> labels;
    std::vector<JudgedEvent> events;
    std::vector<std::string> causes;  ///< of each event; empty where it is not false
    GestureScorer scorer;             ///< of this recording alone
};

/// A recording that could not be read.
struct FailedRecording {
    std::string name;
    Error error;
};

/// All that `eval` has to say.
struct Evaluation {
    std::vector<EvaluatedRecording> recordings;
    std::vector<EvaluatedStills> stills;
    std::vector<FailedRecording> failed;
    GestureScorer all;
};

/// The last part of a path, with or without a slash behind it.
[[nodiscard]] std::string name_of_folder(const std::string& folder);

/// labels.csv of a folder; none where there is no such file.
[[nodiscard]] Result<std::vector<GestureLabel>> labels_of(const std::string& folder);

/// @errors as recognise()
[[nodiscard]] Result<EvaluatedRecording> evaluate(const std::string& folder,
                                                  const PlayedRecording& played,
                                                  std::vector<GestureLabel> labels,
                                                  const GestureSettings& settings);

/// For people: every event, a row a recording, a row a gesture.
void print_table(const Evaluation& evaluation);
/// One JSON object.
void print_json(const Evaluation& evaluation);

}  // namespace xtrack::tools
