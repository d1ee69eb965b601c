// SPDX-License-Identifier: Apache-2.0
#include "core/base/file.hpp"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace xtrack::base {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

// A folder of its own for each test, empty and removed after it.
class FileTest : public testing::Test {
 protected:
    FileTest() {
        const auto* test = testing::UnitTest::GetInstance()->current_test_info();
        folder_ = fs::path(testing::TempDir()) / (std::string("xtrack_file_") + test->name());
        fs::remove_all(folder_);
        fs::create_directories(folder_);
    }
    ~FileTest() override { fs::remove_all(folder_); }
    [[nodiscard]] std::size_t entries() const {
        return static_cast<std::size_t>(
            std::distance(fs::directory_iterator(folder_), fs::directory_iterator{}));
    }
    fs::path folder_;
};

TEST_F(FileTest, WritesWholeAndForWhomTheUmaskSays) {
    const fs::path file = folder_ / "a.txt";
    ASSERT_TRUE(write_file(file, "one").ok());
    ASSERT_TRUE(write_file(file, "two").ok());
    EXPECT_EQ(*read_file(file, 3), "two");
    EXPECT_EQ(entries(), 1U);
    const fs::path plain = folder_ / "plain.txt";
    std::ofstream(plain) << "x";
    EXPECT_EQ(fs::status(file).permissions(), fs::status(plain).permissions());
    auto made = NewFolder::create(folder_ / "out");
    ASSERT_TRUE(made.ok());
    ASSERT_TRUE(made->make_folder("in").ok());
    ASSERT_TRUE(made->write("in/b.txt", "x").ok());
    ASSERT_TRUE(made->commit().ok());
    fs::create_directory(folder_ / "plain");
    const fs::perms of_folder = fs::status(folder_ / "plain").permissions();
    EXPECT_EQ(fs::status(folder_ / "out").permissions(), of_folder);
    EXPECT_EQ(fs::status(folder_ / "out/in").permissions(), of_folder);
    EXPECT_EQ(fs::status(folder_ / "out/in/b.txt").permissions(), fs::status(plain).permissions());
}

TEST_F(FileTest, RefusesWhatItCannotRead) {
    ASSERT_TRUE(write_file(folder_ / "big", "12345").ok());
    const auto big = read_file(folder_ / "big", 4);
    ASSERT_FALSE(big.ok());
    EXPECT_THAT(big.error().message, HasSubstr("5 bytes long; at most 4"));
    EXPECT_EQ(read_file(folder_ / "none", 4).error().code, ErrorCode::not_found);
    EXPECT_EQ(read_file(folder_, 4).error().code, ErrorCode::io);
    EXPECT_FALSE(write_file(folder_ / "none" / "a", "x").ok());
}

TEST_F(FileTest, ReadsTheStartOfAFile) {
    ASSERT_TRUE(write_file(folder_ / "a", "12345").ok());
    EXPECT_EQ(*read_start(folder_ / "a", 3), "123");
    EXPECT_EQ(*read_start(folder_ / "a", 9), "12345");
    const auto none = read_start(folder_ / "none", 3);
    ASSERT_FALSE(none.ok());
    EXPECT_EQ(none.error().code, ErrorCode::io);
    EXPECT_THAT(none.error().message, HasSubstr("none: cannot be opened: No such file"));
}

TEST_F(FileTest, NewFolderAppearsAtCommit) {
    auto made = NewFolder::create(folder_ / "out/");
    ASSERT_TRUE(made.ok()) << made.error().message;
    ASSERT_TRUE(made->make_folder("a/b").ok());
    ASSERT_TRUE(made->write("a/b/c.txt", "x").ok());
    EXPECT_FALSE(fs::exists(folder_ / "out"));
    ASSERT_TRUE(made->commit().ok());
    EXPECT_EQ(*read_file(folder_ / "out/a/b/c.txt", 9), "x");
    EXPECT_EQ(entries(), 1U);
}

TEST_F(FileTest, NewFolderAddsToAFile) {
    auto made = NewFolder::create(folder_ / "out");
    ASSERT_TRUE(made.ok());
    ASSERT_TRUE(made->append("list.csv", "a\n").ok());
    ASSERT_TRUE(made->append("list.csv", "b\n").ok());
    EXPECT_EQ(*read_file(made->path() / "list.csv", 9), "a\nb\n");
    const auto refused = made->append("missing/list.csv", "c\n");
    ASSERT_FALSE(refused.ok());
    EXPECT_THAT(refused.error().message, HasSubstr("out/missing/list.csv: cannot be written"));
    EXPECT_FALSE(made->append("../list.csv", "c\n").ok());
    ASSERT_TRUE(made->commit().ok());
    EXPECT_EQ(*read_file(folder_ / "out" / "list.csv", 9), "a\nb\n");
}

TEST_F(FileTest, NewFolderWritesNothingOutside) {
    std::ofstream(folder_ / "precious.txt") << "mine";
    auto made = NewFolder::create(folder_ / "out");
    ASSERT_TRUE(made.ok());
    const std::string outside = (folder_ / "precious.txt").string();
    for (const std::string& name : {std::string("../precious.txt"), outside, std::string()}) {
        const auto written = made->write(name, "x");
        ASSERT_FALSE(written.ok()) << name;
        EXPECT_EQ(written.error().code, ErrorCode::invalid_argument) << name;
        EXPECT_THAT(written.error().message, HasSubstr("inside the folder")) << name;
    }
    EXPECT_FALSE(made->make_folder("../beside").ok());
    EXPECT_FALSE(made->make_folder("a/../../beside").ok());
    EXPECT_FALSE(fs::exists(folder_ / "beside"));
    EXPECT_EQ(*read_file(folder_ / "precious.txt", 9), "mine");
}

TEST_F(FileTest, NewFolderLeavesNothingWithoutCommit) {
    {
        auto made = NewFolder::create(folder_ / "out");
        ASSERT_TRUE(made.ok());
        ASSERT_TRUE(made->write("c.txt", "x").ok());
        EXPECT_EQ(entries(), 1U);
    }
    EXPECT_EQ(entries(), 0U);
}

TEST_F(FileTest, NewFolderTakesAnEmptyFoldersPlaceAndNoOther) {
    fs::create_directory(folder_ / "out");
    auto made = NewFolder::create(folder_ / "out");
    ASSERT_TRUE(made.ok()) << made.error().message;
    ASSERT_TRUE(made->write("new.txt", "x").ok());
    ASSERT_TRUE(made->commit().ok());
    EXPECT_TRUE(fs::exists(folder_ / "out" / "new.txt"));
    EXPECT_FALSE(NewFolder::create(folder_ / "out").ok());
    EXPECT_FALSE(NewFolder::create(folder_ / "out" / "new.txt").ok());
    EXPECT_FALSE(NewFolder::create(folder_ / "missing" / "out").ok());
    EXPECT_FALSE(NewFolder::create("").ok());
    EXPECT_EQ(entries(), 1U);
}

TEST_F(FileTest, WhatAppearsBeforeTheCommitIsSafe) {
    fs::create_directory(folder_ / "out");
    auto made = NewFolder::create(folder_ / "out");
    ASSERT_TRUE(made.ok());
    ASSERT_TRUE(made->write("new.txt", "x").ok());
    std::ofstream(folder_ / "out" / "precious.txt") << "mine";
    EXPECT_FALSE(made->commit().ok());
    EXPECT_EQ(*read_file(folder_ / "out" / "precious.txt", 9), "mine");
    EXPECT_FALSE(fs::exists(folder_ / "out" / "new.txt"));
    EXPECT_EQ(entries(), 1U);
}

TEST(StaysInside, KnowsEscapes) {
    for (const char* good : {"a.png", "frames/000.png", "a..b/c", ".hidden"}) {
        EXPECT_TRUE(stays_inside(good)) << good;
    }
    for (const char* bad :
         {"", "/etc/passwd", "../a", "../../etc/passwd", "a/../../b", "a/..", "..\\a", "C:\\a",
          "\\\\host\\a", "a//b", "a:b", "frames/", "a\x1b[2Jb", "a\nb", "a\x7f"}) {
        EXPECT_FALSE(stays_inside(bad)) << bad;
    }
    EXPECT_FALSE(stays_inside(std::string_view("a\0b", 3)));
}

}  // namespace
}  // namespace xtrack::base
