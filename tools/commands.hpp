// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <CLI/App.hpp>
#include <CLI/Validators.hpp>

namespace xtrack::tools {

/// Refuses an empty value, as a shell makes it of a variable that is not set.
[[nodiscard]] inline CLI::Validator not_empty() {
    return CLI::Validator(
        [](const std::string& text) { return std::string(text.empty() ? "is empty" : ""); }, "",
        "not_empty");
}

// One function a subcommand, in the file of its name: adds the command to `app`; when it runs it
// sets `exit_status` (0 done, 1 failed, 2 wrong usage).
void add_bench(CLI::App& app, int& exit_status);
void add_calibrate(CLI::App& app, int& exit_status);
void add_corpus(CLI::App& app, int& exit_status);
void add_decode(CLI::App& app, int& exit_status);
void add_demo(CLI::App& app, int& exit_status);
void add_eval(CLI::App& app, int& exit_status);
void add_methods(CLI::App& app, int& exit_status);
void add_record(CLI::App& app, int& exit_status);
void add_replay(CLI::App& app, int& exit_status);
void add_run(CLI::App& app, int& exit_status);

}  // namespace xtrack::tools
