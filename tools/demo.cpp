// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <deque>
#include <filesystem>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "core/base/file.hpp"
#include "tools/commands.hpp"
#include "tools/event_output.hpp"
#include "tools/method_choice.hpp"
#include "tools/pictures.hpp"
#include "tools/stream.hpp"
#include "tools/trial.hpp"

namespace xtrack::tools {

namespace {

constexpr const char* kPresets[] = {"ideal-60", "webcam-30"};

struct DemoOptions {
    std::string out = "demo-out";
    std::string method;
    bool without_rig = false;
    int seeds = 0;
    bool fast = false;
    bool json = false;
};

struct Scored {
    std::string preset;
    TrialResult result;
};

/// One preset as a user sees it: events as they happen, pictures, events.jsonl.
Result<TrialResult> play(const std::string& preset, const DemoOptions& demo) {
    TrialOptions options;
    options.preset = preset;
    options.method = demo.method;
    options.use_rig = !demo.without_rig;
    options.pace = demo.fast ? Pace::replay : Pace::own_pace;
    std::optional<ContactSheet> sheet;
    std::vector<GestureEvent> fresh;  // events whose pictures are still to be taken
    std::string lines;
    auto result = run_trial(options, [&](Session& session, const SimulatedRig& rig) {
        sheet.emplace(rig.rig(), fmt::format("xTrack, simulated rig {}: camera, depth in 256 "
                                             "levels, tracked hand",
                                             preset));
        session.subscribe([&](const GestureEvent& event) {
            if (!demo.json) {
                print_event(stdout, EventFormat::text, event, options.pace);
            }
            lines += xtrack::to_json(event) + "\n";
            if (event.type != GestureType::hand && worth_a_text_line(event)) {
                fresh.push_back(event);
            }
        });
        session.subscribe_pipeline([&](const PipelineView& view) {
            for (const GestureEvent& event : fresh) {
                sheet->add(view, to_text(event, options.pace));
            }
            if (view.depth != nullptr) {
                fresh.clear();
            }
        });
    });
    if (!result) {
        return result;
    }
    const std::filesystem::path out = demo.out;
    if (auto written = sheet->write(out / (preset + ".png")); !written) {
        return written.error();
    }
    const std::string file = preset == kPresets[0] ? "events.jsonl" : preset + ".jsonl";
    if (auto written = base::write_file(out / file, lines); !written) {
        return written.error();
    }
    return result;
}

nlohmann::ordered_json number(double value) {
    return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

nlohmann::ordered_json to_json(const Scored& scored) {
    const TrialResult& r = scored.result;
    const bool timed = r.statistics.latency.count > 0;  // a replay has no latency
    return {{"preset", scored.preset},
            {"scripted", r.score.labelled},
            {"found", r.score.correct},
            {"false", r.score.false_events()},
            {"wrong_hand", r.score.wrong_hand},
            {"after_commit_ms_p50", number(percentile(r.score.from_commit_ms, 0.5))},
            {"after_commit_ms_p95", number(percentile(r.score.from_commit_ms, 0.95))},
            {"depth_rms_mm_p50", number(percentile(r.depth_rms_mm, 0.5))},
            {"depth_off_share_p50", number(percentile(r.depth_off, 0.5))},
            {"depth_missing_share_p50", number(percentile(r.depth_missing, 0.5))},
            {"palm_error_mm_p50", number(percentile(r.palm_error_mm, 0.5))},
            {"palm_error_mm_p95", number(percentile(r.palm_error_mm, 0.95))},
            {"latency_ms_p50", timed ? number(r.statistics.latency.median_us * 1e-3) : nullptr},
            {"latency_ms_p99", timed ? number(r.statistics.latency.p99_us * 1e-3) : nullptr}};
}

std::string cell(double value, const char* unit) {
    return std::isfinite(value) ? fmt::format("{:.1f}{}", value, unit) : "-";
}

void print_table(const std::vector<Scored>& all) {
    fmt::print("\n{:<44}", "score against the simulator's truth");
    for (const Scored& s : all) {
        fmt::print("{:>14}", s.preset);
    }
    const auto row = [&all](const char* name, const auto& value) {
        fmt::print("\n{:<44}", name);
        for (const Scored& s : all) {
            fmt::print("{:>14}", value(s.result));
        }
    };
    row("gestures scripted", [](const TrialResult& r) { return fmt::to_string(r.score.labelled); });
    row("  found", [](const TrialResult& r) { return fmt::to_string(r.score.correct); });
    row("  invented (false events)",
        [](const TrialResult& r) { return fmt::to_string(r.score.false_events()); });
    row("  of these, right gesture but wrong hand",
        [](const TrialResult& r) { return fmt::to_string(r.score.wrong_hand); });
    row("decided after the definition was met, median",
        [](const TrialResult& r) { return cell(percentile(r.score.from_commit_ms, 0.5), " ms"); });
    row("  95 %",
        [](const TrialResult& r) { return cell(percentile(r.score.from_commit_ms, 0.95), " ms"); });
    const bool live = all.front().result.statistics.latency.count > 0;
    if (live) {
        row("latency, sensor to callback, median", [](const TrialResult& r) {
            return cell(r.statistics.latency.median_us * 1e-3, " ms");
        });
        row("  99 %",
            [](const TrialResult& r) { return cell(r.statistics.latency.p99_us * 1e-3, " ms"); });
    }
    if (!all.front().result.depth_rms_mm.empty()) {
        row("depth on the hand, RMS within 15 mm, median",
            [](const TrialResult& r) { return cell(percentile(r.depth_rms_mm, 0.5), " mm"); });
        row("  off by more, median frame",
            [](const TrialResult& r) { return cell(percentile(r.depth_off, 0.5) * 100, " %"); });
        row("  missing, median frame", [](const TrialResult& r) {
            return cell(percentile(r.depth_missing, 0.5) * 100, " %");
        });
        row("palm error, median",
            [](const TrialResult& r) { return cell(percentile(r.palm_error_mm, 0.5), " mm"); });
        row("  95 %",
            [](const TrialResult& r) { return cell(percentile(r.palm_error_mm, 0.95), " mm"); });
    }
    fmt::print("\n");
}

void print_trial(const char* preset, std::size_t seed, const TrialResult& result) {
    fmt::print("{:<10} seed {:>2}: {} of {} found", preset, seed, result.score.correct,
               result.score.labelled);
    for (const JudgedEvent& judged : result.events) {
        if (is_false(judged.verdict)) {
            fmt::print("; {} {} at {:.2f} s", to_string(judged.verdict), name_of(judged.event),
                       static_cast<double>(judged.event.sensor.ns) * 1e-9);
        }
    }
    fmt::print("\n");
    std::fflush(stdout);
}

// Whether both rigs can show the method, before either plays: `auto` finds one for each.
Result<void> check_method(const DemoOptions& demo) {
    if (demo.method.empty() || demo.method == "auto") {
        return {};
    }
    TrialOptions options;
    options.use_rig = !demo.without_rig;
    for (const char* preset : kPresets) {
        auto settings = SimSettings::preset(preset);
        if (!settings) {
            return settings.error();
        }
        if (auto shown = show_method(demo.method, gestures_of(options), *settings); !shown) {
            return Error{shown.error().code, fmt::format("{}: {}", preset, shown.error().message)};
        }
    }
    return {};
}

/// Many people, no pictures: what went wrong is listed by seed. Trials are independent, so every
/// processor runs some; results are taken in the order of the seeds.
Result<std::vector<Scored>> score_seeds(const DemoOptions& demo) {
    const std::size_t seeds = static_cast<std::size_t>(demo.seeds);
    const std::size_t at_once = std::max(1U, std::thread::hardware_concurrency());
    std::vector<Scored> all;
    for (const char* preset : kPresets) {
        Scored scored{preset, {}};
        std::deque<std::future<Result<TrialResult>>> running;
        std::size_t started = 0;
        for (std::size_t seed = 1; seed <= seeds; ++seed) {
            while (started < seeds && running.size() < at_once) {
                TrialOptions options;
                options.preset = preset;
                options.method = demo.method;
                options.use_rig = !demo.without_rig;
                options.seed = ++started;
                options.measure_depth = true;
                running.push_back(
                    std::async(std::launch::async, [options] { return run_trial(options); }));
            }
            const auto result = running.front().get();
            running.pop_front();
            if (!result) {
                return result.error();
            }
            if (!demo.json) {
                print_trial(preset, seed, *result);
            }
            scored.result.add(*result);
        }
        all.push_back(std::move(scored));
    }
    return all;
}

Result<std::vector<Scored>> play_presets(const DemoOptions& demo) {
    std::error_code error;
    std::filesystem::create_directories(demo.out, error);
    if (error) {
        return Error{ErrorCode::io, demo.out + ": " + error.message() +
                                        "; choose a folder you may write to with --out"};
    }
    std::vector<Scored> all;
    for (const char* preset : kPresets) {
        if (!demo.json) {
            fmt::print("\nSimulated rig {}:\n", preset);
        }
        auto result = play(preset, demo);
        if (!result) {
            return result.error();
        }
        all.push_back({preset, std::move(*result)});
    }
    return all;
}

}  // namespace

void add_demo(CLI::App& app, int& exit_status) {
    auto* command = app.add_subcommand(
        "demo",
        "The simulated rig: a hand swipes, pushes and pinches; pictures, events and scores");
    const auto demo = std::make_shared<DemoOptions>();
    command->add_option("--out", demo->out, "Folder for pictures and events.jsonl")
        ->default_str("demo-out");
    command
        ->add_option("--method", demo->method,
                     "What the projector shows; auto or a name from `xtrack methods`")
        ->check(not_empty());
    command->add_flag("--without-rig", demo->without_rig,
                      "As if nobody had calibrated the rig: relative depth, no pinches");
    command->add_flag("--fast", demo->fast, "As fast as it goes instead of in real time");
    command
        ->add_option("--seeds", demo->seeds,
                     "Score so many different people instead, without pictures and a clock")
        ->check(CLI::Range(1, 1000))
        ->excludes("--out", "--fast");
    command->add_flag("--json", demo->json, "Print the scores as JSON");
    command->callback([=, &exit_status] {
        if (const auto possible = check_method(*demo); !possible) {
            exit_status = possible.error().code == ErrorCode::invalid_argument
                              ? usage(possible.error())
                              : fail(possible.error());
            return;
        }
        const auto all = demo->seeds > 0 ? score_seeds(*demo) : play_presets(*demo);
        if (!all) {
            exit_status = fail(all.error());
            return;
        }
        if (demo->json) {
            nlohmann::ordered_json json = nlohmann::ordered_json::array();
            for (const Scored& scored : *all) {
                json.push_back(to_json(scored));
            }
            fmt::print("{}\n", json.dump(2));
            return;
        }
        print_table(*all);
        if (demo->seeds == 0) {
            fmt::print(
                "\nPictures and events: {0}/{1}.png, {0}/events.jsonl; {0}/{2}.png, "
                "{0}/{2}.jsonl\n",
                demo->out, kPresets[0], kPresets[1]);
        }
    });
}

}  // namespace xtrack::tools
