// SPDX-License-Identifier: Apache-2.0
#include "tools/eval/figures.hpp"

#include <fmt/format.h>

namespace xtrack::tools {

using nlohmann::json;

namespace {

json latency(const std::vector<double>& ms) {
    if (ms.empty()) {
        return nullptr;
    }
    return {{"p50", percentile(ms, 0.50)}, {"p95", percentile(ms, 0.95)}};
}

}  // namespace

std::string to_text(const Estimate& e) {
    return fmt::format("{:5.2f} [{:4.2f}, {:4.2f}]", e.value, e.low, e.high);
}

std::string to_text(const Estimate& e, int of) { return of > 0 ? to_text(e) : "-"; }

std::string to_text(const std::vector<double>& ms) {
    return ms.empty() ? "-"
                      : fmt::format("{:.0f} / {:.0f}", percentile(ms, 0.50), percentile(ms, 0.95));
}

std::string jaccard_text(const GestureScore& s) {
    return s.labelled > 0 ? fmt::format("{:.2f}", s.jaccard()) : "-";
}

json to_json(const Estimate& e) { return {{"value", e.value}, {"low", e.low}, {"high", e.high}}; }

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
                {"latency_from_onset_ms", latency(s.from_onset_ms)},
                {"latency_from_start_ms", latency(s.from_start_ms)},
                {"latency_from_commit_ms", latency(s.from_commit_ms)},
                {"latency_from_end_ms", latency(s.from_end_ms)}};
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

json unlabelled_json(const GestureScorer& scorer) {
    return {{"events", scorer.unlabelled_events()},
            {"hours", scorer.unlabelled_hours()},
            {"per_hour", to_json(scorer.false_per_hour())}};
}

json to_json(const std::vector<FailedRecording>& failed) {
    json out = json::array();
    for (const FailedRecording& f : failed) {
        out.push_back({{"name", f.name}, {"message", f.error.message}});
    }
    return out;
}

void print(const json& out) {
    fmt::print("{}\n", out.dump(2, ' ', false, json::error_handler_t::replace));
}

}  // namespace xtrack::tools
