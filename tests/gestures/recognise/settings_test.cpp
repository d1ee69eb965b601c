// SPDX-License-Identifier: Apache-2.0
#include <xtrack/gesture_settings.hpp>

#include <limits>

#include <gmock/gmock.h>
#include <xtrack/gesture_recogniser.hpp>

namespace xtrack::test {
namespace {

using ::testing::HasSubstr;

TEST(Settings, DefaultsAreValid) { EXPECT_TRUE(validate({}).ok()); }

TEST(Settings, ARefusalNamesSettingValueAndRange) {
    GestureSettings s;
    s.swipe_speed_mmps = 30000.0;
    const auto made = GestureRecogniser::create(s);
    ASSERT_FALSE(made.ok());
    EXPECT_EQ(made.error().code, ErrorCode::invalid_argument);
    EXPECT_THAT(made.error().message, HasSubstr("swipe_speed_mmps is 30000; give 100 to 3000"));
}

TEST(Settings, NotANumberIsOutOfRange) {
    GestureSettings s;
    s.lost_freeze_ms = std::numeric_limits<double>::quiet_NaN();
    ASSERT_FALSE(validate(s).ok());
    EXPECT_THAT(validate(s).error().message, HasSubstr("lost_freeze_ms is not a number"));
}

TEST(Settings, HysteresisIsThreeSigma) {
    GestureSettings s;
    s.pinch_noise_mm = 3.5;
    ASSERT_FALSE(validate(s).ok());
    EXPECT_THAT(validate(s).error().message,
                HasSubstr("pinch_release_mm is 30; give at least 30.5"));
    s.pinch_release_mm = 31.0;
    EXPECT_TRUE(validate(s).ok());
}

TEST(Settings, RelationsAreChecked) {
    GestureSettings open;
    open.pinch_open_mm = 25.0;
    EXPECT_FALSE(validate(open).ok());
    GestureSettings gone;
    gone.gone_ms = 150.0;
    gone.lost_freeze_ms = 200.0;
    EXPECT_FALSE(validate(gone).ok());
    GestureSettings slow;
    slow.swipe_dies_mmps = 400.0;
    EXPECT_FALSE(validate(slow).ok());
}

TEST(Settings, ANameThatIsNoneOfThemGetsThoseThatBeginAlike) {
    GestureSettings s;
    const auto slip = set_field(s, "pull_lenght_mm", "150");
    ASSERT_FALSE(slip.ok());
    EXPECT_EQ(slip.error().code, ErrorCode::invalid_argument);
    EXPECT_THAT(slip.error().message,
                HasSubstr("'pull_lenght_mm' is none of them; there is pull, pull_length_mm"));
    const auto nothing = set_field(s, "xq", "1");
    ASSERT_FALSE(nothing.ok());
    EXPECT_THAT(nothing.error().message, ::testing::EndsWith("'xq' is none of them"));
}

}  // namespace
}  // namespace xtrack::test
