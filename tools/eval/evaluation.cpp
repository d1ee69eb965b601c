// SPDX-License-Identifier: Apache-2.0
#include "tools/eval/evaluation.hpp"

#include <filesystem>
#include <utility>

namespace xtrack::tools {

namespace {

namespace fs = std::filesystem;

/// What part of a gesture a false event was taken from, where a label's window holds the way there
/// and back too: before the event that is right, after it, or neither can be said.
std::string cause_of(const JudgedEvent& event, const std::vector<JudgedEvent>& all,
                     const std::vector<GestureLabel>& labels) {
    if (!is_false(event.verdict)) {
        return {};
    }
    const auto inside = [](const JudgedEvent& e, const GestureLabel& label) {
        return e.event.sensor >= label.start && e.event.sensor <= label.end;
    };
    for (const GestureLabel& label : labels) {
        for (const JudgedEvent& right : all) {
            if (right.verdict == Verdict::correct && inside(event, label) && inside(right, label)) {
                return event.event.sensor < right.event.sensor ? "approach" : "return";
            }
        }
    }
    return "other";
}

}  // namespace

std::string name_of_folder(const std::string& folder) {
    const fs::path path = fs::path(folder).lexically_normal();
    return path.filename().empty() ? path.parent_path().filename().string()
                                   : path.filename().string();
}

Result<std::vector<GestureLabel>> labels_of(const std::string& folder) {
    const fs::path file = fs::path(folder) / "labels.csv";
    // A link to nothing is an error, and not a recording without labels.
    if (!fs::exists(fs::symlink_status(file))) {
        return std::vector<GestureLabel>{};
    }
    return read_labels(file);
}

Result<EvaluatedRecording> evaluate(const std::string& folder, const PlayedRecording& played,
                                    std::vector<GestureLabel> labels,
                                    const GestureSettings& settings) {
    const auto events = recognise(played, settings);
    if (!events) {
        return events.error();
    }
    EvaluatedRecording r;
    r.scorer = GestureScorer(settings);
    r.name = name_of_folder(folder);
    r.begin = played.begin;
    r.seconds = to_seconds(played.length);
    r.labels = std::move(labels);
    r.events = r.scorer.add(*events, r.labels, played.length);
    for (const JudgedEvent& e : r.events) {
        r.causes.push_back(cause_of(e, r.events, r.labels));
    }
    return r;
}

}  // namespace xtrack::tools
