// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdio>
#include <string>

namespace xtrack::tools {

/// Whether a person looks at what is written there.
[[nodiscard]] bool is_terminal(std::FILE* stream);

/// A bar on stderr, shown only when stderr is a terminal and the work has taken over a second.
class Progress {
 public:
    Progress(std::string what, std::size_t steps);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    void step();

 private:
    using Clock = std::chrono::steady_clock;

    std::string what_;
    std::size_t steps_;
    std::size_t done_ = 0;
    bool terminal_;
    bool drawn_ = false;
    Clock::time_point begin_;
    Clock::time_point last_;
};

}  // namespace xtrack::tools
