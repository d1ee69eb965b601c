// SPDX-License-Identifier: Apache-2.0
#include "tools/eval/sweep.hpp"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "core/base/text.hpp"
#include "tools/eval/figures.hpp"

namespace xtrack::tools {

namespace {

constexpr std::size_t kMostValues = 1000;

Error bad(const std::string& text, const std::string& why) {
    return {ErrorCode::invalid_argument, fmt::format("--sweep {}: {}", base::quoted(text), why)};
}

std::vector<std::string> split(const std::string& text, char at) {
    std::vector<std::string> parts(1);
    for (const char c : text) {
        if (c == at) {
            parts.emplace_back();
        } else {
            parts.back() += c;
        }
    }
    return parts;
}

/// Evenly from the first to the last; nothing where the parts are no such range.
std::optional<std::vector<std::string>> range(const std::vector<std::string>& parts) {
    const auto from = base::parse_double(parts[0]);
    const auto to = base::parse_double(parts[1]);
    const auto steps = base::parse_int(parts[2]);
    if (!from || !to || !steps || *steps < 2 || *steps > static_cast<std::int64_t>(kMostValues)) {
        return std::nullopt;
    }
    std::vector<std::string> values;
    for (std::int64_t i = 0; i < *steps; ++i) {
        const double share = static_cast<double>(i) / static_cast<double>(*steps - 1);
        // Of 0.1 and its like the last digits are noise.
        values.push_back(fmt::format("{:.6g}", *from + share * (*to - *from)));
    }
    return values;
}

}  // namespace

Result<Sweep> parse_sweep(const std::string& text, const GestureSettings& settings) {
    constexpr const char* kWanted =
        "give NAME=FROM:TO:STEPS, of 2 to 1000 steps, or NAME=a,b,c, such as "
        "swipe_speed_mmps=200:500:7";
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos) {
        return bad(text, kWanted);
    }
    Sweep sweep;
    sweep.setting = text.substr(0, equals);
    std::vector<std::string> values = split(text.substr(equals + 1), ',');
    if (const auto parts = split(text.substr(equals + 1), ':'); parts.size() > 1) {
        const auto steps = parts.size() == 3 ? range(parts) : std::nullopt;
        if (!steps) {
            return bad(text, kWanted);
        }
        values = *steps;
    }
    const auto fields = gesture_fields();
    const auto field = std::find_if(fields.begin(), fields.end(),
                                    [&](const GestureField& f) { return sweep.setting == f.name; });
    for (const std::string& value : values) {
        SweepPoint point;
        point.settings = settings;
        auto set = set_field(point.settings, sweep.setting, value);
        if (set) {
            set = validate(point.settings);
        }
        if (!set) {
            return bad(text, set.error().message);
        }
        point.value = field->get(point.settings);
        point.scorer = GestureScorer(point.settings);
        sweep.points.push_back(std::move(point));
    }
    return sweep;
}

void print_table(const Sweep& sweep) {
    const std::size_t width = std::max<std::size_t>(sweep.setting.size(), 10);
    fmt::print("{:>{}} {:>7} {:>19} {:>5} {:>19} {:>5} {:>5} {:>21} {:>13}\n", sweep.setting, width,
               "found", "DR [95 %]", "false", "FP/label [95 %]", "JI", "canc", "false/hour [95 %]",
               "commit, ms");
    for (const SweepPoint& p : sweep.points) {
        const GestureScore s = p.scorer.all();
        const Estimate hour = p.scorer.false_per_hour();
        fmt::print("{:>{}} {:>3}/{:<3} {:>19} {:>5} {:>19} {:>5} {:>5} {:>21} {:>13}\n",
                   base::number_text(p.value), width, s.correct, s.labelled,
                   to_text(s.detection(), s.labelled), s.false_events(),
                   to_text(s.false_per_label(), s.labelled), jaccard_text(s), s.cancelled,
                   p.scorer.unlabelled_hours() > 0.0
                       ? fmt::format("{:.0f} [{:.0f}, {:.0f}]", hour.value, hour.low, hour.high)
                       : "-",
                   to_text(s.from_commit_ms));
    }
    fmt::print("false/hour is of recordings without labels\n");
}

void print_json(const Sweep& sweep) {
    nlohmann::json out = {{"setting", sweep.setting}, {"values", nlohmann::json::array()}};
    for (const SweepPoint& p : sweep.points) {
        out["values"].push_back({{"value", p.value},
                                 {"score", to_json(p.scorer.all())},
                                 {"unlabelled", unlabelled_json(p.scorer)}});
    }
    out["failed"] = to_json(sweep.failed);
    print(out);
}

}  // namespace xtrack::tools
