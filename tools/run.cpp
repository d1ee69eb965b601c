// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include <CLI/CLI.hpp>

#include "tools/commands.hpp"
#include "tools/live_source.hpp"
#include "tools/method_choice.hpp"
#include "tools/stream.hpp"

namespace xtrack::tools {

namespace {

struct RunOptions {
    SourceOptions source;
    StreamOptions stream;
};

int run(const RunOptions& run) {
    const auto options = session_options(run.stream, Pace::own_pace);
    if (!options) {
        return usage(options.error());
    }
    auto opened = open_source(run.source, run.stream, *options);
    if (!opened) {
        return opened.error().code == ErrorCode::invalid_argument ? usage(opened.error())
                                                                  : fail(with_mode(opened.error()));
    }
    if (const auto possible = check_stream(opened->session, run.stream); !possible) {
        return usage(possible.error());
    }
    return play(opened->session, run.stream, options->pace, !is_simulator(run.source.source));
}

}  // namespace

void add_run(CLI::App& app, int& exit_status) {
    auto* command = app.add_subcommand("run", "Events as they happen, with their latency");
    const auto options = std::make_shared<RunOptions>();
    add_source_options(*command, options->source);
    add_stream_options(*command, options->stream);
#ifndef _WIN32
    command->add_flag("--control", options->stream.control,
                      "Change settings while it runs: NAME=VALUE lines on standard input, as of "
                      "--set; with --mode, mode=hold keeps the images at hand");
#endif
    command->callback([=, &exit_status] { exit_status = run(*options); });
}

}  // namespace xtrack::tools
