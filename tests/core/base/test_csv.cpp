// SPDX-License-Identifier: Apache-2.0
#include "core/base/csv.hpp"

#include <string>

#include <gtest/gtest.h>

namespace xtrack::base {
namespace {

TEST(Csv, ColumnsAreFoundByNameInAnyOrder) {
    auto csv = CsvReader::open("b, a ,other\r\n1,2,x\r\n\r\n3,4,\n", "f.csv");
    ASSERT_TRUE(csv.ok()) << csv.error().message;
    EXPECT_EQ(*csv->column("a"), 1U);
    EXPECT_FALSE(csv->column("c").has_value());
    ASSERT_TRUE(*csv->next());
    EXPECT_EQ(*csv->int_field(1, 0, 9), 2);
    EXPECT_EQ(csv->field(2), "x");
    ASSERT_TRUE(*csv->next());
    EXPECT_EQ(csv->line(), 4U);
    EXPECT_EQ(csv->field(0), "3");
    EXPECT_EQ(csv->field(2), "");
    EXPECT_FALSE(*csv->next());
}

TEST(Csv, MessagesNameFileLineFieldAndMend) {
    auto csv = CsvReader::open("a,b\n1,many\n", "f.csv");
    ASSERT_TRUE(csv.ok());
    ASSERT_TRUE(*csv->next());
    EXPECT_EQ(csv->int_field(1, 0, 5).error().message,
              "f.csv line 2: b is 'many'; give a whole number from 0 to 5");
    EXPECT_EQ(csv->number_field(0, 2.5, 3).error().message,
              "f.csv line 2: a is '1'; give a number from 2.5 to 3");
    EXPECT_EQ(csv->required_column("c").error().message,
              "f.csv line 1: column 'c' is missing; add it to the header and every row");
}

TEST(Csv, StampsAreMicrosecondsAndDoNotDecrease) {
    auto csv = CsvReader::open("t_us\n-7\n3155760000000001\n", "f.csv");
    ASSERT_TRUE(csv.ok());
    ASSERT_TRUE(*csv->next());
    EXPECT_EQ(*csv->stamp_field(0, std::nullopt), Stamp::from_us(-7));
    EXPECT_EQ(*csv->stamp_field(0, Stamp::from_us(-7)), Stamp::from_us(-7));
    EXPECT_EQ(csv->stamp_field(0, Stamp::from_us(-6)).error().message,
              "f.csv line 2: t_us is '-7'; time goes backwards, sort the rows by t_us");
    ASSERT_TRUE(*csv->next());
    EXPECT_TRUE(csv->stamp_field(0, std::nullopt).ok());
}

TEST(Csv, BrokenShapesAreRefused) {
    EXPECT_FALSE(CsvReader::open("", "f.csv").ok());
    EXPECT_FALSE(CsvReader::open("a,b,a\n", "f.csv").ok());
    EXPECT_FALSE(CsvReader::open(std::string(9000, 'a'), "f.csv").ok());
    EXPECT_FALSE(CsvReader::open(std::string(5000, ','), "f.csv").ok());
    const auto message_of_next = [](const std::string& text, CsvLimits limits) {
        auto csv = CsvReader::open(text, "f.csv", limits);
        while (true) {
            const auto more = csv->next();
            if (!more) {
                return more.error().message;
            }
            if (!*more) {
                return std::string();
            }
        }
    };
    EXPECT_EQ(message_of_next("a\n1,2\n", {}),
              "f.csv line 2: has 2 fields, the header has 1; make them agree");
    EXPECT_EQ(message_of_next("a,b\n1,2\n1\n", {}),
              "f.csv line 3: has 1 fields, the header has 2; make them agree");
    EXPECT_EQ(message_of_next("a\n" + std::string(100, '1') + "\n", {50, 10, 10}),
              "f.csv line 2: is over 50 bytes long; break it");
    EXPECT_EQ(message_of_next("a\n1\n1\n1\n", {50, 2, 10}),
              "f.csv line 4: comes after 2 rows; split the recording");
}

}  // namespace
}  // namespace xtrack::base
