// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace xtrack::tools::bench {

/// One of several things that are timed in turns.
struct Contender {
    std::string name;
    std::string instruction_set;    ///< empty: not chosen by us
    std::function<void()> prepare;  ///< not timed; may be empty
    std::function<void()> run;
};

struct Times {
    std::size_t repetitions = 0;
    double median_us = 0.0;
    double p99_us = 0.0;  ///< the slowest where there are less than 100 repetitions
    double least_us = 0.0;
};

struct Measured {
    std::string name;
    std::string instruction_set;
    Times times;
};

/// Of unsorted durations, at least one; nearest rank.
[[nodiscard]] Times times_of(std::vector<double> durations_us);

/// Rounds in which every contender runs once, in an order drawn anew for each round: whatever else
/// the machine does hits all alike, and none always follows the same one. What takes long takes
/// part in few of the rounds. Each contender runs once untimed before.
/// @param step called after each round
[[nodiscard]] std::vector<Measured> measure(const std::vector<Contender>& contenders,
                                            std::size_t rounds, const std::function<void()>& step);

}  // namespace xtrack::tools::bench
