// SPDX-License-Identifier: Apache-2.0
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "tools/commands.hpp"
#include "tools/eval/evaluation.hpp"
#include "tools/eval/sweep.hpp"
#include "tools/eval/timeline.hpp"
#include "tools/progress.hpp"
#include "tools/settings_option.hpp"
#include "tools/stream.hpp"

namespace xtrack::tools {

namespace {

struct EvalOptions {
    std::vector<std::string> recordings;
    std::optional<std::string> gestures;
    std::vector<std::string> changes;  ///< of gesture settings, NAME=VALUE
    std::string sweep;                 ///< of a gesture setting; empty = none
    std::string timeline;              ///< folder or file of pictures; empty = none
    bool json = false;
};

/// What a folder holds, up to its hands and beside its labels.
struct Played {
    PlayedRecording recording;
    std::vector<GestureLabel> labels;
};

Result<Played> play_with_labels(const std::string& folder, const SessionOptions& options) {
    auto labels = labels_of(folder);  // first: it is read at once, and images are not
    if (!labels) {
        return labels.error();
    }
    auto recording = play_recording(folder, options);
    if (!recording) {
        return recording.error();
    }
    return Played{std::move(*recording), std::move(*labels)};
}

/// Reads, plays and judges one folder into `evaluation`.
Result<void> add_recording(const std::string& folder, const SessionOptions& options,
                           Evaluation& evaluation) {
    if (has_stills(folder)) {
        auto stills = evaluate_stills(folder, options.tracker);
        if (!stills) {
            return stills.error();
        }
        evaluation.stills.push_back(std::move(*stills));
        return {};
    }
    auto played = play_with_labels(folder, options);
    if (!played) {
        return played.error();
    }
    auto evaluated =
        evaluate(folder, played->recording, std::move(played->labels), options.gestures);
    if (!evaluated) {
        return evaluated.error();
    }
    evaluation.all.add(evaluated->scorer);
    evaluation.recordings.push_back(std::move(*evaluated));
    return {};
}

/// The same for every value of a sweep: decoded once, recognised as often as there are values.
Result<void> add_recording(const std::string& folder, const SessionOptions& options, Sweep& sweep) {
    if (has_stills(folder)) {
        return Error{ErrorCode::unsupported,
                     folder +
                         ": holds single images (poses.csv), which no gesture setting "
                         "changes; leave it out of --sweep"};
    }
    const auto played = play_with_labels(folder, options);
    if (!played) {
        return played.error();
    }
    for (SweepPoint& point : sweep.points) {
        const auto evaluated = evaluate(folder, played->recording, played->labels, point.settings);
        if (!evaluated) {
            return evaluated.error();
        }
        point.scorer.add(evaluated->scorer);
    }
    return {};
}

/// Takes all folders into a Sweep or an Evaluation, and prints it.
///
/// What the others took an hour to say is not thrown away for one that is torn; the status and the
/// last lines say that it is missing from the figures.
/// @param finish what is left to do with what was read
template <typename Outcome>
int judge_all(const EvalOptions& options, const SessionOptions& session, Outcome& outcome,
              const std::function<Result<void>()>& finish) {
    std::optional<Progress> progress(std::in_place, "evaluating", options.recordings.size());
    for (const std::string& folder : options.recordings) {
        if (const auto added = add_recording(folder, session, outcome); !added) {
            outcome.failed.push_back({name_of_folder(folder), added.error()});
        }
        progress->step();
    }
    progress.reset();  // the bar goes before the figures come
    int status = 0;
    if (outcome.failed.size() < options.recordings.size()) {
        options.json ? print_json(outcome) : print_table(outcome);
        if (const auto finished = finish(); !finished) {
            status = fail(finished.error());
        }
    }
    for (const FailedRecording& failed : outcome.failed) {
        status = fail(failed.error);
    }
    return status;
}

int run_sweep(const EvalOptions& options, const SessionOptions& session) {
    if (!options.timeline.empty()) {
        return usage({ErrorCode::invalid_argument,
                      "--timeline: draws one choice of settings; leave out it or --sweep"});
    }
    auto sweep = parse_sweep(options.sweep, session.gestures);
    if (!sweep) {
        return usage(sweep.error());
    }
    return judge_all(options, session, *sweep, [] { return Result<void>(); });
}

int run_eval(const EvalOptions& options) {
    SessionOptions session;
    session.pace = Pace::replay;
    if (const auto chosen = choose_gestures(options.gestures, session.gestures); !chosen) {
        return usage(chosen.error());
    }
    if (const auto set = apply_gesture_settings(options.changes, session.gestures); !set) {
        return usage({set.error().code, "--set " + set.error().message});
    }
    if (!options.sweep.empty()) {
        return run_sweep(options, session);
    }
    std::optional<TimelineFolder> pictures;
    if (!options.timeline.empty()) {
        auto folder = TimelineFolder::create(options.timeline, options.recordings.size());
        if (!folder) {
            return folder.error().code == ErrorCode::invalid_argument ? usage(folder.error())
                                                                      : fail(folder.error());
        }
        pictures = std::move(*folder);
    }
    Evaluation evaluation;
    evaluation.all = GestureScorer(session.gestures);
    return judge_all(options, session, evaluation, [&]() -> Result<void> {
        for (const EvaluatedRecording& recording : evaluation.recordings) {
            if (auto written = pictures ? pictures->write(recording) : Result<void>(); !written) {
                return written;  // the others go to the same disk
            }
        }
        return {};
    });
}

}  // namespace

void add_eval(CLI::App& app, int& exit_status) {
    auto* command = app.add_subcommand(
        "eval", "Compare the events of recordings with their labels: rates with 95 % intervals");
    const auto options = std::make_shared<EvalOptions>();
    command->add_option("REC", options->recordings, "Folders of recordings")->required();
    command->add_option("--gestures", options->gestures,
                        "Comma-separated list of what is recognised (default: as run)");
    add_gesture_settings_option(*command, options->changes);
    command
        ->add_option("--sweep", options->sweep,
                     "A row for each value of a gesture setting: NAME=FROM:TO:STEPS or NAME=a,b,c")
        ->type_name("NAME=VALUES")
        ->check(not_empty());
    command
        ->add_option("--timeline", options->timeline,
                     "Draws labels and events of each recording on a time axis: a folder for "
                     "pictures, or one that ends in .png")
        ->type_name("DIR|FILE.png")
        ->check(not_empty());
    command->add_flag("--json", options->json, "One JSON object instead of tables");
    command->callback([=, &exit_status] { exit_status = run_eval(*options); });
}

}  // namespace xtrack::tools
