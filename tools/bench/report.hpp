// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <xtrack/geometry.hpp>

#include "tools/bench/paper.hpp"
#include "tools/bench/timing.hpp"

namespace xtrack::tools::bench {

/// What was measured at one size.
struct SizeReport {
    Size size;
    std::size_t ring_bytes = 0;
    double depth_error_mm = 0.0;  ///< median of |depth - wall|, three steps
    std::vector<Measured> ours;   ///< each name with every instruction set, the best last
    std::vector<Measured> peers;  ///< opencv_contrib is missing where it is not built in
};

/// `model name` of /proc/cpuinfo, or "unknown".
[[nodiscard]] std::string cpu_model();

/// A table for people, or one JSON object for programs.
[[nodiscard]] std::string table_of(const std::string& cpu, std::size_t rounds,
                                   const std::vector<SizeReport>& reports);
[[nodiscard]] std::string json_of(const std::string& cpu, std::size_t rounds,
                                  const std::vector<SizeReport>& reports);
[[nodiscard]] std::string table_of(const std::string& cpu, const PaperTimes& times);
[[nodiscard]] std::string json_of(const std::string& cpu, const PaperTimes& times);

}  // namespace xtrack::tools::bench
