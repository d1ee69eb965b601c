// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "tools/commands.hpp"
#include "tools/live_source.hpp"
#include "tools/record/label_input.hpp"
#include "tools/record/recorder.hpp"
#include "tools/stream.hpp"

#ifndef _WIN32
#include <sys/stat.h>
#endif

namespace xtrack::tools {

namespace {

struct RecordOptions {
    SourceOptions source;
    StreamOptions stream;
    std::string out;
    std::optional<RecordWhat> what;
    std::vector<std::string> labels;
    std::optional<double> seconds;
    bool anonymise = false;
    bool fast = false;
};

/// What is seen of people is theirs: nobody else may read it.
void keep_private() {
#ifndef _WIN32
    ::umask(S_IRWXG | S_IRWXO);
#endif
}

Result<RecorderSetup> setup_of(const RecordOptions& options, RecordingKind kind) {
    RecorderSetup setup;
    setup.out = options.out;
    if (options.what) {
        setup.what = *options.what;
    } else if (kind == RecordingKind::joints) {
        setup.what = RecordWhat::joints;
    } else {
        setup.what = kind == RecordingKind::fringe && !options.anonymise ? RecordWhat::images
                                                                         : RecordWhat::depth;
    }
    if (options.anonymise && setup.what == RecordWhat::images) {
        return Error{ErrorCode::invalid_argument,
                     "--anonymise: images show who is there; leave out --what images, or choose "
                     "depth or joints"};
    }
    setup.hand_only = options.anonymise;
    return setup;
}

Result<std::vector<GestureLabel>> kinds_of(const std::vector<std::string>& labels) {
    constexpr std::size_t kMost = 9;  // keys
    if (labels.size() > kMost) {
        return Error{ErrorCode::invalid_argument,
                     fmt::format("--label: there are keys for {} of them; leave out some", kMost)};
    }
    std::vector<GestureLabel> kinds;
    for (const std::string& text : labels) {
        const auto kind = parse_label_option(text);
        if (!kind) {
            return Error{kind.error().code, "--label: " + kind.error().message};
        }
        kinds.push_back(*kind);
    }
    return kinds;
}

const char* what_is_kept(const RecorderSetup& setup) {
    switch (setup.what) {
        case RecordWhat::images: return "every image of the camera";
        case RecordWhat::depth:
            return setup.hand_only ? "depth of the hands alone" : "every depth image";
        case RecordWhat::joints: return "positions of palms and fingertips, no images";
    }
    return "";
}

Stamp stamp_of(const PipelineView& view) {
    if (view.frame != nullptr) {
        return (*view.frame)->stamp;
    }
    return view.depth != nullptr ? view.depth->stamp : view.interaction_hands->stamp;
}

void print_outcome(const RecordOptions& options, const RecorderSetup& setup,
                   const Recorder& recorder, std::size_t labels, std::uint64_t dropped) {
    const double seconds = to_seconds(recorder.length());
    if (options.stream.json) {
        const nlohmann::ordered_json out = {{"type", "recording"},
                                            {"folder", options.out},
                                            {"what", to_string(setup.what)},
                                            {"anonymised", setup.hand_only},
                                            {"items", recorder.count()},
                                            {"seconds", seconds},
                                            {"labels", labels},
                                            {"dropped", dropped}};
        fmt::print("{}\n", out.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
        return;
    }
    print_error(fmt::format(
        "recorded {} {} of {:.1f} s and {} labels in {}{}\n", recorder.count(),
        setup.what == RecordWhat::joints ? "moments" : "images", seconds, labels, options.out,
        dropped > 0 ? fmt::format("; {} came too fast and are not in it", dropped)
                    : std::string()));
}

/// Plays the source, and keeps what comes until it ends, is interrupted, or cannot be written.
int record_to(Recorder& recorder, Session& session, const RecordOptions& options,
              const RecorderSetup& setup, LabelInput& labels) {
    Result<void> stored;
    std::optional<Stamp> first;
    Stamp last;
    session.subscribe_pipeline([&](const PipelineView& view) {
        if (!stored) {
            return;
        }
        last = stamp_of(view);
        first = first.value_or(last);
        stored = recorder.add(view);
        if (labels.poll(last) && stored) {
            stored = recorder.set_labels(labels.labels());
        }
        if (!stored || (options.seconds && to_seconds(last - *first) >= *options.seconds)) {
            session.stop();
        }
    });
    const int played =
        play(session, options.stream, options.fast ? Pace::replay : Pace::own_pace, false);
    if (labels.finish(last) && stored) {
        stored = recorder.set_labels(labels.labels());
    }
    const std::size_t label_count = labels.labels().size();
    const auto closed = recorder.close();
    if (!closed) {
        return fail(stored ? closed.error() : stored.error());
    }
    print_outcome(options, setup, recorder, label_count, session.statistics().dropped);
    return stored ? played : fail(stored.error());
}

int record(const RecordOptions& options) {
    const auto chosen =
        session_options(options.stream, options.fast ? Pace::replay : Pace::own_pace);
    if (!chosen) {
        return usage(chosen.error());
    }
    auto kinds = kinds_of(options.labels);
    if (!kinds) {
        return usage(kinds.error());
    }
    keep_private();
    auto source = open_source(options.source, options.stream, *chosen);
    if (!source) {
        return source.error().code == ErrorCode::invalid_argument ? usage(source.error())
                                                                  : fail(with_mode(source.error()));
    }
    if (const auto possible = check_stream(source->session, options.stream); !possible) {
        return usage(possible.error());
    }
    if (options.stream.without_rig) {
        source->rig.reset();  // what is read back is then played as it was
    }
    const auto setup = setup_of(options, source->kind);
    if (!setup) {
        return usage(setup.error());
    }
    auto recorder = Recorder::create(*setup, *source);
    if (!recorder) {
        return recorder.error().code == ErrorCode::invalid_argument ? usage(recorder.error())
                                                                    : fail(recorder.error());
    }
    LabelInput labels(std::move(*kinds));
    print_error(fmt::format("recording {} to {} (until the end in {}); Ctrl-C ends it\n",
                            what_is_kept(*setup), options.out, recorder->folder().string()));
    if (const std::string help = labels.help(); !help.empty()) {
        print_error(help + "\n");
    }
    return record_to(*recorder, source->session, options, *setup, labels);
}

}  // namespace

void add_record(CLI::App& app, int& exit_status) {
    auto* command = app.add_subcommand(
        "record", "Stores a source as a recording, with labels of what somebody does meanwhile");
    const auto options = std::make_shared<RecordOptions>();
    add_source_options(*command, options->source);
    options->source.as_recorded = true;
    command->add_option("--out", options->out, "Folder of the new recording")
        ->required()
        ->type_name("DIR")
        ->check(not_empty());
    command
        ->add_option_function<std::string>(
            "--what",
            [options](const std::string& name) {
                options->what = name == "images"  ? RecordWhat::images
                                : name == "depth" ? RecordWhat::depth
                                                  : RecordWhat::joints;
            },
            "What is stored: images, depth or joints (default: images where the source has "
            "fringes, else what it has)")
        ->check(CLI::IsMember({"images", "depth", "joints"}));
    command
        ->add_option("--label", options->labels,
                     "GESTURE or GESTURE:HAND, as of labels.csv: at a terminal key 1 begins and "
                     "ends the first, up to 9. From a pipe come lines, begin GESTURE [HAND] and "
                     "end, without this option")
        ->type_name("GESTURE[:HAND]")
        ->allow_extra_args(false);
    command->add_flag("--anonymise", options->anonymise,
                      "Stores depth of the hands alone (or joints), and no images");
    command->add_option("--seconds", options->seconds, "Ends it after so long")
        ->check(CLI::PositiveNumber);
    command->add_flag("--fast", options->fast,
                      "As fast as it can, dropping nothing: for a recording that is stored anew");
    add_stream_options(*command, options->stream);
    command->callback([=, &exit_status] { exit_status = record(*options); });
}

}  // namespace xtrack::tools
