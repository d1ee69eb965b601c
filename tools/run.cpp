// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <xtrack/sim.hpp>

#include "tools/commands.hpp"
#include "tools/method_choice.hpp"
#include "tools/settings_option.hpp"
#include "tools/stream.hpp"

namespace xtrack::tools {

namespace {

struct RunOptions {
    std::string source = "sim";
    std::uint64_t seed = 0;
    std::string method;
    StreamOptions stream;
};

/// `sim` with a seed is another person on another day; without one it is the same as everywhere.
Result<Session> open(const RunOptions& run, SessionOptions options) {
    if (run.seed == 0 && run.method.empty()) {
        return Session::open(run.source, options);
    }
    if (!is_simulator(run.source)) {
        return Error{ErrorCode::invalid_argument,
                     run.seed != 0
                         ? "--seed: only the simulator has one; leave it out for " + run.source
                         : "--method: what a recording shows is in its pattern.yaml; leave it out "
                           "for " +
                               run.source};
    }
    auto settings = preset_of(run.source);
    if (!settings) {
        return settings.error();
    }
    if (!options.use_rig && !run.stream.gestures) {
        options.gestures.pinch = false;  // so that a method is not refused for it
    }
    if (run.seed != 0) {
        settings->vary(run.seed);
    }
    if (!run.method.empty()) {
        const auto shown = show_method(run.method, options.gestures, *settings);
        if (!shown) {
            return shown.error();
        }
        if (!shown->colours.empty()) {
            print_error(fmt::format("colour self-test: {}\n", shown->colours));
        }
        print_error(fmt::format("method {}: {}\n", info(shown->verdict.method).name,
                                shown->verdict.reason));
    }
    auto rig = SimulatedRig::create(*settings);
    if (!rig) {
        return rig.error();
    }
    return Session::create(std::unique_ptr<FrameSource>(std::move(*rig)), options);
}

}  // namespace

void add_run(CLI::App& app, int& exit_status) {
    auto* command = app.add_subcommand("run", "Events as they happen, with their latency");
    const auto run = std::make_shared<RunOptions>();
    command
        ->add_option("SOURCE", run->source,
                     "sim, sim:ideal-60, sim:webcam-30, or the folder of a recording, which is "
                     "played at its own pace")
        ->default_str("sim");
    command->add_option("--seed", run->seed, "Simulator: another person, movement and noise")
        ->check(CLI::Validator(
            [](const std::string& text) {
                return text.find_first_not_of("0123456789") != std::string::npos ||
                               text.find_first_not_of("0") == std::string::npos || text.size() > 19
                           ? std::string("must be a whole number from 1 on")
                           : std::string();
            },
            "from 1 on"));
    command
        ->add_option("--method", run->method,
                     "Simulator: what the projector shows; auto or a name from `xtrack methods`")
        ->check(not_empty());
    add_stream_options(*command, run->stream);
#ifndef _WIN32
    command->add_flag("--control", run->stream.control,
                      "Change settings while it runs: NAME=VALUE lines on standard input, as of "
                      "--set; with --mode, mode=hold keeps the images at hand");
#endif
    command->callback([=, &exit_status] {
        SessionOptions options;
        options.pace = Pace::own_pace;
        if (const auto chosen = choose_gestures(run->stream.gestures, options.gestures); !chosen) {
            exit_status = usage(chosen.error());
            return;
        }
        choose_decoding(run->stream, options);
        if (const auto set = apply_settings(run->stream.changes, options.decode); !set) {
            exit_status = usage({set.error().code, "--set " + set.error().message});
            return;
        }
        auto session = open(*run, options);
        if (session) {
            if (const auto possible = check_stream(*session, run->stream); !possible) {
                exit_status = usage(possible.error());
                return;
            }
            exit_status = play(*session, run->stream, options.pace, !is_simulator(run->source));
        } else {
            exit_status = session.error().code == ErrorCode::invalid_argument
                              ? usage(session.error())
                              : fail(with_mode(session.error()));
        }
    });
}

}  // namespace xtrack::tools
