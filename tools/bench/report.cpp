// SPDX-License-Identifier: Apache-2.0
#include "tools/bench/report.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <optional>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace xtrack::tools::bench {

namespace {

using Json = nlohmann::ordered_json;

struct Row {
    const char* name;
    const char* says;
};

constexpr std::array<Row, 3> kStages{{
    {"phase", "phase, modulation of 3 steps"},
    {"unwrap", "unwrap"},
    {"depth", "triangulate to u16 + u8"},
}};
constexpr std::array<Row, 3> kWhole{{
    {"three_step", "3 frames to u16 + u8"},
    {"dual", "6 frames, two periods"},
    {"gray_code", "Gray code and 3 steps"},
}};
constexpr std::array<Row, 3> kPeers{{
    {"memcpy", "memcpy of as many bytes"},
    {"scalar_atan2f", "scalar atan2f loop to float XYZ"},
    {"opencv_contrib", "OpenCV contrib, phase and unwrapping, no depth"},
}};
constexpr const char* kNoOpenCv = "not built in: OpenCV contrib absent";

// The last of a name: of ours the best instruction set.
std::optional<Times> times_named(const std::vector<Measured>& all, std::string_view name) {
    const auto found =
        std::find_if(all.rbegin(), all.rend(), [&](const Measured& m) { return m.name == name; });
    return found == all.rend() ? std::nullopt : std::optional(found->times);
}

// How many times as long `slow` takes; nothing where it was not measured.
std::optional<double> ratio(const std::optional<Times>& slow, const std::optional<Times>& fast) {
    if (!slow || !fast || fast->median_us <= 0.0) {
        return std::nullopt;
    }
    return slow->median_us / fast->median_us;
}

std::string cell(const Times& times) {
    return fmt::format("{:.3f} ({:.3f})", times.median_us * 1e-3, times.p99_us * 1e-3);
}

std::string table_of_ours(const SizeReport& report) {
    std::vector<std::string> sets;
    for (const Measured& m : report.ours) {
        if (std::find(sets.begin(), sets.end(), m.instruction_set) == sets.end()) {
            sets.push_back(m.instruction_set);
        }
    }
    std::string text = fmt::format("{:<32}", "");
    for (const std::string& set : sets) {
        text += fmt::format("{:>19}", set);
    }
    text += '\n';
    const auto add = [&](const Row& row) {
        text += fmt::format("{:<32}", row.says);
        for (const Measured& m : report.ours) {
            if (m.name == row.name) {
                text += fmt::format("{:>19}", cell(m.times));
            }
        }
        text += '\n';
    };
    std::for_each(kStages.begin(), kStages.end(), add);
    std::for_each(kWhole.begin(), kWhole.end(), add);
    return text;
}

std::string table_of_size(const SizeReport& report) {
    std::string text =
        fmt::format("\n{} x {}, frames from a ring of {:.0f} MB\n", report.size.width,
                    report.size.height, static_cast<double>(report.ring_bytes) * 1e-6);
    text += table_of_ours(report);
    const auto whole = times_named(report.ours, kWhole.front().name);
    for (const Row& row : kPeers) {
        const auto peer = times_named(report.peers, row.name);
        text += fmt::format("{:<48} {}", row.says, peer ? cell(*peer) : kNoOpenCv);
        if (peer && whole && peer->repetitions < whole->repetitions) {
            text += fmt::format(" of {}", peer->repetitions);
        }
        text += '\n';
    }
    text += fmt::format(
        "3 frames to u16 + u8, {}: {:.1f} x the time of memcpy, {:.0f} x faster "
        "than the scalar loop",
        report.ours.back().instruction_set,
        ratio(whole, times_named(report.peers, "memcpy")).value_or(0.0),
        ratio(times_named(report.peers, "scalar_atan2f"), whole).value_or(0.0));
    if (const auto faster = ratio(times_named(report.peers, "opencv_contrib"), whole)) {
        text += fmt::format(", {:.0f} x faster than OpenCV contrib", *faster);
    }
    return text +
           fmt::format("\ndepth is {:.2f} mm off the wall (median)\n", report.depth_error_mm);
}

Json json_of(const Times& times) {
    return {{"repetitions", times.repetitions},
            {"median_us", times.median_us},
            {"p99_us", times.p99_us},
            {"min_us", times.least_us}};
}

Json json_of(const std::vector<Measured>& all, const std::array<Row, 3>& rows) {
    Json list = Json::array();
    for (const Measured& m : all) {
        const bool wanted = std::any_of(rows.begin(), rows.end(),
                                        [&](const Row& row) { return m.name == row.name; });
        if (wanted) {
            Json entry{{"name", m.name}};
            if (!m.instruction_set.empty()) {
                entry["instruction_set"] = m.instruction_set;
            }
            entry.update(json_of(m.times));
            list.push_back(std::move(entry));
        }
    }
    return list;
}

Json json_or_null(const std::optional<double>& value) { return value ? Json(*value) : Json(); }

Json json_of(const SizeReport& report) {
    const auto whole = times_named(report.ours, kWhole.front().name);
    const auto opencv = times_named(report.peers, "opencv_contrib");
    Json peers = json_of(report.peers, kPeers);
    if (!opencv) {
        peers.push_back({{"name", "opencv_contrib"}, {"note", kNoOpenCv}});
    }
    return {{"width", report.size.width},
            {"height", report.size.height},
            {"ring_bytes", report.ring_bytes},
            {"depth_error_mm", report.depth_error_mm},
            {"stages", json_of(report.ours, kStages)},
            {"whole", json_of(report.ours, kWhole)},
            {"peers", peers},
            {"ratios",
             {{"of_memcpy", json_or_null(ratio(whole, times_named(report.peers, "memcpy")))},
              {"faster_than_scalar_atan2f",
               json_or_null(ratio(times_named(report.peers, "scalar_atan2f"), whole))},
              {"faster_than_opencv_contrib", json_or_null(ratio(opencv, whole))}}}};
}

std::string line_of(const Json& json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

std::string cpu_model() {
    std::ifstream file("/proc/cpuinfo");
    std::string line;
    while (std::getline(file, line)) {
        const std::size_t colon = line.find(": ");
        if (line.starts_with("model name") && colon != std::string::npos) {
            return line.substr(colon + 2);
        }
    }
    return "unknown";
}

std::string table_of(const std::string& cpu, std::size_t rounds,
                     const std::vector<SizeReport>& reports) {
    std::string text = fmt::format(
        "{}, one core; median (p99) of {} repetitions, ms, all in turns\n", cpu, rounds);
    for (const SizeReport& report : reports) {
        text += table_of_size(report);
    }
    return text;
}

std::string json_of(const std::string& cpu, std::size_t rounds,
                    const std::vector<SizeReport>& reports) {
    Json sizes = Json::array();
    for (const SizeReport& report : reports) {
        sizes.push_back(json_of(report));
    }
    return line_of({{"cpu", cpu}, {"cores", 1}, {"repetitions", rounds}, {"sizes", sizes}});
}

std::string table_of(const std::string& cpu, const PaperTimes& times) {
    const auto row = [](const char* name, const std::string& ours, double paper_ms,
                        const std::string& says) {
        return fmt::format("{:<10}{:>12}{:>12.0f} ms  {}\n", name, ours, paper_ms, says);
    };
    const auto ms = [](const Times& t) { return fmt::format("{:.2f} ms", t.median_us * 1e-3); };
    return fmt::format(
               "640 x 480, {} points, median of {}; here: {}, one core; paper (2012): "
               "2.66 GHz Core 2 Duo\n{:<10}{:>12}{:>15}\n",
               times.points, times.decode.repetitions, cpu, "", "here", "paper") +
           row("Read", ms(times.read), kPaperRead_ms, "three grey PNG images, from memory") +
           row("Decode", ms(times.decode), kPaperDecode_ms,
               fmt::format("phase, unwrapping in space, float x, y, z; fringes of {:g} px",
                           times.period_px)) +
           row("Display", "-", kPaperDisplay_ms, "this version has no viewer") +
           fmt::format(
               "Decode without a rig, heights before a plane: {}; to u16 depth and u8 quality, "
               "without float points: {}\ndepth is {:.2f} mm off the surface (median)\n",
               ms(times.decode_relative), ms(times.decode_depth), times.depth_error_mm);
}

std::string json_of(const std::string& cpu, const PaperTimes& times) {
    return line_of({{"cpu", cpu},
                    {"cores", 1},
                    {"paper",
                     {{"points", times.points},
                      {"order", "unwrapped in space"},
                      {"period_px", times.period_px},
                      {"depth_error_mm", times.depth_error_mm},
                      {"read", json_of(times.read)},
                      {"decode", json_of(times.decode)},
                      {"decode_relative", json_of(times.decode_relative)},
                      {"decode_depth", json_of(times.decode_depth)},
                      {"display", nullptr},
                      {"paper_read_ms", kPaperRead_ms},
                      {"paper_decode_ms", kPaperDecode_ms},
                      {"paper_display_ms", kPaperDisplay_ms}}}});
}

}  // namespace xtrack::tools::bench
