// SPDX-License-Identifier: Apache-2.0
#include "tools/bench/instruction_sets.hpp"

#include <algorithm>

#if XTRACK_WITH_HIGHWAY
#include <hwy/targets.h>
#endif

namespace xtrack::tools::bench {

#if XTRACK_WITH_HIGHWAY

std::vector<InstructionSet> instruction_sets() {
    std::vector<InstructionSet> all;
    // The lowest bit is the best. What the CPU has and was not compiled would run as the plainest.
    for (auto rest = hwy::SupportedTargets() & HWY_TARGETS; rest != 0; rest &= rest - 1) {
        const auto target = rest & -rest;
        all.push_back({hwy::TargetName(target), target});
    }
    std::reverse(all.begin(), all.end());
    return all;
}

void use(const InstructionSet& set) {
    // Named for tests, it is the way to mock a CPU that has no more; 0 would lift it.
    hwy::SetSupportedTargetsForTest(set.target);
    hwy::GetChosenTarget().Update(set.target);
}

#else

std::vector<InstructionSet> instruction_sets() { return {{"scalar", 0}}; }

void use(const InstructionSet& /*set*/) {}

#endif

}  // namespace xtrack::tools::bench
