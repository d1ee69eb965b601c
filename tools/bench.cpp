// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "tools/bench/instruction_sets.hpp"
#include "tools/bench/motion/report.hpp"
#include "tools/bench/ours.hpp"
#include "tools/bench/paper.hpp"
#include "tools/bench/peers.hpp"
#include "tools/bench/report.hpp"
#include "tools/bench/scene.hpp"
#include "tools/commands.hpp"
#include "tools/image_size.hpp"
#include "tools/progress.hpp"
#include "tools/stream.hpp"

namespace xtrack::tools {

namespace {

// Far more than noise of a grey level does: a figure of wrong depth is worth nothing.
constexpr double kWrong_mm = 5.0;

struct BenchOptions {
    std::vector<std::string> sizes{"640x480", "1280x720", "1920x1080"};
    std::size_t rounds = 100;
    bool paper = false;
    bool json = false;
    bool motion = false;
    std::vector<std::string> recordings;
    std::vector<std::string> methods;
    std::vector<std::string> parts{"speeds", "fastest"};
};

// Every contender with every instruction set.
std::vector<bench::Contender> with_each(const std::vector<bench::InstructionSet>& sets,
                                        const std::vector<bench::Contender>& contenders) {
    std::vector<bench::Contender> all;
    for (const bench::InstructionSet& set : sets) {
        for (bench::Contender contender : contenders) {
            contender.instruction_set = set.name;
            contender.prepare = [set] { bench::use(set); };
            all.push_back(std::move(contender));
        }
    }
    return all;
}

Result<bench::SizeReport> measure_size(Size size, const std::vector<bench::InstructionSet>& sets,
                                       std::size_t rounds) {
    const auto scene = bench::Scene::create(size);
    if (!scene) {
        return scene.error();
    }
    const auto ring_of = [&](const PatternSequence& patterns) {
        return std::make_shared<bench::FrameRing>(scene->frames(patterns));
    };
    const auto ring = ring_of(scene->three_step());
    auto ours = bench::stage_contenders(*scene, ring);
    if (!ours) {
        return ours.error();
    }
    std::vector<std::shared_ptr<bench::WholeDecode>> wholes;
    const auto add_whole = [&](const char* name, const PatternSequence& patterns,
                               std::shared_ptr<bench::FrameRing> frames) -> Result<void> {
        const auto whole = bench::WholeDecode::create(*scene, patterns, std::move(frames));
        if (!whole) {
            return whole.error();
        }
        wholes.push_back(*whole);
        ours->push_back({name, {}, {}, [decode = *whole] { decode->run(); }});
        return {};
    };
    for (const auto& ok :
         {add_whole("three_step", scene->three_step(), ring),
          add_whole("dual", scene->dual(), ring_of(scene->dual())),
          add_whole("gray_code", scene->gray_code(), ring_of(scene->gray_code()))}) {
        if (!ok) {
            return ok.error();
        }
    }
    std::vector<bench::Contender> contenders = with_each(sets, *ours);
    const std::size_t own = contenders.size();
    const auto xyz_mm = std::make_shared<std::vector<float>>();
    contenders.push_back(bench::memcpy_peer(size, ring));
    contenders.push_back(bench::scalar_peer(*scene, ring, xyz_mm));
    if (auto opencv = bench::opencv_peer(*scene, ring)) {
        contenders.push_back(std::move(*opencv));
    }

    Progress progress(fmt::format("bench {}x{}", size.width, size.height), rounds);
    const auto measured = bench::measure(contenders, rounds, [&] { progress.step(); });

    bench::SizeReport report;
    report.size = size;
    report.ring_bytes = ring->bytes();
    bool complete = true;
    double worst_mm = scene->median_error_mm(*xyz_mm);
    for (const auto& whole : wholes) {
        worst_mm = std::max(worst_mm, scene->median_error_mm(whole->depth()));
        complete = complete && whole->made_depth();
    }
    if (!complete || worst_mm > kWrong_mm) {
        return Error{
            ErrorCode::unsupported,
            fmt::format("bench: at {}x{} depth is missing or {:.1f} mm off; its time would "
                        "mean nothing",
                        size.width, size.height, worst_mm)};
    }
    report.depth_error_mm = scene->median_error_mm(wholes.front()->depth());
    const auto border = measured.begin() + static_cast<std::ptrdiff_t>(own);
    report.ours.assign(measured.begin(), border);
    report.peers.assign(border, measured.end());
    return report;
}

int bench_sizes(const BenchOptions& options, const std::vector<Size>& sizes) {
    const auto sets = bench::instruction_sets();
    std::vector<bench::SizeReport> reports;
    for (const Size size : sizes) {
        const auto report = measure_size(size, sets, options.rounds);
        if (!report) {
            return fail(report.error());
        }
        reports.push_back(*report);
    }
    const std::string cpu = bench::cpu_model();
    const std::string text = options.json ? bench::json_of(cpu, options.rounds, reports)
                                          : bench::table_of(cpu, options.rounds, reports);
    std::fputs(text.c_str(), stdout);
    return 0;
}

int bench_paper(const BenchOptions& options) {
    Progress progress("bench", options.rounds);
    const auto times = bench::measure_paper(options.rounds, [&] { progress.step(); });
    if (!times) {
        return fail(times.error());
    }
    const std::string cpu = bench::cpu_model();
    const std::string text =
        options.json ? bench::json_of(cpu, *times) : bench::table_of(cpu, *times);
    std::fputs(text.c_str(), stdout);
    return 0;
}

int bench_motion(const BenchOptions& options) {
    const auto wanted = [&](const char* part) {
        return std::find(options.parts.begin(), options.parts.end(), part) != options.parts.end();
    };
    const auto sequences = bench::sequence_count(options.methods);
    if (!sequences) {
        return fail(sequences.error());
    }
    bench::MotionReport report;
    // What can fail for the caller's sake comes first.
    for (const std::string& folder : options.recordings) {
        auto recording = bench::measure_recording(folder);
        if (!recording) {
            return fail(recording.error());
        }
        report.recordings.push_back(*std::move(recording));
    }
    if (wanted("speeds")) {
        Progress progress("bench, speeds", *sequences * bench::kSpeedSteps);
        auto methods = bench::sweep_speeds(options.methods, [&] { progress.step(); });
        if (!methods) {
            return fail(methods.error());
        }
        report.methods = *std::move(methods);
    }
    if (wanted("fastest")) {
        Progress progress("bench, cameras", *sequences * bench::kMotionCameras.size());
        auto fastest = bench::find_fastest(options.methods, [&] { progress.step(); });
        if (!fastest) {
            return fail(fastest.error());
        }
        report.fastest = *std::move(fastest);
    }
    const std::string text = options.json ? bench::json_of(report) : bench::table_of(report);
    std::fputs(text.c_str(), stdout);
    return 0;
}

std::vector<std::string> motion_method_names() {
    std::vector<std::string> names;
    if (const auto methods = bench::motion_methods(bench::motion_rig())) {
        for (const bench::MotionMethod& method : *methods) {
            names.emplace_back(method.name);
        }
    }
    return names;
}

}  // namespace

void add_bench(CLI::App& app, int& exit_status) {
    auto* command = app.add_subcommand(
        "bench", "Times of the stages and of the whole on this CPU, beside those of others");
    const auto options = std::make_shared<BenchOptions>();
    auto* sizes = command
                      ->add_option("--size", options->sizes,
                                   "Sizes of the camera's image, such as 640x480,1280x720")
                      ->delimiter(',')
                      ->capture_default_str();
    auto* rounds =
        command->add_option("--repetitions", options->rounds, "How often each is measured")
            ->check(CLI::Range(1, 100'000))
            ->capture_default_str();
    auto* paper =
        command->add_flag("--paper", options->paper, "The table of the 2012 paper instead, 640x480")
            ->excludes(sizes);
    auto* motion =
        command
            ->add_flag("--motion", options->motion,
                       "Depth of a simulated hand that moves instead, by method and speed")
            ->excludes(sizes)
            ->excludes(rounds)
            ->excludes(paper);
    command
        ->add_option("--recordings", options->recordings,
                     "With --motion: folders of recordings with true depth and mask")
        ->needs(motion);
    command->add_option("--methods", options->methods, "With --motion: only these")
        ->delimiter(',')
        ->check(CLI::IsMember(motion_method_names()))
        ->needs(motion);
    command
        ->add_option("--parts", options->parts,
                     "With --motion: speeds (every method at every speed), fastest (the fastest "
                     "hand of every camera and method), recordings (those given alone)")
        ->delimiter(',')
        ->check(CLI::IsMember({"speeds", "fastest", "recordings"}))
        ->capture_default_str()
        ->needs(motion);
    command->add_flag("--json", options->json, "The figures as one JSON object");
    command->callback([options, &exit_status] {
        std::vector<Size> wanted;
        for (const std::string& text : options->sizes) {
            const auto size = parse_size(text);
            if (!size) {
                exit_status = usage({ErrorCode::invalid_argument,
                                     "--size: '" + text + "' is no image size; write 640x480"});
                return;
            }
            wanted.push_back(*size);
        }
        const auto& parts = options->parts;
        if (options->recordings.empty() && parts == std::vector<std::string>{"recordings"}) {
            exit_status = usage({ErrorCode::invalid_argument,
                                 "--parts recordings: none is given; name them with --recordings"});
            return;
        }
        if (options->motion) {
            exit_status = bench_motion(*options);
            return;
        }
        exit_status = options->paper ? bench_paper(*options) : bench_sizes(*options, wanted);
    });
}

}  // namespace xtrack::tools
