// SPDX-License-Identifier: Apache-2.0
#include "tools/bench/motion/report.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace xtrack::tools::bench {

namespace {

using Json = nlohmann::ordered_json;

std::string cell(const HandAccuracy& hand) {
    if (hand.pixels == 0) {
        return "-";
    }
    const std::string rms = hand.close == 0 ? "-" : fmt::format("{:.1f}", hand.rms_mm());
    return fmt::format("{}/{:.1f}/{:.1f}", rms, hand.off_percent(), hand.missing_percent());
}

std::string cell(const ReferenceCell& cell) {
    const auto figure = [](double value) {
        return std::isnan(value) ? std::string("-") : fmt::format("{:g}", value);
    };
    if (std::isnan(cell.off_percent)) {
        return "-";
    }
    return fmt::format("{}/{}/{}", figure(cell.rms_mm), figure(cell.off_percent),
                       figure(cell.missing_percent));
}

constexpr int kNameWidth = 30;
constexpr int kCellWidth = 16;

// A row of ours, and the reference's below it.
std::string rows_of(const MethodReport& report, std::span<const HandAccuracy> ours,
                    std::span<const ReferenceCell> reference) {
    std::string text = fmt::format("{:<{}}", report.method.says, kNameWidth);
    if (!report.not_decoded.empty()) {
        text += "  not decoded: " + report.not_decoded;
    } else {
        for (const HandAccuracy& hand : ours) {
            text += fmt::format("{:>{}}", cell(hand), kCellWidth);
        }
    }
    const bool known = std::any_of(reference.begin(), reference.end(), [](const ReferenceCell& r) {
        return !std::isnan(r.off_percent);
    });
    if (known) {
        text += fmt::format("\n{:<{}}", "  reference", kNameWidth);
        for (const ReferenceCell& r : reference) {
            text += fmt::format("{:>{}}", cell(r), kCellWidth);
        }
    }
    return text + '\n';
}

std::string header_of(std::string_view what, std::span<const double> moves_mm) {
    std::string text = fmt::format("\n{:<{}}", what, kNameWidth);
    for (const double move : moves_mm) {
        text +=
            fmt::format("{:>{}}", move == 0.0 ? "still" : fmt::format("{:g} mm", move), kCellWidth);
    }
    return text + '\n';
}

// The figure that a target is about; null where the method was not measured.
const HandAccuracy* measured_for(const MotionTarget& target,
                                 const std::vector<MethodReport>& methods) {
    const auto at = std::find(kSideways_mm.begin(), kSideways_mm.end(), target.move_mm);
    for (const MethodReport& report : methods) {
        if (report.method.name == target.method && report.not_decoded.empty()) {
            return &report.sideways[static_cast<std::size_t>(at - kSideways_mm.begin())];
        }
    }
    return nullptr;
}

bool reached(const MotionTarget& target, const HandAccuracy& hand) {
    return hand.pixels > 0 && hand.off_percent() <= target.off_percent;
}

std::string targets_of(const std::vector<MethodReport>& methods) {
    std::string text = "\nwanted:";
    const char* comma = "";
    for (const MotionTarget& target : kMotionTargets) {
        const HandAccuracy* hand = measured_for(target, methods);
        text += fmt::format("{} {} at most {:g} % off at {:g} mm a frame: {}", comma, target.method,
                            target.off_percent, target.move_mm,
                            hand == nullptr
                                ? "not measured"
                                : fmt::format("{:.1f} %, {}", hand->off_percent(),
                                              reached(target, *hand) ? "reached" : "missed"));
        comma = ";";
    }
    return text + '\n';
}

std::string table_of(const std::vector<MethodReport>& methods) {
    std::string text = fmt::format(
        "Simulated hand at constant velocity, 600 mm away, {:g} frames a second; RMS mm of the "
        "pixels within {:g} mm / % off by more / % missing\n",
        frames_per_second(MotionCamera::ideal_60), kMotionLimit_mm);
    text += header_of("sideways, mm a frame", kSideways_mm);
    for (const MethodReport& report : methods) {
        text += rows_of(report, report.sideways, report.method.sideways);
    }
    text += header_of("toward the camera", kToward_mm);
    for (const MethodReport& report : methods) {
        text += rows_of(report, report.toward, report.method.toward);
    }
    return text + targets_of(methods);
}

std::string table_of(const std::vector<RecordingReport>& recordings) {
    std::string text = fmt::format("\n{:<24}{:>8}{:>12}{:>18}{:>18}  {}\n", "recording", "frames",
                                   "mm a frame", "as it comes", "followed", "patterns");
    for (const RecordingReport& r : recordings) {
        text += fmt::format("{:<24}{:>8}{:>12.1f}", r.name, r.frames, r.mean_move_mm);
        text += r.not_decoded.empty() ? fmt::format("{:>18}{:>18}  {}\n", cell(r.as_it_comes),
                                                    cell(r.followed), r.method)
                                      : fmt::format("  not decoded: {}\n", r.not_decoded);
    }
    return text;
}

std::string_view says_of(std::string_view name) {
    const auto methods = motion_methods(motion_rig());
    if (methods) {
        for (const MotionMethod& method : *methods) {
            if (method.name == name) {
                return method.says;
            }
        }
    }
    return name;
}

std::string table_of(const std::vector<FastestReport>& fastest) {
    std::string text = fmt::format(
        "\nFastest hand sideways, m/s, of which at most {:g} % is off and {:g} % missing\n{:<{}}",
        kWorksOff_percent, kWorksMissing_percent, "", kNameWidth);
    for (const MotionCamera camera : kMotionCameras) {
        text += fmt::format("{:>{}}", name_of(camera), kCellWidth);
    }
    text += '\n';
    for (const FastestReport& row : fastest) {
        if (row.camera != kMotionCameras.front()) {
            continue;
        }
        text += fmt::format("{:<{}}", says_of(row.method), kNameWidth);
        if (!row.not_decoded.empty()) {
            text += "  not decoded: " + row.not_decoded + '\n';
            continue;
        }
        for (const MotionCamera camera : kMotionCameras) {
            const auto found =
                std::find_if(fastest.begin(), fastest.end(), [&](const FastestReport& f) {
                    return f.camera == camera && f.method == row.method;
                });
            text += fmt::format("{:>{}}",
                                found->speed_mps > 0.0 ? fmt::format("{:g}", found->speed_mps)
                                                       : std::string("none"),
                                kCellWidth);
        }
        text += '\n';
    }
    return text;
}

Json json_of(const HandAccuracy& hand) {
    return {{"pixels", hand.pixels},
            {"rms_mm", hand.close == 0 ? Json() : Json(hand.rms_mm())},
            {"off_percent", hand.off_percent()},
            {"missing_percent", hand.missing_percent()}};
}

Json json_of(const ReferenceCell& cell) {
    const auto figure = [](double value) { return std::isnan(value) ? Json() : Json(value); };
    return {{"rms_mm", figure(cell.rms_mm)},
            {"off_percent", figure(cell.off_percent)},
            {"missing_percent", figure(cell.missing_percent)}};
}

Json reason_of(const std::string& not_decoded) {
    return not_decoded.empty() ? Json() : Json(not_decoded);
}

Json json_of(const MethodReport& report, std::span<const double> moves_mm,
             std::span<const HandAccuracy> ours, std::span<const ReferenceCell> reference) {
    Json list = Json::array();
    for (std::size_t i = 0; i < moves_mm.size(); ++i) {
        Json entry{{"mm_per_frame", moves_mm[i]}};
        if (report.not_decoded.empty()) {
            entry.update(json_of(ours[i]));
        }
        entry["reference"] = json_of(reference[i]);
        list.push_back(std::move(entry));
    }
    return list;
}

}  // namespace

std::string table_of(const MotionReport& report) {
    std::string text;
    if (!report.methods.empty()) {
        text += table_of(report.methods);
    }
    if (!report.recordings.empty()) {
        text += table_of(report.recordings);
    }
    if (!report.fastest.empty()) {
        text += table_of(report.fastest);
    }
    return text;
}

std::string json_of(const MotionReport& report) {
    Json methods = Json::array();
    for (const MethodReport& r : report.methods) {
        methods.push_back({{"name", r.method.name},
                           {"not_decoded", reason_of(r.not_decoded)},
                           {"sideways", json_of(r, kSideways_mm, r.sideways, r.method.sideways)},
                           {"toward", json_of(r, kToward_mm, r.toward, r.method.toward)}});
    }
    Json targets = Json::array();
    for (const MotionTarget& target : kMotionTargets) {
        const HandAccuracy* hand = measured_for(target, report.methods);
        targets.push_back({{"name", target.method},
                           {"mm_per_frame", target.move_mm},
                           {"wanted_off_percent", target.off_percent},
                           {"off_percent", hand == nullptr ? Json() : Json(hand->off_percent())},
                           {"reached", hand == nullptr ? Json() : Json(reached(target, *hand))}});
    }
    Json recordings = Json::array();
    for (const RecordingReport& r : report.recordings) {
        recordings.push_back({{"name", r.name},
                              {"patterns", r.method},
                              {"not_decoded", reason_of(r.not_decoded)},
                              {"frames", r.frames},
                              {"mean_mm_per_frame", r.mean_move_mm},
                              {"as_it_comes", json_of(r.as_it_comes)},
                              {"followed", json_of(r.followed)}});
    }
    Json fastest = Json::array();
    for (const FastestReport& r : report.fastest) {
        fastest.push_back({{"camera", name_of(r.camera)},
                           {"name", r.method},
                           {"not_decoded", reason_of(r.not_decoded)},
                           {"speed_mps", r.speed_mps},
                           {"there", json_of(r.there)}});
    }
    const Json motion{{"frames_per_second", frames_per_second(MotionCamera::ideal_60)},
                      {"limit_mm", kMotionLimit_mm},
                      {"methods", methods},
                      {"targets", targets},
                      {"recordings", recordings},
                      {"fastest", fastest}};
    return Json{{"motion", motion}}.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace xtrack::tools::bench
