// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <map>
#include <set>
#include <thread>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include <xtrack/depth_decoder.hpp>

#include "tests/tools/command.hpp"
#include "tools/bench/timing.hpp"

namespace xtrack::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::UnorderedElementsAre;

std::set<std::string> keys_of(const json& object) {
    std::set<std::string> keys;
    for (const auto& [key, value] : object.items()) {
        keys.insert(key);
    }
    return keys;
}

void expect_times(const json& times, std::size_t repetitions) {
    // What takes long, as all does on a busy machine, is run less often.
    EXPECT_GE(times.at("repetitions"), 1);
    EXPECT_LE(times.at("repetitions"), repetitions);
    EXPECT_GT(times.at("min_us"), 0.0);
    EXPECT_LE(times.at("min_us"), times.at("median_us"));
    EXPECT_LE(times.at("median_us"), times.at("p99_us"));
}

// Median of each name with the best instruction set, which comes last.
std::map<std::string, double> medians(const json& list) {
    std::map<std::string, double> all;
    for (const json& entry : list) {
        if (entry.contains("median_us")) {
            all[entry.at("name")] = entry.at("median_us");
        }
    }
    return all;
}

TEST(Bench, SaysAllFiguresAsJson) {
    const Outcome outcome =
        xtrack_command({"bench", "--json", "--size", "64x48,96x64", "--repetitions", "3"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const json answer = json::parse(outcome.out);
    EXPECT_THAT(keys_of(answer), UnorderedElementsAre("cpu", "cores", "repetitions", "sizes"));
    EXPECT_NE(answer.at("cpu"), "");
    EXPECT_EQ(answer.at("cores"), 1);
    EXPECT_EQ(answer.at("repetitions"), 3);
    ASSERT_EQ(answer.at("sizes").size(), 2U);
    EXPECT_EQ(answer.at("sizes")[1].at("width"), 96);
    const json& size = answer.at("sizes")[0];
    EXPECT_THAT(keys_of(size),
                UnorderedElementsAre("width", "height", "ring_bytes", "depth_error_mm", "stages",
                                     "whole", "peers", "ratios"));
    EXPECT_EQ(size.at("width"), 64);
    EXPECT_EQ(size.at("height"), 48);
    EXPECT_GT(size.at("ring_bytes"), 64U << 20U);
    EXPECT_LT(size.at("depth_error_mm"), 1.0);

    std::map<std::string, std::vector<std::string>> sets;
    for (const char* kind : {"stages", "whole"}) {
        for (const json& entry : size.at(kind)) {
            expect_times(entry, 3);
            sets[entry.at("name")].push_back(entry.at("instruction_set"));
        }
    }
    ASSERT_EQ(sets.size(), 6U);
    for (const char* name : {"phase", "unwrap", "depth", "three_step", "dual", "gray_code"}) {
        EXPECT_EQ(sets[name], sets["phase"]) << name;
        // What the CPU has beyond what was compiled (AVX3_DL) runs as what was (AVX3).
        EXPECT_THAT(DepthDecoder::instruction_set(), testing::StartsWith(sets[name].back()));
    }

    const auto ours = medians(size.at("whole"));
    const auto peers = medians(size.at("peers"));
    const json& ratios = size.at("ratios");
    EXPECT_NEAR(ratios.at("of_memcpy").get<double>(), ours.at("three_step") / peers.at("memcpy"),
                1e-9);
    EXPECT_NEAR(ratios.at("faster_than_scalar_atan2f").get<double>(),
                peers.at("scalar_atan2f") / ours.at("three_step"), 1e-9);
    if (peers.contains("opencv_contrib")) {
        EXPECT_GT(ratios.at("faster_than_opencv_contrib"), 1.0);
    } else {
        EXPECT_EQ(size.at("peers").back().at("note"), "not built in: OpenCV contrib absent");
        EXPECT_TRUE(ratios.at("faster_than_opencv_contrib").is_null());
    }
}

TEST(Bench, PrintsATableThatNamesThePeers) {
    const Outcome outcome = xtrack_command({"bench", "--size", "64x48", "--repetitions", "1"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    for (const char* said : {"one core", "64 x 48", "unwrap", "memcpy", "scalar atan2f",
                             "OpenCV contrib", "x the time of memcpy"}) {
        EXPECT_THAT(outcome.out, HasSubstr(said));
    }
}

TEST(Bench, PutsThePapersTableBesideOurs) {
    const Outcome outcome = xtrack_command({"bench", "--paper", "--json", "--repetitions", "2"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const json paper = json::parse(outcome.out).at("paper");
    EXPECT_EQ(paper.at("points"), 640 * 480);
    EXPECT_THAT(paper.at("order"), HasSubstr("in space"));
    EXPECT_EQ(paper.at("period_px"), 32.0);
    EXPECT_LT(paper.at("depth_error_mm"), 1.0);
    expect_times(paper.at("decode_relative"), 2);
    expect_times(paper.at("read"), 2);
    expect_times(paper.at("decode"), 2);
    expect_times(paper.at("decode_depth"), 2);
    EXPECT_TRUE(paper.at("display").is_null());
    EXPECT_EQ(paper.at("paper_read_ms"), 10.0);
    EXPECT_EQ(paper.at("paper_decode_ms"), 30.0);
    EXPECT_EQ(paper.at("paper_display_ms"), 33.0);

    const Outcome table = xtrack_command({"bench", "--paper", "--repetitions", "1"});
    EXPECT_EQ(table.status, 0);
    EXPECT_THAT(table.out, testing::ContainsRegex("Read .* ms +10 ms"));
    EXPECT_THAT(table.out, testing::ContainsRegex("Decode .* ms +30 ms"));
    EXPECT_THAT(table.out, testing::ContainsRegex("Display +- +33 ms"));
}

TEST(BenchTiming, QuantilesAreOfTheNearestRank) {
    std::vector<double> durations_us;
    for (int i = 200; i > 0; --i) {
        durations_us.push_back(i);
    }
    const auto times = tools::bench::times_of(durations_us);
    EXPECT_EQ(times.repetitions, 200U);
    EXPECT_EQ(times.least_us, 1.0);
    EXPECT_EQ(times.median_us, 100.0);
    EXPECT_EQ(times.p99_us, 198.0);
    EXPECT_EQ(tools::bench::times_of({7.0}).p99_us, 7.0);
}

TEST(BenchTiming, AllTakeTurnsAndWhatTakesLongTakesFew) {
    std::string runs;
    std::string prepared;
    const auto slow = [&] {
        runs += 's';
        std::this_thread::sleep_for(std::chrono::milliseconds(60));
    };
    const std::vector<tools::bench::Contender> contenders = {
        {"a", "X", [&] { prepared += 'a'; }, [&] { runs += 'a'; }},
        {"b", {}, {}, [&] { runs += 'b'; }},
        {"slow", {}, {}, slow}};
    std::size_t steps = 0;
    const auto measured = tools::bench::measure(contenders, 40, [&] { ++steps; });
    EXPECT_EQ(steps, 40U);
    ASSERT_EQ(measured.size(), 3U);
    EXPECT_EQ(measured[0].instruction_set, "X");
    EXPECT_EQ(measured[0].times.repetitions, 40U);
    EXPECT_EQ(measured[2].times.repetitions, 2U);
    EXPECT_GE(measured[2].times.least_us, 60'000.0);
    EXPECT_EQ(prepared.size(), 41U);  // once more to warm up, as the rest
    EXPECT_EQ(runs.substr(0, 3), "abs");
    EXPECT_EQ(std::count(runs.begin(), runs.end(), 'b'), 41);
    // Neither is always the first of its round.
    EXPECT_THAT(runs, HasSubstr("aa"));
    EXPECT_THAT(runs, HasSubstr("bb"));
}

}  // namespace
}  // namespace xtrack::test
