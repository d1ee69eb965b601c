// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace xtrack::tools::bench {

/// A form of the kernels that was compiled and that this CPU can run.
struct InstructionSet {
    std::string name;
    std::int64_t target = 0;  ///< Highway's bit; 0 in a build without Highway
};

/// From the plainest to the one that is chosen by default; never empty.
[[nodiscard]] std::vector<InstructionSet> instruction_sets();

/// Makes all kernels of this process use it.
void use(const InstructionSet& set);

}  // namespace xtrack::tools::bench
