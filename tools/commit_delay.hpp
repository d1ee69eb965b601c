// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include <xtrack/labels.hpp>
#include <xtrack/scoring.hpp>

namespace xtrack::tools {

/// How long after its definition was fulfilled a gesture that was found was told.
struct CommitDelay {
    std::string gesture;
    double ms = 0.0;
};
/// @param labels the events were judged by; those without a commit say nothing
[[nodiscard]] std::vector<CommitDelay> delays_after_commit(std::span<const JudgedEvent> events,
                                                           std::span<const GestureLabel> labels);

}  // namespace xtrack::tools
