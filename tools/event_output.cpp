// SPDX-License-Identifier: Apache-2.0
#include "tools/event_output.hpp"

#include <cmath>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace xtrack::tools {

namespace {

using Json = nlohmann::ordered_json;

// Tenths of a millimetre and hundredths of a unit value are finer than any measurement behind them.
// Dividing by a power of ten, not multiplying by 0.1, gives the double that prints short.
double rounded(float value, double per_unit) {
    return std::round(static_cast<double>(value) * per_unit) / per_unit;
}

Json vector_json(const Vec3f& v, double per_unit) {
    return {rounded(v.x(), per_unit), rounded(v.y(), per_unit), rounded(v.z(), per_unit)};
}

Json time_json(const TimeStatistics& t) {
    return {
        {"count", t.count}, {"median_us", t.median_us}, {"p99_us", t.p99_us}, {"max_us", t.max_us}};
}

}  // namespace

bool worth_a_text_line(const GestureEvent& event) {
    return event.phase != EventPhase::update &&
           !(is_one_shot(event.type) && event.phase == EventPhase::begin);
}

std::string to_text(const GestureEvent& event, Pace pace) {
    std::string what = name_of(event);
    if (!is_one_shot(event.type)) {
        what += std::string(" ") + to_string(event.phase);
    }
    if (event.phase == EventPhase::cancel) {
        what += std::string(" (") + to_string(event.cancel_reason) + ")";
    }
    std::string line =
        fmt::format("{:9.3f} s  {:<22} {:<7} hand {}", static_cast<double>(event.sensor.ns) * 1e-9,
                    what, to_string(event.hand), event.hand_id);
    if (event.type != GestureType::hand) {
        line +=
            fmt::format("  {:4.0f} ms after onset", to_seconds(event.sensor - event.onset) * 1e3);
        if (pace != Pace::replay) {
            line += fmt::format(", latency {:.1f} ms", to_seconds(event.emit - event.sensor) * 1e3);
        }
    }
    return line;
}

void print_event(std::FILE* out, EventFormat format, const GestureEvent& event, Pace pace) {
    switch (format) {
        case EventFormat::none: return;
        case EventFormat::text:
            if (worth_a_text_line(event)) {
                fmt::print(out, "{}\n", to_text(event, pace));
            }
            break;
        case EventFormat::jsonl: fmt::print(out, "{}\n", xtrack::to_json(event)); break;
    }
    std::fflush(out);
}

void print_trace(std::FILE* out, EventFormat format, const RecogniserTrace& line) {
    if (format == EventFormat::jsonl) {
        const Json json = {{"type", "why"},
                           {"t_us", line.stamp.us()},
                           {"hand_id", line.hand_id},
                           {"machine", line.machine},
                           {"from", line.from},
                           {"event", line.event},
                           {"to", line.to},
                           {"why", *line.why == '\0' ? Json(nullptr) : Json(line.why)},
                           {"measured", rounded(static_cast<float>(line.measured), 100.0)},
                           {"limit", rounded(static_cast<float>(line.limit), 100.0)}};
        fmt::print(out, "{}\n", json.dump());
        return;
    }
    std::string text = fmt::format("{:9.3f} s    {}, hand {}: {} -> {} ({})",
                                   static_cast<double>(line.stamp.ns) * 1e-9, line.machine,
                                   line.hand_id, line.from, line.to, line.event);
    if (*line.why != '\0') {
        text += fmt::format("; {}", line.why);
        // Some reasons have nothing to measure.
        if (line.measured != 0.0 || line.limit != 0.0) {
            text += fmt::format(": {:.6g}, limit {:.6g}", line.measured, line.limit);
        }
    }
    fmt::print(out, "{}\n", text);
}

std::string to_json(const HandFrame& hands, const Hand& hand) {
    Json tips = Json::array();
    for (const TrackedPoint& tip : hand.fingertips) {
        tips.push_back(tip.valid ? vector_json(tip.position_mm, 10.0) : Json(nullptr));
    }
    const Json json = {
        {"type", "hand_pose"},
        {"t_us", hands.stamp.us()},
        {"hand_id", hand.id},
        {"hand", to_string(hand.chirality)},
        {"palm_mm", vector_json(hand.palm_mm, 10.0)},
        {"normal", vector_json(hand.palm_normal, 1000.0)},
        {"tips_mm", tips},
        {"extended", hand.extended_fingers >= 0 ? Json(hand.extended_fingers) : Json(nullptr)},
        {"aperture_mm", hand.pinch_aperture_mm >= 0.0F ? Json(rounded(hand.pinch_aperture_mm, 10.0))
                                                       : Json(nullptr)},
        {"grab", rounded(hand.grab_value, 100.0)},
        {"confidence", rounded(hand.confidence, 100.0)},
        {"metric", hands.metric},
    };
    return json.dump();
}

std::string to_text(const SessionStatistics& s) {
    std::string out = fmt::format(
        "items {}  depth frames {}  rejected {}  dropped {}  events {}\n"
        "{:<24}{:>10}{:>12}{:>10}{:>10}\n",
        s.items, s.depth_frames, s.rejected, s.dropped, s.events, "stage", "count", "median ms",
        "p99 ms", "max ms");
    const auto row = [&out](const char* name, const TimeStatistics& t) {
        if (t.count > 0) {
            out += fmt::format("{:<24}{:>10}{:>12.3f}{:>10.3f}{:>10.3f}\n", name, t.count,
                               t.median_us * 1e-3, t.p99_us * 1e-3, t.max_us * 1e-3);
        }
    };
    row("decode", s.decode);
    row("track", s.track);
    row("recognise", s.recognise);
    row("whole", s.whole);
    row("latency sensor to emit", s.latency);
    return out;
}

std::string to_json(const SessionStatistics& s) {
    const Json json = {{"items", s.items},
                       {"depth_frames", s.depth_frames},
                       {"rejected", s.rejected},
                       {"dropped", s.dropped},
                       {"events", s.events},
                       {"events_dropped", s.events_dropped},
                       {"decode", time_json(s.decode)},
                       {"track", time_json(s.track)},
                       {"recognise", time_json(s.recognise)},
                       {"whole", time_json(s.whole)},
                       {"latency", time_json(s.latency)}};
    return json.dump();
}

}  // namespace xtrack::tools
