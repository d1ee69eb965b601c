// SPDX-License-Identifier: Apache-2.0
#include <xtrack/decode_settings.hpp>

#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace xtrack {
namespace {

using testing::HasSubstr;

std::string refused(const char* name, const char* text) {
    DecodeSettings settings;
    const auto set = set_field(settings, name, text);
    EXPECT_FALSE(set) << name << '=' << text;
    for (const DecodeField& field : decode_fields()) {
        EXPECT_EQ(field.get(settings), field.standard()) << field.name;
    }
    return set ? "" : set.error().message;
}

TEST(DecodeFields, NameEveryFieldWithARangeThatHoldsItsStandard) {
    std::set<std::string> names;
    for (const DecodeField& field : decode_fields()) {
        EXPECT_TRUE(names.insert(field.name).second) << field.name;
        EXPECT_GE(field.standard(), field.least) << field.name;
        EXPECT_LE(field.standard(), field.most) << field.name;
        EXPECT_LT(field.least, field.most) << field.name;
        // What is written can be read.
        DecodeSettings settings;
        field.set(settings, field.most);
        DecodeSettings other;
        ASSERT_TRUE(set_field(other, field.name, text_of(field, settings))) << field.name;
        EXPECT_EQ(field.get(other), field.most) << field.name;
        EXPECT_TRUE(validate(other)) << field.name;
        field.set(settings, field.most + 1.0);
        if (field.choices.empty()) {
            EXPECT_THAT(validate(settings).error().message, HasSubstr(field.name));
        }
    }
    EXPECT_EQ(names.size(), 17U);
}

TEST(DecodeFields, AreSetByName) {
    DecodeSettings settings;
    ASSERT_TRUE(set_field(settings, "min_modulation", "12.5"));
    ASSERT_TRUE(set_field(settings, "motion", "mask"));
    ASSERT_TRUE(set_field(settings, "mask_saturated", "off"));
    ASSERT_TRUE(set_field(settings, "max_motion_px", "64"));
    EXPECT_EQ(settings.min_modulation, 12.5);
    EXPECT_EQ(settings.motion, MotionHandling::mask);
    EXPECT_FALSE(settings.mask_saturated);
    EXPECT_EQ(settings.max_motion_px, 64);
}

TEST(DecodeFields, SayWhatTheyTake) {
    EXPECT_THAT(refused("min_modulation", "128"), HasSubstr("0 to 127, grey levels"));
    EXPECT_THAT(refused("min_modulation", "nan"), HasSubstr("min_modulation"));
    EXPECT_THAT(refused("min_modulation", ""), HasSubstr("a number"));
    EXPECT_THAT(refused("min_modulation", "6x"), HasSubstr("a number"));
    EXPECT_THAT(refused("max_motion_px", "10.5"), HasSubstr("a whole number"));
    EXPECT_THAT(refused("motion", "fast"), HasSubstr("off, mask, follow"));
    EXPECT_THAT(refused("motion", "1"), HasSubstr("off, mask, follow"));
    EXPECT_THAT(refused("modulation", "1"), HasSubstr("they are min_modulation"));
}

}  // namespace
}  // namespace xtrack
