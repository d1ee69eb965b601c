// SPDX-License-Identifier: Apache-2.0
#include "tools/corpus/report.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include <fmt/format.h>

namespace xtrack::tools::corpus {

namespace {

using nlohmann::ordered_json;

std::string text(const Estimate& e) {
    return fmt::format("{:.3f} [{:.3f}, {:.3f}]", e.value, e.low, e.high);
}

std::string text(const std::vector<double>& ms) {
    return ms.empty() ? "-"
                      : fmt::format("{:.0f} / {:.0f}", percentile(ms, 0.5), percentile(ms, 0.95));
}

std::string row(const std::string& name, const GestureScore& s) {
    const bool asked = s.labelled > 0;
    return fmt::format("  {:<24} {:>5}/{:<5} {:>22} {:>5} {:>22} {:>5} {:>13} {:>5} {:>5}\n", name,
                       s.correct, s.labelled, asked ? text(s.detection()) : "-", s.false_events(),
                       asked ? text(s.false_per_label()) : "-",
                       asked ? fmt::format("{:.2f}", s.jaccard()) : "-", text(s.from_commit_ms),
                       s.wrong_hand, s.cancelled);
}

std::string table(const Group& group) {
    std::string out = fmt::format("  {:<24} {:>11} {:>22} {:>5} {:>22} {:>5} {:>13} {:>5} {:>5}\n",
                                  group.name, "found", "DR [95 %]", "false", "FP/label [95 %]",
                                  "JI", "commit, ms", "wrong", "canc");
    for (const auto& [name, score] : group.tally.scores) {
        out += row("  " + name, score);
    }
    out += row("  all", group.tally.all());
    if (group.tally.short_of_definition > 0) {
        out += fmt::format("    {} performed short of their definition, not asked for\n",
                           group.tally.short_of_definition);
    }
    return out;
}

std::string hours(const Group& group) {
    const Tally& t = group.tally;
    const bool heard = group.part == Part::everyday;
    const int events = heard ? t.false_events : t.strange_events;
    std::string out =
        fmt::format("  {:<24} {:>5} events in {:.2f} h: {:>7} an hour", group.name, events, t.hours,
                    fmt::format("{:.2f}", poisson(events, t.hours).value));
    const Estimate e = poisson(events, t.hours);
    out += fmt::format(" [{:.2f}, {:.2f}]", e.low, e.high);
    if (group.part == Part::company) {
        out += fmt::format("; changes of owner {}", t.owner_changes);
    } else if (group.part == Part::passers_by) {
        out += fmt::format("; sessions taken {}", t.engagements);
    } else {
        const auto plain = std::count_if(t.findings.begin(), t.findings.end(),
                                         [](const Finding& f) { return f.by_definition; });
        out += fmt::format("; {} of them fulfil the plain definition", plain);
    }
    return out + "\n";
}

struct Cause {
    int count = 0;
    int plain = 0;
};

/// What happened most, and where.
std::vector<std::pair<std::string, Cause>> causes_of(const Tally& tally) {
    std::map<std::string, Cause> causes;
    for (const Finding& f : tally.findings) {
        Cause& cause =
            causes[f.missed ? fmt::format("{} missed: {}", f.gesture, f.why_not)
                            : fmt::format("{}{}{} while {}", f.strange ? "a stranger's " : "",
                                          f.gesture, f.wrong_hand ? ", wrong hand," : "", f.doing)];
        ++cause.count;
        cause.plain += f.by_definition ? 1 : 0;
    }
    std::vector<std::pair<std::string, Cause>> sorted(causes.begin(), causes.end());
    std::stable_sort(sorted.begin(), sorted.end(),
                     [](const auto& a, const auto& b) { return a.second.count > b.second.count; });
    return sorted;
}

std::string list_of_causes(const Group& group, bool explain) {
    constexpr std::size_t kMost = 6;
    std::string out;
    const auto causes = causes_of(group.tally);
    for (std::size_t i = 0; i < causes.size() && (explain || i < kMost); ++i) {
        const auto& [name, cause] = causes[i];
        out += fmt::format(
            "    {:>5} x {}{}\n", cause.count, name,
            cause.plain > 0 ? fmt::format(" ({} by the plain definition)", cause.plain) : "");
    }
    if (!explain) {
        return out;
    }
    for (const Finding& f : group.tally.findings) {
        out += fmt::format("      {:<44} {:>9.3f} s  {:<22} {}\n", f.sequence, f.t_s, f.gesture,
                           f.missed    ? "missed: " + f.why_not
                           : f.strange ? "a stranger's, while " + f.doing
                                       : "while " + f.doing);
    }
    return out;
}

const char* title_of(Part part) {
    switch (part) {
        case Part::gestures: return "Gestures, hands with a tracker's noise";
        case Part::manners: return "People who move differently (no target)";
        case Part::everyday: return "Movement that is no gesture, listened to";
        case Part::passers_by: return "Movement of those who have no session";
        case Part::company: return "Strangers about one who has the session";
        case Part::images: return "Gestures, images through the whole pipeline";
    }
    return "";
}

ordered_json json_of(const Estimate& e) {
    return {{"value", e.value}, {"low", e.low}, {"high", e.high}};
}

ordered_json json_of(const std::vector<double>& ms) {
    if (ms.empty()) {
        return nullptr;
    }
    return {{"p50", percentile(ms, 0.5)}, {"p95", percentile(ms, 0.95)}};
}

ordered_json json_of(const GestureScore& s) {
    return {{"labelled", s.labelled},
            {"found", s.correct},
            {"detection_rate", json_of(s.detection())},
            {"false", s.false_events()},
            {"false_per_label", json_of(s.false_per_label())},
            {"jaccard", s.labelled > 0 ? ordered_json(s.jaccard()) : ordered_json(nullptr)},
            {"wrong_hand", s.wrong_hand},
            {"cancelled", s.cancelled},
            {"after_commit_ms", json_of(s.from_commit_ms)}};
}

}  // namespace

const char* to_string(Part part) noexcept {
    switch (part) {
        case Part::gestures: return "gestures";
        case Part::manners: return "manners";
        case Part::everyday: return "everyday";
        case Part::passers_by: return "passers-by";
        case Part::company: return "company";
        case Part::images: return "images";
    }
    return "unknown";
}

std::string text_of(const std::vector<Group>& groups, bool explain) {
    std::string out;
    const Group* before = nullptr;
    for (const Group& group : groups) {
        if (before == nullptr || before->part != group.part) {
            out += fmt::format("{}{}\n", before == nullptr ? "" : "\n", title_of(group.part));
        }
        before = &group;
        const bool counts_hours = group.part == Part::everyday || group.part == Part::passers_by;
        if (!counts_hours) {
            out += table(group);
        }
        if (counts_hours || group.part == Part::company) {
            out += hours(group);
        }
        out += list_of_causes(group, explain);
    }
    out += "commit: deciding frame after the label's deciding moment, p50 / p95\n";
    return out;
}

ordered_json json_of(const std::vector<Group>& groups) {
    ordered_json out = ordered_json::array();
    for (const Group& group : groups) {
        const Tally& t = group.tally;
        ordered_json one = {{"part", to_string(group.part)},
                            {"name", group.name},
                            {"sequences", t.sequences},
                            {"hours", t.hours},
                            {"false_events", t.false_events},
                            {"false_per_hour", json_of(poisson(t.false_events, t.hours))},
                            {"events_of_strangers", t.strange_events},
                            {"of_strangers_per_hour", json_of(poisson(t.strange_events, t.hours))},
                            {"changes_of_owner", t.owner_changes},
                            {"sessions_taken", t.engagements},
                            {"short_of_definition", t.short_of_definition}};
        one["gestures"] = ordered_json::object();
        for (const auto& [name, score] : t.scores) {
            one["gestures"][name] = json_of(score);
        }
        one["all"] = json_of(t.all());
        one["causes"] = ordered_json::array();
        for (const auto& [name, cause] : causes_of(t)) {
            one["causes"].push_back(
                {{"what", name}, {"count", cause.count}, {"by_plain_definition", cause.plain}});
        }
        out.push_back(std::move(one));
    }
    return out;
}

}  // namespace xtrack::tools::corpus
