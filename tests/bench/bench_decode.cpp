// SPDX-License-Identifier: Apache-2.0
// Time of each stage and of the whole, 640 x 480, one core:
//   bench_decode --benchmark_repetitions=10 --benchmark_min_time=0.1
//       --benchmark_report_aggregates_only=true
#include <benchmark/benchmark.h>

#include <random>
#include <vector>

#include <xtrack/depth_decoder.hpp>
#include <xtrack/hand_tracker.hpp>
#include <xtrack/sim.hpp>

#include "core/decode/decode_row.hpp"
#include "core/depth/depth_row.hpp"
#include "core/unwrap/spatial.hpp"
#include "core/unwrap/unwrap_row.hpp"
#include "tests/core/pipeline/plane_scene.hpp"
#include "tests/core/unwrap/phase_scene.hpp"
#include "tests/core/unwrap/quality_guided_reference.hpp"

namespace xtrack {
namespace {

constexpr int kWidth = 640;
constexpr int kHeight = 480;

Rig bench_rig() {
    Rig rig = test::plane_rig({kWidth, kHeight});
    rig.camera.matrix << 600.0, 0.0, 320.0, 0.0, 600.0, 240.0, 0.0, 0.0, 1.0;
    return rig;
}

void decode_stage(benchmark::State& state) {
    std::mt19937 random(1);
    std::vector<Image<std::uint8_t>> images;
    DecodeRow row;
    row.taps = static_cast<int>(state.range(0));
    for (int n = 0; n < row.taps; ++n) {
        images.emplace_back(kWidth, kHeight);
        for (int y = 0; y < kHeight; ++y) {
            for (int x = 0; x < kWidth; ++x) {
                images.back().at(x, y) = static_cast<std::uint8_t>(random() & 255U);
            }
        }
        row.re[static_cast<std::size_t>(n)] = 0.3F - 0.2F * static_cast<float>(n);
        row.im[static_cast<std::size_t>(n)] = -0.3F + 0.2F * static_cast<float>(n * n);
    }
    Image<float> out(kWidth, 2);
    row.count = kWidth;
    row.min_modulation = 6.0F;
    row.phase_rad = out.row(0);
    row.modulation = out.row(1);
    for (auto _ : state) {
        for (int y = 0; y < kHeight; ++y) {
            for (std::size_t n = 0; n < images.size(); ++n) {
                row.source[n] = images[n].row(y);
            }
            decode_row(row);
        }
        benchmark::ClobberMemory();
    }
    state.SetLabel(decode_instruction_set());
}
BENCHMARK(decode_stage)->Arg(3)->Arg(5)->Unit(benchmark::kMicrosecond);

void unwrap_stage(benchmark::State& state) {
    Image<float> rows(kWidth, 3, 0.7F);
    UnwrapRow row;
    row.count = kWidth;
    row.phase_rad = rows.row(0);
    row.reference_px = rows.row(1);
    row.coordinate_px = rows.row(2);
    row.period_px = 400.0;
    for (auto _ : state) {
        for (int y = 0; y < kHeight; ++y) {
            unwrap_row(row);
        }
        benchmark::ClobberMemory();
    }
    state.SetLabel(decode_instruction_set());
}
BENCHMARK(unwrap_stage)->Unit(benchmark::kMicrosecond);

// Spatial unwrapping, and beside it the plain quality-guided algorithm on the same image.
void spatial(benchmark::State& state, test::PhaseSceneKind kind, bool by_heap) {
    const auto scene = test::make_phase_scene(kind, 1, {kWidth, kHeight});
    auto unwrapper = SpatialUnwrapper::create({kWidth, kHeight}, {});
    if (!unwrapper) {
        state.SkipWithError(unwrapper.error().message.c_str());
        return;
    }
    Image<float> unwrapped(kWidth, kHeight);
    Image<std::uint16_t> component(kWidth, kHeight);
    for (auto _ : state) {
        if (by_heap) {
            test::unwrap_by_heap(scene.phase_rad.view(), scene.modulation.view(), 2.0F,
                                 unwrapped.view(), component.view());
        } else {
            benchmark::DoNotOptimize(unwrapper
                                         ->unwrap(scene.phase_rad.view(), scene.modulation.view(),
                                                  unwrapped.view(), component.view())
                                         .data());
        }
        benchmark::ClobberMemory();
    }
    state.counters["right"] = test::score(scene, unwrapped.view(), component.view()).right;
    state.SetLabel(by_heap ? "heap of pixels" : decode_instruction_set());
}
BENCHMARK_CAPTURE(spatial, bumps, test::PhaseSceneKind::bumps, false)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(spatial, bumps_by_heap, test::PhaseSceneKind::bumps, true)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(spatial, hand, test::PhaseSceneKind::hand, false)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(spatial, hand_by_heap, test::PhaseSceneKind::hand, true)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(spatial, bands, test::PhaseSceneKind::bands, false)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(spatial, salt, test::PhaseSceneKind::salt, false)->Unit(benchmark::kMicrosecond);

void depth_stage(benchmark::State& state) {
    Image<float> rows(kWidth, 2, 250.0F);
    Image<std::uint16_t> depth(kWidth, kHeight);
    Image<std::uint8_t> quality(kWidth, kHeight);
    DepthRow row;
    row.count = kWidth;
    row.coordinate_px = rows.row(0);
    row.modulation = rows.row(1);
    row.a_step = 0.7F;
    row.c0 = 1.0F;
    row.b = 100000.0F;
    row.near_mm = 300.0F;
    row.far_mm = 2000.0F;
    for (auto _ : state) {
        for (int y = 0; y < kHeight; ++y) {
            row.depth = depth.row(y);
            row.quality = quality.row(y);
            depth_row(row);
        }
        benchmark::ClobberMemory();
    }
    state.SetLabel(decode_instruction_set());
}
BENCHMARK(depth_stage)->Unit(benchmark::kMicrosecond);

enum Scheme { kThree, kThreePlusTwo, kDual, kGray };

void whole(benchmark::State& state, Scheme scheme, MotionHandling motion) {
    const Rig rig = bench_rig();
    const Size projector = rig.projector->size;
    const PatternSequence patterns =
        scheme == kDual   ? dual_sequence(Axis::x, projector, 512.0, 64.0)
        : scheme == kGray ? gray_code_sequence(Axis::x, projector, 32.0)
                          : three_step_sequence(Axis::x, projector, 512.0);
    DecodeSettings settings;
    settings.motion = motion;
    settings.taps = scheme == kThree ? PhaseTaps::least_squares : PhaseTaps::automatic;
    auto decoder = DepthDecoder::create(rig, patterns, {kWidth, kHeight}, settings);
    if (!decoder) {
        state.SkipWithError(decoder.error().message.c_str());
        return;
    }
    const int count = static_cast<int>(patterns.patterns.size());
    std::vector<std::shared_ptr<Frame>> frames;
    for (int n = 0; n < 2 * count; ++n) {
        frames.push_back(test::plane_frame(rig, patterns, n % count, n, 700.0));
    }
    std::size_t n = 0;
    std::int64_t time = 0;
    for (auto _ : state) {
        Frame& frame = *frames[n];
        frame.sequence = static_cast<std::uint64_t>(++time);
        frame.stamp = Stamp::from_us(16667 * time);
        benchmark::DoNotOptimize(decoder->push(frames[n]));
        n = (n + 1) % frames.size();
    }
    state.SetLabel(DepthDecoder::instruction_set());
}
BENCHMARK_CAPTURE(whole, three_step, kThree, MotionHandling::off)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(whole, three_plus_two, kThreePlusTwo, MotionHandling::off)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(whole, three_plus_two_following, kThreePlusTwo, MotionHandling::follow)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(whole, dual, kDual, MotionHandling::off)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(whole, dual_following, kDual, MotionHandling::follow)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(whole, gray, kGray, MotionHandling::off)->Unit(benchmark::kMicrosecond);

// One simulated camera frame, its light, noise and transport.
void simulate(benchmark::State& state, const char* preset) {
    auto settings = SimSettings::preset(preset);
    if (!settings) {
        state.SkipWithError(settings.error().message.c_str());
        return;
    }
    settings->duration_s = 3600.0;
    auto rig = SimulatedRig::create(*settings);
    if (!rig) {
        state.SkipWithError(rig.error().message.c_str());
        return;
    }
    constexpr int kUntilTheHandIsIn = 90;
    for (int n = 0; n < kUntilTheHandIsIn; ++n) {
        benchmark::DoNotOptimize((*rig)->next({}));
    }
    for (auto _ : state) {
        benchmark::DoNotOptimize((*rig)->next({}));
    }
}
BENCHMARK_CAPTURE(simulate, ideal_60, "ideal-60")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(simulate, webcam_30, "webcam-30")->Unit(benchmark::kMillisecond);

// Depth images of a simulated scene with a hand, frame after frame: motion, following and masks
// included. `track` does the same and then finds the hand; only that part is timed.
void scene(benchmark::State& state, const char* preset, bool track) {
    auto settings = SimSettings::preset(preset);
    if (!settings) {
        state.SkipWithError(settings.error().message.c_str());
        return;
    }
    settings->duration_s = 3600.0;
    auto rig = SimulatedRig::create(*settings);
    if (!rig) {
        state.SkipWithError(rig.error().message.c_str());
        return;
    }
    auto decoder =
        DepthDecoder::create((*rig)->rig(), (*rig)->patterns(), (*rig)->rig().camera.size, {});
    auto tracker = HandTracker::create((*rig)->rig(), (*rig)->rig().camera.size, {});
    if (!decoder || !tracker) {
        state.SkipWithError("decoder or tracker");
        return;
    }
    constexpr int kUntilTheHandIsIn = 90;
    const auto step = [&](bool timed) {
        const auto item = (*rig)->next({});
        if (timed && !track) {
            state.ResumeTiming();
        }
        const DecodeStatus status = decoder->push(item.frame);
        if (timed && track) {
            state.ResumeTiming();
        }
        if (track && status.state == DecodeState::depth_ready) {
            benchmark::DoNotOptimize(tracker->track(decoder->depth()));
        }
    };
    for (int n = 0; n < kUntilTheHandIsIn; ++n) {
        step(false);
    }
    for (auto _ : state) {
        state.PauseTiming();
        step(true);
    }
    state.SetLabel(DepthDecoder::instruction_set());
}
// The simulator takes far longer than what is measured, so the frames are counted.
constexpr int kSceneFrames = 40;
BENCHMARK_CAPTURE(scene, decode_ideal_60, "ideal-60", false)
    ->Iterations(kSceneFrames)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(scene, decode_webcam_30, "webcam-30", false)
    ->Iterations(kSceneFrames)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(scene, track_ideal_60, "ideal-60", true)
    ->Iterations(kSceneFrames)
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace xtrack

BENCHMARK_MAIN();
