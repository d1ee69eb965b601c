// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <xtrack/recording.hpp>

#include "tools/commands.hpp"
#include "tools/stream.hpp"

namespace xtrack::tools {

void add_replay(CLI::App& app, int& exit_status) {
    auto* command = app.add_subcommand(
        "replay", "Events of a recording (fringes, depth or joints): deterministic, drops nothing");
    const auto folder = std::make_shared<std::string>();
    const auto stream = std::make_shared<StreamOptions>();
    command->add_option("REC", *folder, "Folder of the recording")->required();
    add_stream_options(*command, *stream);
    command->callback([=, &exit_status] {
        const auto options = session_options(*stream, Pace::replay);
        if (!options) {
            exit_status = usage(options.error());
            return;
        }
        auto session = Session::open(*folder, *options);
        if (!session) {
            exit_status = fail(with_mode(session.error()));
            return;
        }
        if (const auto possible = check_stream(*session, *stream); !possible) {
            exit_status = usage(possible.error());
            return;
        }
        const auto recording = RecordingReader::open(*folder);
        const std::size_t items = recording ? recording->entries().size() : 0;
        exit_status = play(*session, *stream, options->pace, true, items);
        if (exit_status == 0 && recording && recording->kind() == RecordingKind::fringe &&
            session->statistics().depth_frames == 0) {
            exit_status = fail(no_complete_set(*recording));
        }
    });
}

}  // namespace xtrack::tools
