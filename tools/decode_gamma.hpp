// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <xtrack/pattern.hpp>
#include <xtrack/recording.hpp>
#include <xtrack/result.hpp>

namespace xtrack::tools {

/// Phases of the shortest grey period, in the order of the sequence; empty: there is none.
[[nodiscard]] std::vector<double> shortest_phases(const PatternSequence& patterns);

/// The recording's patterns with the projector's response that `--gamma` asks for.
/// @param wanted absent: as the recording says; `auto`: found from the fringes of the first set;
///        else a number
/// @errors invalid_argument: no such number; unsupported: the fringes do not tell
[[nodiscard]] Result<PatternSequence> with_gamma(const RecordingReader& recording,
                                                 const std::optional<std::string>& wanted);

/// Why `wanted` is none that `--gamma` takes; empty: it is one, or absent.
[[nodiscard]] std::string gamma_complaint(const std::optional<std::string>& wanted);

}  // namespace xtrack::tools
