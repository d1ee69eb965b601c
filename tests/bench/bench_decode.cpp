// SPDX-License-Identifier: Apache-2.0
// Time of each stage and of the whole, 640 x 480, one core:
//   bench_decode --benchmark_repetitions=10 --benchmark_min_time=0.1
#include <benchmark/benchmark.h>

#include <random>
#include <vector>

#include <xtrack/depth_decoder.hpp>

#include "core/decode/decode_row.hpp"
#include "core/depth/depth_row.hpp"
#include "core/unwrap/unwrap_row.hpp"
#include "tests/core/pipeline/plane_scene.hpp"

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
BENCHMARK_CAPTURE(whole, gray, kGray, MotionHandling::off)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace xtrack

BENCHMARK_MAIN();
