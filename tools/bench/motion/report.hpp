// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tools/bench/motion/recordings.hpp"
#include "tools/bench/motion/sweep.hpp"

namespace xtrack::tools::bench {

/// All of `xtrack bench --motion`; a list is empty where it was not asked for.
struct MotionReport {
    std::vector<MethodReport> methods;
    std::vector<RecordingReport> recordings;
    std::vector<FastestReport> fastest;
};

/// Tables for people, or one JSON object for programs.
[[nodiscard]] std::string table_of(const MotionReport& report);
[[nodiscard]] std::string json_of(const MotionReport& report);

}  // namespace xtrack::tools::bench
