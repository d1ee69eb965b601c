// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <utility>

#include <nlohmann/json.hpp>

#include "tools/eval/evaluation.hpp"
#include "tools/eval/figures.hpp"

namespace xtrack::tools {

namespace {

using nlohmann::json;

json text_or_null(const std::string& text) { return text.empty() ? json(nullptr) : json(text); }

json recording_json(const EvaluatedRecording& r) {
    json events = json::array();
    for (std::size_t i = 0; i < r.events.size(); ++i) {
        const JudgedEvent& e = r.events[i];
        events.push_back({{"t_us", e.event.sensor.us()},
                          {"gesture", name_of(e.event)},
                          {"verdict", to_string(e.verdict)},
                          {"cause", text_or_null(r.causes[i])},
                          {"during", text_or_null(e.during)}});
    }
    return {{"name", r.name},
            {"seconds", r.seconds},
            {"labels", r.labels.size()},
            {"events", std::move(events)},
            {"score", to_json(r.scorer.all())}};
}

json stills_json(const EvaluatedStills& s) {
    json out = {{"name", s.name},
                {"with_hand", s.with_hand},
                {"found", s.found},
                {"without_hand", s.without_hand},
                {"none_found", s.none_found},
                {"fingers_counted", s.counted},
                {"fingers_right", s.count_right},
                {"fingers_within_one", s.count_near}};
    if (s.with_hand > 0) {
        out["found_rate"] = to_json(s.found_share());
    }
    if (s.without_hand > 0) {
        out["none_found_rate"] = to_json(s.none_share());
    }
    if (s.counted > 0) {
        out["fingers_right_rate"] = to_json(s.right_share());
        out["fingers_within_one_rate"] = to_json(s.near_share());
    }
    return out;
}

}  // namespace

void print_json(const Evaluation& evaluation) {
    json out;
    out["recordings"] = json::array();
    for (const EvaluatedRecording& r : evaluation.recordings) {
        out["recordings"].push_back(recording_json(r));
    }
    out["stills"] = json::array();
    for (const EvaluatedStills& s : evaluation.stills) {
        out["stills"].push_back(stills_json(s));
    }
    out["failed"] = to_json(evaluation.failed);
    out["gestures"] = json::object();
    for (const auto& [name, s] : evaluation.all.gestures()) {
        out["gestures"][name] = to_json(s);
    }
    out["all"] = to_json(evaluation.all.all());
    out["unlabelled"] = unlabelled_json(evaluation.all);
    print(out);
}

}  // namespace xtrack::tools
