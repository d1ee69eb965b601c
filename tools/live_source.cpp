// SPDX-License-Identifier: Apache-2.0
#include "tools/live_source.hpp"

#include <memory>
#include <utility>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <xtrack/sim.hpp>

#include "tools/commands.hpp"
#include "tools/method_choice.hpp"
#include "tools/record/as_recorded.hpp"

namespace xtrack::tools {

namespace {

Result<OpenedSource> open_recording(const std::string& folder, const SessionOptions& options) {
    auto session = Session::open(folder, options);
    if (!session) {
        return session.error();
    }
    const auto reader = RecordingReader::open(folder);
    if (!reader) {
        return reader.error();
    }
    OpenedSource opened{std::move(*session), reader->kind(), {}, {}, reader->depth_unit_mm()};
    if (reader->has_rig()) {
        opened.rig = reader->rig();
    }
    if (opened.kind == RecordingKind::fringe) {
        opened.patterns = reader->patterns();
    }
    return opened;
}

Result<OpenedSource> open_simulator(const SourceOptions& source, const StreamOptions& stream,
                                    SessionOptions options) {
    auto settings = preset_of(source.source);
    if (!settings) {
        return settings.error();
    }
    if (!options.use_rig && !stream.gestures) {
        options.gestures = without_millimetres(options.gestures);  // no method is refused for them
    }
    if (source.seed != 0) {
        settings->vary(source.seed);
    }
    if (!source.method.empty()) {
        const auto shown = show_method(source.method, options.gestures, *settings);
        if (!shown) {
            return shown.error();
        }
        if (!shown->colours.empty()) {
            print_error(fmt::format("colour self-test: {}\n", shown->colours));
        }
        print_error(fmt::format("method {}: {}\n", info(shown->verdict.method).name,
                                shown->verdict.reason));
    }
    auto made = SimulatedRig::create(*settings);
    if (!made) {
        return made.error();
    }
    const Rig rig = (*made)->rig();
    const PatternSequence patterns = (*made)->patterns();
    std::unique_ptr<FrameSource> images = std::move(*made);
    if (source.as_recorded) {
        images = std::make_unique<AsRecorded>(std::move(images));
    }
    auto session = Session::create(std::move(images), options);
    if (!session) {
        return session.error();
    }
    return OpenedSource{std::move(*session), RecordingKind::fringe, rig, patterns, kDepthUnitMm};
}

}  // namespace

void add_source_options(CLI::App& command, SourceOptions& options) {
    command
        .add_option("SOURCE", options.source,
                    "sim, sim:ideal-60, sim:webcam-30, or the folder of a recording, which is "
                    "played at its own pace")
        ->default_str("sim");
    command.add_option("--seed", options.seed, "Simulator: another person, movement and noise")
        ->check(CLI::Validator(
            [](const std::string& text) {
                return text.find_first_not_of("0123456789") != std::string::npos ||
                               text.find_first_not_of("0") == std::string::npos || text.size() > 19
                           ? std::string("must be a whole number from 1 on")
                           : std::string();
            },
            "from 1 on"));
    command
        .add_option("--method", options.method,
                    "Simulator: what the projector shows; auto or a name from `xtrack methods`")
        ->check(not_empty());
}

Result<OpenedSource> open_source(const SourceOptions& source, const StreamOptions& stream,
                                 SessionOptions options) {
    if (is_simulator(source.source)) {
        return open_simulator(source, stream, options);
    }
    if (source.seed != 0 || !source.method.empty()) {
        return Error{ErrorCode::invalid_argument,
                     source.seed != 0
                         ? "--seed: only the simulator has one; leave it out for " + source.source
                         : "--method: what a recording shows is in its pattern.yaml; leave it out "
                           "for " +
                               source.source};
    }
    return open_recording(source.source, options);
}

}  // namespace xtrack::tools
