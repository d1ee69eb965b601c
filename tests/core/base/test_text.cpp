// SPDX-License-Identifier: Apache-2.0
#include "core/base/text.hpp"

#include <string>

#include <gtest/gtest.h>

namespace xtrack::base {
namespace {

TEST(Text, NumbersAreTakenWholeOrNotAtAll) {
    EXPECT_EQ(parse_int("-42"), -42);
    EXPECT_EQ(parse_int("+42"), 42);
    for (const char* bad : {"", " 1", "1 ", "1.0", "0x10", "+-1", "99999999999999999999"}) {
        EXPECT_FALSE(parse_int(bad).has_value()) << bad;
    }
    EXPECT_EQ(parse_double("-1.5e3"), -1500.0);
    EXPECT_EQ(parse_double("+.5"), 0.5);
    for (const char* bad : {"", "nan", "inf", "-INF", "1,5", "1e999", "1.0mm"}) {
        EXPECT_FALSE(parse_double(bad).has_value()) << bad;
    }
}

TEST(Text, NumbersReadBackTheSame) {
    for (const double v : {0.1, -2.0943951023931953, 1e300, 2195.120361328125}) {
        EXPECT_EQ(parse_double(number_text(v)), v);
    }
}

TEST(Text, QuotesAreShortAndPlain) {
    EXPECT_EQ(base::quoted("a\tb\x1b[31m"), "'a?b?[31m'");
    EXPECT_EQ(base::quoted(std::string(100, 'x')), "'" + std::string(40, 'x') + "...'");
}

TEST(Text, FixedDigitsHaveNoSignOfNothing) {
    std::string text;
    for (const float v : {1.25F, -0.04F, 0.0F, -12.96F, 3e38F}) {
        append_fixed(text, v, 1);
        text += ' ';
    }
    EXPECT_EQ(text.substr(0, 21), "1.2 0.0 0.0 -13.0 300");
    EXPECT_EQ(text.size(), 18U + 42U);
}

}  // namespace
}  // namespace xtrack::base
