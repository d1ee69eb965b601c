// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <CLI/App.hpp>
#include <xtrack/recording.hpp>
#include <xtrack/session.hpp>

#include "tools/stream.hpp"

namespace xtrack::tools {

/// What `run` and `record` can look at.
struct SourceOptions {
    std::string source = "sim";
    std::uint64_t seed = 0;
    std::string method;
    bool as_recorded =
        false;  ///< what the session sees is what a recording gives again (AsRecorded)
};

void add_source_options(CLI::App& command, SourceOptions& options);

/// A session, and what its source says of itself.
struct OpenedSource {
    Session session;
    RecordingKind kind = RecordingKind::fringe;  ///< what it gives
    std::optional<Rig> rig;                      ///< none: it has none
    std::optional<PatternSequence> patterns;     ///< of fringes
    double depth_unit_mm = kDepthUnitMm;         ///< of its depth images, where it gives them
};

/// `sim` with a seed is another person on another day; without one it is the same as everywhere.
/// @errors as Session::open(); invalid_argument: an option that the source has no use for
[[nodiscard]] Result<OpenedSource> open_source(const SourceOptions& source,
                                               const StreamOptions& stream, SessionOptions options);

}  // namespace xtrack::tools
