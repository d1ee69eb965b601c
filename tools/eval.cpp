// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "tools/commands.hpp"
#include "tools/eval/evaluation.hpp"
#include "tools/eval/timeline.hpp"
#include "tools/progress.hpp"
#include "tools/stream.hpp"

namespace xtrack::tools {

namespace {

struct EvalOptions {
    std::vector<std::string> recordings;
    std::optional<std::string> gestures;
    std::string timeline;  ///< folder or file of pictures; empty = none
    bool json = false;
};

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
    auto labels = labels_of(folder);
    if (!labels) {
        return labels.error();
    }
    const auto played = play_recording(folder, options);
    if (!played) {
        return played.error();
    }
    auto evaluated = evaluate(folder, *played, std::move(*labels), options.gestures);
    if (!evaluated) {
        return evaluated.error();
    }
    evaluation.all.add(evaluated->scorer);
    evaluation.recordings.push_back(std::move(*evaluated));
    return {};
}

int run_eval(const EvalOptions& options) {
    SessionOptions session;
    session.pace = Pace::replay;
    if (const auto chosen = choose_gestures(options.gestures, session.gestures); !chosen) {
        return usage(chosen.error());
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
    std::optional<Progress> progress(std::in_place, "evaluating", options.recordings.size());
    for (const std::string& folder : options.recordings) {
        if (const auto added = add_recording(folder, session, evaluation); !added) {
            evaluation.failed.push_back({name_of_folder(folder), added.error()});
        }
        progress->step();
    }
    progress.reset();  // the bar goes before the figures come
    if (evaluation.failed.size() < options.recordings.size()) {
        options.json ? print_json(evaluation) : print_table(evaluation);
    }
    // What the others took an hour to say is not thrown away for one that is torn; the status and
    // the last lines say that it is missing from the figures.
    int status = 0;
    for (const EvaluatedRecording& recording : evaluation.recordings) {
        const Result<void> written = pictures ? pictures->write(recording) : Result<void>();
        if (!written) {
            status = fail(written.error());
            break;  // the others go to the same disk
        }
    }
    for (const FailedRecording& failed : evaluation.failed) {
        status = fail(failed.error);
    }
    return status;
}

}  // namespace

void add_eval(CLI::App& app, int& exit_status) {
    auto* command = app.add_subcommand(
        "eval", "Compare the events of recordings with their labels: rates with 95 % intervals");
    const auto options = std::make_shared<EvalOptions>();
    command->add_option("REC", options->recordings, "Folders of recordings")->required();
    command->add_option("--gestures", options->gestures,
                        "Comma-separated list of what is recognised (default: all)");
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
