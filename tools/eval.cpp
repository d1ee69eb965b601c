// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <xtrack/labels.hpp>
#include <xtrack/scoring.hpp>

#include "tools/commands.hpp"
#include "tools/progress.hpp"
#include "tools/stream.hpp"

namespace xtrack::tools {

namespace {

using nlohmann::json;

struct EvalOptions {
    std::vector<std::string> recordings;
    std::optional<std::string> gestures;
    bool json = false;
};

/// All that a recording became.
struct Played {
    std::vector<GestureEvent> events;
    Duration length{};
};

/// From the folder of a recording to its events; the loop does not care what is in the folder.
using Player = std::function<Result<Played>(const std::string& folder)>;

/// Fringes, depth or joints: the session finds out.
Player session_player(const SessionOptions& options) {
    return [options](const std::string& folder) -> Result<Played> {
        auto session = Session::open(folder, options);
        if (!session) {
            return session.error();
        }
        Played played;
        Stamp first;
        bool started = false;
        session->subscribe([&](const GestureEvent& e) { played.events.push_back(e); });
        session->subscribe_hands([&](const HandFrame& hands) {
            if (!started) {
                first = hands.stamp;
                started = true;
            }
            played.length = hands.stamp - first;
        });
        const Result<void> ended = session->run();
        if (!ended) {
            return ended.error();
        }
        return played;
    };
}

struct Recording {
    std::string name;
    std::size_t labels = 0;
    double seconds = 0.0;
    std::vector<JudgedEvent> events;
    std::vector<std::string> causes;  ///< of each event; empty where it is right
};

bool is_false(Verdict v) {
    return v == Verdict::wrong_hand || v == Verdict::overlap || v == Verdict::stray;
}

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

std::string name_of_folder(const std::string& folder) {
    const std::filesystem::path path = std::filesystem::path(folder).lexically_normal();
    return path.filename().empty() ? path.parent_path().filename().string()
                                   : path.filename().string();
}

Result<Recording> score(const std::string& folder, const Player& play, GestureScorer& scorer) {
    const std::filesystem::path label_file = std::filesystem::path(folder) / "labels.csv";
    std::vector<GestureLabel> labels;
    // A link to nothing is an error, and not a recording without labels.
    if (std::filesystem::exists(std::filesystem::symlink_status(label_file))) {
        auto read = read_labels(label_file);
        if (!read) {
            return read.error();
        }
        labels = std::move(*read);
    }
    const Result<Played> played = play(folder);
    if (!played) {
        return played.error();
    }
    Recording r;
    r.name = name_of_folder(folder);
    r.labels = labels.size();
    r.seconds = to_seconds(played->length);
    r.events = scorer.add(played->events, labels, played->length);
    for (const JudgedEvent& e : r.events) {
        r.causes.push_back(cause_of(e, r.events, labels));
    }
    return r;
}

std::string text(const Estimate& e) {
    return fmt::format("{:5.2f} [{:4.2f}, {:4.2f}]", e.value, e.low, e.high);
}

std::string text(const std::vector<double>& ms) {
    return ms.empty() ? "-"
                      : fmt::format("{:.0f} / {:.0f}", percentile(ms, 0.50), percentile(ms, 0.95));
}

void print_row(const std::string& name, const GestureScore& s) {
    // A share of no label is no figure.
    const bool asked = s.labelled > 0;
    fmt::print("{:<12} {:>3}/{:<3} {:>19} {:>5} {:>19} {:>19} {:>5} {:>5} {:>12} {:>12} {:>13}\n",
               name, s.correct, s.labelled, asked ? text(s.detection()) : "-", s.false_events(),
               asked ? text(s.false_per_label()) : "-",
               asked ? text(s.false_per_label_without_overlaps()) : "-",
               asked ? fmt::format("{:.2f}", s.jaccard()) : "-", s.cancelled, text(s.from_onset_ms),
               text(s.from_start_ms), text(s.from_end_ms));
}

void print_text(const std::vector<Recording>& recordings, const GestureScorer& scorer) {
    for (const Recording& r : recordings) {
        fmt::print("{} ({:.1f} s, {} labels)\n", r.name, r.seconds, r.labels);
        for (std::size_t i = 0; i < r.events.size(); ++i) {
            const JudgedEvent& e = r.events[i];
            fmt::print("  {:>9.3f} s  {:<12} {:<10} {:<9} {}\n",
                       static_cast<double>(e.event.sensor.us()) * 1e-6, name_of(e.event),
                       to_string(e.verdict), r.causes[i],
                       e.during.empty() ? "" : "during " + e.during);
        }
    }
    fmt::print("\n{:<12} {:>7} {:>19} {:>5} {:>19} {:>19} {:>5} {:>5} {:>12} {:>12} {:>13}\n",
               "gesture", "found", "DR [95 %]", "false", "FP/label [95 %]", "FP, no overlaps", "JI",
               "canc", "onset, ms", "start, ms", "end, ms");
    for (const auto& [name, s] : scorer.gestures()) {
        print_row(name, s);
    }
    const GestureScore all = scorer.all();
    print_row("all", all);
    fmt::print(
        "latencies are p50 / p95 of the deciding frame, from the event's own onset, the "
        "label's start and the label's end\n");
    fmt::print("pinches during x_ok: {}   wrong hand: {}   cancelled during their label: {}\n",
               all.allowed, text(all.wrong_hands()), all.cancelled_in_label);
    if (scorer.unlabelled_hours() > 0.0) {
        const Estimate e = scorer.false_per_hour();
        fmt::print("without labels: {} events in {:.1f} s, {:.0f} an hour [{:.0f}, {:.0f}]\n",
                   scorer.unlabelled_events(), scorer.unlabelled_hours() * 3600.0, e.value, e.low,
                   e.high);
    }
}

json to_json(const Estimate& e) { return {{"value", e.value}, {"low", e.low}, {"high", e.high}}; }

json to_json(const std::vector<double>& ms) {
    if (ms.empty()) {
        return nullptr;
    }
    return {{"p50", percentile(ms, 0.50)}, {"p95", percentile(ms, 0.95)}};
}

json to_json(const GestureScore& s) {
    json out = {{"labelled", s.labelled},
                {"correct", s.correct},
                {"false", s.false_events()},
                {"false_without_overlaps", s.false_without_overlaps()},
                {"allowed", s.allowed},
                {"wrong_hand", s.wrong_hand},
                {"cancelled", s.cancelled},
                {"cancelled_in_label", s.cancelled_in_label},
                {"latency_from_onset_ms", to_json(s.from_onset_ms)},
                {"latency_from_start_ms", to_json(s.from_start_ms)},
                {"latency_from_end_ms", to_json(s.from_end_ms)}};
    if (s.labelled > 0) {
        out["detection_rate"] = to_json(s.detection());
        out["false_per_label"] = to_json(s.false_per_label());
        out["false_per_label_without_overlaps"] = to_json(s.false_per_label_without_overlaps());
        out["jaccard"] = s.jaccard();
    }
    return out;
}

void print_json(const std::vector<Recording>& recordings, const GestureScorer& scorer) {
    json out;
    out["recordings"] = json::array();
    for (const Recording& r : recordings) {
        json events = json::array();
        for (std::size_t i = 0; i < r.events.size(); ++i) {
            const JudgedEvent& e = r.events[i];
            events.push_back({{"t_us", e.event.sensor.us()},
                              {"gesture", name_of(e.event)},
                              {"verdict", to_string(e.verdict)},
                              {"cause", r.causes[i].empty() ? json(nullptr) : json(r.causes[i])},
                              {"during", e.during.empty() ? json(nullptr) : json(e.during)}});
        }
        out["recordings"].push_back({{"name", r.name},
                                     {"seconds", r.seconds},
                                     {"labels", r.labels},
                                     {"events", std::move(events)}});
    }
    out["gestures"] = json::object();
    for (const auto& [name, s] : scorer.gestures()) {
        out["gestures"][name] = to_json(s);
    }
    out["all"] = to_json(scorer.all());
    out["unlabelled"] = {{"events", scorer.unlabelled_events()},
                         {"hours", scorer.unlabelled_hours()},
                         {"per_hour", to_json(scorer.false_per_hour())}};
    // Names of folders need not be UTF-8, of which JSON is made.
    fmt::print("{}\n", out.dump(2, ' ', false, json::error_handler_t::replace));
}

int evaluate(const EvalOptions& options) {
    SessionOptions session;
    session.pace = Pace::replay;
    if (const auto chosen = choose_gestures(options.gestures, session.gestures); !chosen) {
        return usage(chosen.error());
    }
    GestureScorer scorer(session.gestures);
    const Player play = session_player(session);
    std::vector<Recording> recordings;
    std::optional<Progress> progress(std::in_place, "evaluating", options.recordings.size());
    for (const std::string& folder : options.recordings) {
        auto scored = score(folder, play, scorer);
        if (!scored) {
            progress.reset();
            return fail(scored.error());
        }
        recordings.push_back(std::move(*scored));
        progress->step();
    }
    progress.reset();  // the bar goes before the figures come
    options.json ? print_json(recordings, scorer) : print_text(recordings, scorer);
    return 0;
}

}  // namespace

void add_eval(CLI::App& app, int& exit_status) {
    auto* command = app.add_subcommand(
        "eval", "Compare the events of recordings with their labels: rates with 95 % intervals");
    const auto options = std::make_shared<EvalOptions>();
    command->add_option("REC", options->recordings, "Folders of recordings")->required();
    command->add_option("--gestures", options->gestures,
                        "Comma-separated list of what is recognised (default: all)");
    command->add_flag("--json", options->json, "One JSON object instead of tables");
    command->callback([=, &exit_status] { exit_status = evaluate(*options); });
}

}  // namespace xtrack::tools
