// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <exception>
#include <new>
#include <string>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "tools/commands.hpp"
#include "tools/stream.hpp"

namespace {

// One line that says what was wrong, as for every other mistake. CLI11 notices what is missing
// before what is unknown, though the unknown word is mostly the reason.
std::string usage_message(const CLI::App* app, const CLI::Error& error) {
    const auto unknown = app->remaining(true);
    const std::string what =
        unknown.empty() ? error.what() : fmt::format("'{}' is not known", unknown.front());
    return fmt::format("xtrack: {}; --help lists what is\n", what);
}

int run(int argc, char** argv) {
    CLI::App app("xTrack: depth from projected fringes, hands from depth, gestures from hands",
                 "xtrack");
    app.set_version_flag("--version", XTRACK_VERSION);
    app.require_subcommand(1);
    app.failure_message(usage_message);
    int exit_status = 0;
    xtrack::tools::add_run(app, exit_status);
    xtrack::tools::add_methods(app, exit_status);
    xtrack::tools::add_replay(app, exit_status);
    xtrack::tools::add_record(app, exit_status);
    xtrack::tools::add_eval(app, exit_status);
    xtrack::tools::add_demo(app, exit_status);
    xtrack::tools::add_corpus(app, exit_status);
    xtrack::tools::add_calibrate(app, exit_status);
    xtrack::tools::add_decode(app, exit_status);
    xtrack::tools::add_bench(app, exit_status);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        // CLI11 gives every kind of mistake a number of its own; users know one: wrong usage.
        return app.exit(error) == 0 ? 0 : 2;
    }
    return exit_status;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        const int status = run(argc, argv);
        // What is still in the buffer fails last, and what failed before is remembered.
        if (status == 0 && (std::fflush(stdout) != 0 || std::ferror(stdout) != 0)) {
            return xtrack::tools::fail({xtrack::ErrorCode::io,
                                        "the answer cannot be written; is the disk full, or what "
                                        "reads it gone?"});
        }
        return status;
    } catch (const std::bad_alloc&) {
        return xtrack::tools::fail({xtrack::ErrorCode::io,
                                    "not enough memory; close other programs, or use smaller "
                                    "images"});
    } catch (const std::exception& error) {
        return xtrack::tools::fail({xtrack::ErrorCode::io, error.what()});
    }
}
