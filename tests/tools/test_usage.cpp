// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <string>

#include <gmock/gmock.h>

#include "tests/tools/command.hpp"

namespace xtrack::test {
namespace {

using testing::HasSubstr;

struct Mistake {
    const char* name;
    std::vector<std::string> arguments;
    const char* said;
};

class WrongUsage : public testing::TestWithParam<Mistake> {};

TEST_P(WrongUsage, ExitsWithTwoAndSaysWhyInOneLine) {
    const Outcome outcome = xtrack_command(GetParam().arguments);
    EXPECT_EQ(outcome.status, 2);
    EXPECT_EQ(outcome.out, "");
    EXPECT_TRUE(is_one_line_message(outcome.err)) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(GetParam().said));
}

INSTANTIATE_TEST_SUITE_P(
    Each, WrongUsage,
    testing::Values(
        Mistake{"no_subcommand", {}, "subcommand"},
        Mistake{"unknown_subcommand", {"frobnicate"}, "frobnicate"},
        Mistake{"unknown_option", {"--frobnicate"}, "--frobnicate"},
        Mistake{"unknown_option_of_subcommand", {"run", "--frobnicate"}, "--frobnicate"},
        Mistake{"missing_argument", {"replay"}, "REC"},
        Mistake{"missing_option", {"decode", "nowhere"}, "--out"},
        Mistake{"too_many_arguments", {"replay", "one", "two"}, "two"},
        Mistake{"number_that_is_none", {"run", "--seed", "many"}, "--seed"},
        Mistake{"number_out_of_range", {"demo", "--seeds", "0"}, "--seeds"},
        Mistake{"pictures_of_seeds", {"demo", "--seeds", "1", "--out", "x"}, "--out"},
        Mistake{"seeds_without_a_clock", {"demo", "--seeds", "1", "--fast"}, "--fast"},
        Mistake{"setting_out_of_range",
                {"decode", "nowhere", "--out", "x", "--min-modulation", "-3"},
                "min_modulation"},
        Mistake{
            "unknown_export", {"decode", "nowhere", "--out", "x", "--export", "ply,nix"}, "nix"},
        Mistake{"no_export", {"decode", "nowhere", "--out", "x", "--export", ""}, "--export"},
        Mistake{"unknown_format", {"run", "--events", "xml"}, "--events"},
        Mistake{"no_gamma", {"decode", "nowhere", "--out", "x", "--gamma", ""}, "'' is neither"},
        Mistake{"gamma_of_words", {"decode", "nowhere", "--out", "x", "--gamma", "much"}, "'much'"},
        Mistake{
            "gamma_out_of_range", {"decode", "nowhere", "--out", "x", "--gamma", "9"}, "0.3 to 4"},
        Mistake{"size_that_is_none", {"bench", "--size", "640x480,nix"}, "nix"},
        Mistake{"size_without_pixels", {"bench", "--size", "640x0"}, "640x0"},
        Mistake{"no_repetitions", {"bench", "--repetitions", "0"}, "--repetitions"},
        Mistake{"papers_table_has_one_size", {"bench", "--paper", "--size", "64x48"}, "--paper"},
        Mistake{"no_gesture", {"run", "--gestures", ""}, "'' is not known"},
        Mistake{"unknown_preset", {"run", "sim:nix"}, "nix"},
        Mistake{"seed_of_a_folder", {"run", "nowhere", "--seed", "3"}, "only the simulator"},
        Mistake{"unknown_gesture_of_run", {"run", "--gestures", "nonsense"}, "nonsense"},
        Mistake{"unknown_gesture_of_replay",
                {"replay", "nowhere", "--gestures", "swipe,nonsense"},
                "nonsense"},
        Mistake{
            "unknown_gesture_of_eval", {"eval", "nowhere", "--gestures", "nonsense"}, "nonsense"}),
    [](const auto& each) { return std::string(each.param.name); });

class Help : public testing::TestWithParam<const char*> {};

TEST_P(Help, IsOnStdoutAndNamesTheOptions) {
    const Outcome outcome = xtrack_command({GetParam(), "--help"});
    EXPECT_EQ(outcome.status, 0);
    EXPECT_EQ(outcome.err, "");
    EXPECT_THAT(outcome.out, HasSubstr(std::string("Usage: xtrack ") + GetParam()));
    EXPECT_THAT(outcome.out, HasSubstr("--json"));
}

INSTANTIATE_TEST_SUITE_P(Each, Help,
                         testing::Values("run", "replay", "record", "eval", "demo", "decode",
                                         "bench"),
                         [](const auto& each) { return std::string(each.param); });

TEST(Usage, HelpOfTheCommandNamesEverySubcommand) {
    const Outcome outcome = xtrack_command({"--help"});
    EXPECT_EQ(outcome.status, 0);
    for (const char* name :
         {"run", "replay", "record", "eval", "demo", "decode", "calibrate", "bench"}) {
        EXPECT_THAT(outcome.out, HasSubstr(std::string("\n  ") + name + " "));
    }
}

TEST(Usage, VersionIsANumber) {
    const Outcome outcome = xtrack_command({"--version"});
    EXPECT_EQ(outcome.status, 0);
    EXPECT_THAT(outcome.out, testing::MatchesRegex("[0-9]+\\.[0-9]+\\.[0-9]+\n"));
}

TEST(Readme, ShowsTheExampleWordForWord) {
    const std::filesystem::path project = XTRACK_TEST_DATA "/../..";
    const std::string readme = text_of(project / "README.md");
    const std::string hello = text_of(project / "examples/hello/hello.cpp");
    ASSERT_FALSE(hello.empty());
    const std::string program = hello.substr(hello.find("#include"));  // without the licence
    EXPECT_THAT(readme, HasSubstr("```cpp\n" + program + "```\n"));
}

}  // namespace
}  // namespace xtrack::test
