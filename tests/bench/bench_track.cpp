// SPDX-License-Identifier: Apache-2.0
// Time of the hand tracker, and of recognition after it, a depth image; one core:
//   bench_track --benchmark_repetitions=10 --benchmark_min_time=0.5
//       --benchmark_report_aggregates_only=true
#include <benchmark/benchmark.h>

#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include <xtrack/gesture_recogniser.hpp>
#include <xtrack/hand_tracker.hpp>

#include "tests/gestures/track/synthetic_hand.hpp"

namespace xtrack {
namespace {

constexpr Duration kFrame = std::chrono::microseconds(16667);
constexpr int kImages = 30;

/// A user before a wall whose hands move: images of one to and fro, to be played in a ring.
struct Film {
    Rig rig;
    std::vector<DepthFrame> images;

    Film(Size size, int hands) {
        test::Scene scene(size, 600.0 / 640.0 * size.width);
        for (int n = 0; n < kImages; ++n) {
            const float turn = 6.2831853F * static_cast<float>(n) / kImages;
            scene.clear();
            scene.wall(1500.0F);
            scene.person(0.0F, 1000.0F);
            for (int h = 0; h < hands; ++h) {
                const float side = h == 0 ? -1.0F : 1.0F;
                test::SyntheticHand hand;
                hand.thumb_to_the_right = h == 0;
                hand.palm_mm = {side * 140.0F + 60.0F * std::cos(turn), 30.0F * std::sin(turn),
                                600.0F + 10.0F * std::sin(turn)};
                hand.draw(scene);
            }
            scene.noise(1.5, 0.03, static_cast<unsigned>(n + 1));
            images.push_back(scene.depth);
        }
        rig = scene.rig;
    }
};

void track(benchmark::State& state, Size size, int hands, bool recognise) {
    static std::map<std::pair<int, int>, Film> films;  // they take long to draw
    Film& film = films.try_emplace({size.width, hands}, size, hands).first->second;
    auto tracker = HandTracker::create(film.rig, size, {});
    auto recogniser = GestureRecogniser::create({});
    if (!tracker || !recogniser) {
        state.SkipWithError("tracker or recogniser");
        return;
    }
    Mat4d facing_the_user = Mat4d::Identity();
    facing_the_user(0, 0) = facing_the_user(1, 1) = -1.0;
    std::int64_t n = 0;
    std::size_t seen = 0;
    const auto step = [&] {
        DepthFrame& image = film.images[static_cast<std::size_t>(n % kImages)];
        image.stamp = Stamp{} + kFrame * ++n;
        const HandFrame& frame = tracker->track(image);
        seen += frame.count;
        if (recognise) {
            benchmark::DoNotOptimize(recogniser->push(to_interaction(frame, facing_the_user)));
        }
    };
    constexpr int kUntilTheRoomIsLearnt = 200;
    while (n < kUntilTheRoomIsLearnt) {
        step();
    }
    seen = 0;
    const std::int64_t before = n;
    for (auto _ : state) {
        step();
    }
    state.counters["hands"] = static_cast<double>(seen) / static_cast<double>(n - before);
}
BENCHMARK_CAPTURE(track, two_hands_640x480, Size{640, 480}, 2, false)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(track, two_hands_and_gestures_640x480, Size{640, 480}, 2, true)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(track, one_hand_640x480, Size{640, 480}, 1, false)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(track, no_hand_640x480, Size{640, 480}, 0, false)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(track, two_hands_320x240, Size{320, 240}, 2, false)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(track, two_hands_1920x1200, Size{1920, 1200}, 2, false)
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace xtrack

BENCHMARK_MAIN();
