// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tools/eval/evaluation.hpp"

namespace xtrack::tools {

namespace {

using nlohmann::json;

json to_json(const Estimate& e) { return {{"value", e.value}, {"low", e.low}, {"high", e.high}}; }

json to_json(const std::vector<double>& ms) {
    if (ms.empty()) {
        return nullptr;
    }
    return {{"p50", percentile(ms, 0.50)}, {"p95", percentile(ms, 0.95)}};
}

json text_or_null(const std::string& text) { return text.empty() ? json(nullptr) : json(text); }

json to_json(const GestureScore& s) {
    json out = {{"labelled", s.labelled},
                {"correct", s.correct},
                {"false", s.false_events()},
                {"false_without_overlaps", s.false_without_overlaps()},
                {"allowed", s.allowed},
                {"wrong_hand", s.wrong_hand},
                {"cancelled", s.cancelled},
                {"cancelled_in_label", s.cancelled_in_label},
                {"cancelled_without_reason", s.without_reason},
                {"unclosed", s.unclosed},
                {"latency_from_onset_ms", to_json(s.from_onset_ms)},
                {"latency_from_start_ms", to_json(s.from_start_ms)},
                {"latency_from_commit_ms", to_json(s.from_commit_ms)},
                {"latency_from_end_ms", to_json(s.from_end_ms)}};
    if (s.labelled > 0) {
        out["detection_rate"] = to_json(s.detection());
        out["false_per_label"] = to_json(s.false_per_label());
        out["false_per_label_without_overlaps"] = to_json(s.false_per_label_without_overlaps());
        out["jaccard"] = s.jaccard();
    }
    if (s.correct + s.wrong_hand > 0) {
        out["wrong_hand_rate"] = to_json(s.wrong_hands());
    }
    if (s.cancelled > 0) {
        out["right_cancels"] = to_json(s.right_cancels());
    }
    return out;
}

json to_json(const EvaluatedRecording& r) {
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

json to_json(const EvaluatedStills& s) {
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
        out["recordings"].push_back(to_json(r));
    }
    out["stills"] = json::array();
    for (const EvaluatedStills& s : evaluation.stills) {
        out["stills"].push_back(to_json(s));
    }
    out["failed"] = json::array();
    for (const FailedRecording& f : evaluation.failed) {
        out["failed"].push_back({{"name", f.name}, {"message", f.error.message}});
    }
    out["gestures"] = json::object();
    for (const auto& [name, s] : evaluation.all.gestures()) {
        out["gestures"][name] = to_json(s);
    }
    out["all"] = to_json(evaluation.all.all());
    out["unlabelled"] = {{"events", evaluation.all.unlabelled_events()},
                         {"hours", evaluation.all.unlabelled_hours()},
                         {"per_hour", to_json(evaluation.all.false_per_hour())}};
    // Names of folders need not be UTF-8, of which JSON is made.
    fmt::print("{}\n", out.dump(2, ' ', false, json::error_handler_t::replace));
}

}  // namespace xtrack::tools
