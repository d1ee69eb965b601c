// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#if XTRACK_WITH_HIGHWAY
#include <hwy/targets.h>
#endif

namespace xtrack::test {

/// Runs `check` once for every instruction set that was compiled and that this CPU has.
template <typename Check>
void for_each_target(const Check& check) {
#if XTRACK_WITH_HIGHWAY
    const auto supported = hwy::SupportedTargets();
    int count = 0;
    for (auto rest = supported; rest != 0; rest &= rest - 1) {
        const auto target = rest & -rest;
        SCOPED_TRACE(hwy::TargetName(target));
        hwy::SetSupportedTargetsForTest(target);
        hwy::GetChosenTarget().Update(hwy::SupportedTargets());
        check();
        ++count;
    }
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    EXPECT_GE(count, 1);
#else
    check();
#endif
}

}  // namespace xtrack::test
