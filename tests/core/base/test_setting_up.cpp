// SPDX-License-Identifier: Apache-2.0
#include "core/base/setting_up.hpp"

#include <functional>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace xtrack::base {
namespace {

using testing::StartsWith;

Result<int> throwing(const std::function<void()>& act, const char* culprit = nullptr) {
    return setting_up("The rig", culprit, [&]() -> Result<int> {
        act();
        return 7;
    });
}

TEST(SettingUp, GivesWhatWasMade) {
    EXPECT_EQ(*throwing([] {}), 7);
}

TEST(SettingUp, LackOfMemoryIsAnErrorOfOneKind) {
    for (const char* culprit : {static_cast<const char*>(nullptr), "the source threw"}) {
        const auto made = throwing([] { throw std::bad_alloc(); }, culprit);
        ASSERT_FALSE(made);
        EXPECT_EQ(made.error().code, ErrorCode::io);
        EXPECT_THAT(made.error().message, StartsWith("The rig: not enough memory; "));
    }
}

// Only where a caller's code runs is the caller to blame.
TEST(SettingUp, NamesWhoThrew) {
    const auto ours = throwing([] { throw std::runtime_error("no such drive"); });
    ASSERT_FALSE(ours);
    EXPECT_EQ(ours.error().code, ErrorCode::io);
    EXPECT_EQ(ours.error().message, "The rig: no such drive");
    const auto theirs =
        throwing([] { throw std::runtime_error("not plugged in"); }, "the source threw");
    ASSERT_FALSE(theirs);
    EXPECT_EQ(theirs.error().code, ErrorCode::invalid_argument);
    EXPECT_EQ(theirs.error().message, "The rig: the source threw: not plugged in");
    EXPECT_EQ(throwing([] { throw 3; }).error().message, "The rig: something unknown was thrown");
}

}  // namespace
}  // namespace xtrack::base
