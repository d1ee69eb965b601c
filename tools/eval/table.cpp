// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "tools/eval/evaluation.hpp"
#include "tools/eval/figures.hpp"

namespace xtrack::tools {

namespace {

void print_events(const EvaluatedRecording& r) {
    fmt::print("{} ({:.1f} s, {} labels)\n", r.name, r.seconds, r.labels.size());
    for (std::size_t i = 0; i < r.events.size(); ++i) {
        const JudgedEvent& e = r.events[i];
        fmt::print("  {:>9.3f} s  {:<12} {:<10} {:<9} {}\n",
                   static_cast<double>(e.event.sensor.us()) * 1e-6, name_of(e.event),
                   to_string(e.verdict), r.causes[i], e.during.empty() ? "" : "during " + e.during);
    }
}

void print_recordings(const std::vector<EvaluatedRecording>& recordings) {
    std::size_t width = 12;
    for (const EvaluatedRecording& r : recordings) {
        width = std::max(width, r.name.size());
    }
    fmt::print("\n{:<{}} {:>8} {:>7} {:>5} {:>5} {:>5} {:>5} {:>13} {:>12}\n", "recording", width,
               "s", "found", "false", "hand", "canc", "JI", "commit, ms", "end, ms");
    for (const EvaluatedRecording& r : recordings) {
        const GestureScore s = r.scorer.all();
        fmt::print("{:<{}} {:>8.1f} {:>3}/{:<3} {:>5} {:>5} {:>5} {:>5} {:>13} {:>12}\n", r.name,
                   width, r.seconds, s.correct, s.labelled, s.false_events(), s.wrong_hand,
                   s.cancelled, jaccard_text(s), to_text(s.from_commit_ms), to_text(s.from_end_ms));
    }
}

void print_gesture(const std::string& name, const GestureScore& s) {
    fmt::print(
        "{:<12} {:>3}/{:<3} {:>19} {:>5} {:>19} {:>19} {:>5} {:>5} {:>12} {:>12} {:>13} "
        "{:>13}\n",
        name, s.correct, s.labelled, to_text(s.detection(), s.labelled), s.false_events(),
        to_text(s.false_per_label(), s.labelled),
        to_text(s.false_per_label_without_overlaps(), s.labelled), jaccard_text(s), s.cancelled,
        to_text(s.from_onset_ms), to_text(s.from_start_ms), to_text(s.from_commit_ms),
        to_text(s.from_end_ms));
}

void print_gestures(const GestureScorer& scorer) {
    fmt::print(
        "\n{:<12} {:>7} {:>19} {:>5} {:>19} {:>19} {:>5} {:>5} {:>12} {:>12} {:>13} {:>13}\n",
        "gesture", "found", "DR [95 %]", "false", "FP/label [95 %]", "FP, no overlaps", "JI",
        "canc", "onset, ms", "start, ms", "commit, ms", "end, ms");
    for (const auto& [name, s] : scorer.gestures()) {
        print_gesture(name, s);
    }
    const GestureScore all = scorer.all();
    print_gesture("all", all);
    fmt::print(
        "latencies are p50 / p95 of the deciding frame, from the event's own onset, the label's "
        "start, the label's commit and the label's end\n");
    fmt::print("pinches during x_ok: {}   wrong hand: {}\n", all.allowed,
               to_text(all.wrong_hands(), all.correct + all.wrong_hand));
    fmt::print("cancelled: {}, of these during their label: {}; right cancels: {}", all.cancelled,
               all.cancelled_in_label, to_text(all.right_cancels(), all.cancelled));
    if (all.without_reason + all.unclosed > 0) {
        fmt::print("; without a reason: {}, begun and never closed: {}", all.without_reason,
                   all.unclosed);
    }
    fmt::print("\n");
    if (scorer.unlabelled_hours() > 0.0) {
        const Estimate e = scorer.false_per_hour();
        fmt::print("without labels: {} events in {:.1f} s, {:.0f} an hour [{:.0f}, {:.0f}]\n",
                   scorer.unlabelled_events(), scorer.unlabelled_hours() * 3600.0, e.value, e.low,
                   e.high);
    }
}

void print_still(const EvaluatedStills& s, std::size_t width) {
    fmt::print("{:<{}} {:>3}/{:<3} {:>19} {:>3}/{:<3} {:>19} {:>3}/{:<3} {:>19} {:>19}\n", s.name,
               width, s.found, s.with_hand, to_text(s.found_share(), s.with_hand), s.none_found,
               s.without_hand, to_text(s.none_share(), s.without_hand), s.count_right, s.counted,
               to_text(s.right_share(), s.counted), to_text(s.near_share(), s.counted));
}

void print_stills(const std::vector<EvaluatedStills>& stills) {
    std::size_t width = 12;
    for (const EvaluatedStills& s : stills) {
        width = std::max(width, s.name.size());
    }
    fmt::print("\n{:<{}} {:>7} {:>19} {:>7} {:>19} {:>7} {:>19} {:>19}\n", "stills", width, "hand",
               "found [95 %]", "none", "none found [95 %]", "fingers", "right [95 %]",
               "within one [95 %]");
    EvaluatedStills all;
    all.name = "all";
    for (const EvaluatedStills& s : stills) {
        print_still(s, width);
        all.add(s);
    }
    if (stills.size() > 1) {
        print_still(all, width);
    }
}

}  // namespace

void print_table(const Evaluation& evaluation) {
    for (const EvaluatedRecording& r : evaluation.recordings) {
        print_events(r);
    }
    if (evaluation.recordings.size() > 1) {
        print_recordings(evaluation.recordings);
    }
    if (!evaluation.recordings.empty()) {
        print_gestures(evaluation.all);
    }
    if (!evaluation.stills.empty()) {
        print_stills(evaluation.stills);
    }
}

}  // namespace xtrack::tools
