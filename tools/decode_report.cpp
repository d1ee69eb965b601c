// SPDX-License-Identifier: Apache-2.0
#include "tools/decode_report.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tools/hand_accuracy.hpp"

namespace xtrack::tools {

namespace {

// Beyond this a pixel is not noisy but wrong: another fringe, another surface.
constexpr double kOffBy_mm = 15.0;

double percentile(std::vector<std::uint16_t>& sorted, double share) {
    const auto last = static_cast<double>(sorted.size() - 1);
    return sorted[static_cast<std::size_t>(std::lround(share * last))] * kDepthUnitMm;
}

std::string name_of(const Pattern& p) {
    switch (p.kind) {
        case PatternKind::sine: return fmt::format("sine {:g} px", p.period_px);
        case PatternKind::rgb_sine: return fmt::format("colour sine {:g} px", p.period_px);
        case PatternKind::gray_code: return fmt::format("Gray code {:g} px", p.cell_px);
        case PatternKind::ramp: return fmt::format("ramp {:g} px", p.period_px);
        case PatternKind::flat: break;
    }
    return "flat";
}

double percent(std::size_t part, std::size_t whole) {
    return whole == 0 ? 0.0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

const char* name_of(RippleCause cause) {
    switch (cause) {
        case RippleCause::none: break;
        case RippleCause::brightness: return "brightness";
        case RippleCause::steps: return "steps";
        case RippleCause::gamma: return "gamma";
    }
    return "none";
}

const char* advice_on(RippleCause cause) {
    switch (cause) {
        case RippleCause::none: break;
        case RippleCause::brightness:
            return "the images differ in brightness: lock exposure and gain; or something moved";
        case RippleCause::steps:
            return "the phases are not the patterns': check the timing; or something moved evenly";
        case RippleCause::gamma: return "the projector's gamma: --gamma auto corrects it";
    }
    return "";
}

}  // namespace

std::string describe(const PatternSequence& patterns) {
    std::string text;
    for (std::size_t i = 0; i < patterns.patterns.size();) {
        const std::string name = name_of(patterns.patterns[i]);
        std::size_t count = 0;
        while (i < patterns.patterns.size() && name_of(patterns.patterns[i]) == name) {
            ++i;
            ++count;
        }
        text += fmt::format("{}{} x{}", text.empty() ? "" : " + ", name, count);
    }
    return text;
}

void measure_depth(const DepthFrame& depth, DecodeReport& report) {
    std::vector<std::uint16_t> values;
    for (int y = 0; y < depth.depth.height(); ++y) {
        const std::uint16_t* row = depth.depth.row(y);
        std::copy_if(row, row + depth.depth.width(), std::back_inserter(values),
                     [](std::uint16_t z) { return z != 0; });
    }
    report.has_depth = true;
    report.valid_percent =
        percent(values.size(), static_cast<std::size_t>(depth.depth.width()) *
                                   static_cast<std::size_t>(depth.depth.height()));
    if (values.empty()) {
        return;
    }
    std::sort(values.begin(), values.end());
    report.median_mm = percentile(values, 0.5);
    report.low_mm = percentile(values, 0.01);
    report.high_mm = percentile(values, 0.99);
}

Result<std::optional<TruthReport>> measure_truth(const RecordingReader& recording,
                                                 std::size_t index, const DepthFrame& depth) {
    if (!recording.has_truth_depth(index) || !recording.has_truth_mask(index)) {
        return std::optional<TruthReport>{};
    }
    DepthFrame truth;
    if (auto ok = recording.read_truth_depth(index, truth); !ok) {
        return ok.error();
    }
    Image<std::uint8_t> mask;
    if (auto ok = recording.read_truth_mask(index, mask); !ok) {
        return ok.error();
    }
    const HandAccuracy hand = measure_hand(depth, truth.depth.view(), mask.view(), kOffBy_mm);
    TruthReport report;
    report.pixels = hand.pixels;
    if (hand.close > 0) {
        report.rms_mm = hand.rms_mm();
    }
    report.off_percent = hand.off_percent();
    report.missing_percent = hand.missing_percent();
    return std::optional(report);
}

std::string table_of(const std::string& method, const std::string& note,
                     const std::vector<DecodeReport>& reports) {
    std::string text = "method  " + method + "\n";
    if (!note.empty()) {
        text += "note    " + note + "\n";
    }
    text += fmt::format("{:<22}{:>10}{:>10}{:>10}{:>9}{:>10}{:>8}{:>10}\n", "frame", "median mm",
                        "1 % mm", "99 % mm", "valid %", "RMS mm", "off %", "missing %");
    for (const DecodeReport& r : reports) {
        text += fmt::format("{:<22}", r.frame);
        text += r.has_depth
                    ? fmt::format("{:>10.1f}{:>10.1f}{:>10.1f}", r.median_mm, r.low_mm, r.high_mm)
                    : fmt::format("{:>10}{:>10}{:>10}", "-", "-", "-");
        text += fmt::format("{:>9.1f}", r.valid_percent);
        text += r.truth && r.truth->rms_mm ? fmt::format("{:>10.2f}", *r.truth->rms_mm)
                                           : fmt::format("{:>10}", "-");
        text += r.truth ? fmt::format("{:>8.2f}{:>10.2f}", r.truth->off_percent,
                                      r.truth->missing_percent)
                        : fmt::format("{:>8}{:>10}", "-", "-");
        text += '\n';
        if (r.ripple && cause_of(*r.ripple) != RippleCause::none) {
            text += fmt::format(
                "  phase ripple {:.3f} {:.3f} {:.3f} rad at 1, 2 and N times the phase: {}\n",
                r.ripple->brightness_rad, r.ripple->steps_rad, r.ripple->gamma_rad,
                advice_on(cause_of(*r.ripple)));
        }
    }
    return text;
}

std::string json_of(const std::string& method, const std::string& note,
                    const std::vector<DecodeReport>& reports) {
    nlohmann::ordered_json frames = nlohmann::ordered_json::array();
    for (const DecodeReport& r : reports) {
        nlohmann::ordered_json frame{
            {"frame", r.frame}, {"t_us", r.stamp.us()}, {"valid_percent", r.valid_percent}};
        if (!r.folder.empty()) {
            frame["folder"] = r.folder;
        }
        if (r.has_depth) {
            frame["median_mm"] = r.median_mm;
            frame["p01_mm"] = r.low_mm;
            frame["p99_mm"] = r.high_mm;
        }
        if (!r.has_depth) {
            frame["metric"] = false;
        }
        if (r.truth) {
            frame["hand"] = {{"pixels", r.truth->pixels},
                             {"rms_mm", r.truth->rms_mm ? nlohmann::ordered_json(*r.truth->rms_mm)
                                                        : nlohmann::ordered_json()},
                             {"off_percent", r.truth->off_percent},
                             {"missing_percent", r.truth->missing_percent}};
        }
        if (r.ripple) {
            frame["ripple"] = {{"brightness_rad", r.ripple->brightness_rad},
                               {"steps_rad", r.ripple->steps_rad},
                               {"gamma_rad", r.ripple->gamma_rad},
                               {"cause", name_of(cause_of(*r.ripple))}};
        }
        frames.push_back(frame);
    }
    // Names of files need not be UTF-8, of which JSON is made.
    constexpr auto kReplace = nlohmann::ordered_json::error_handler_t::replace;
    return nlohmann::ordered_json{{"method", method}, {"note", note}, {"frames", frames}}.dump(
               -1, ' ', false, kReplace) +
           "\n";
}

}  // namespace xtrack::tools
