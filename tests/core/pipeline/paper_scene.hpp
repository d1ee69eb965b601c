// SPDX-License-Identifier: Apache-2.0
// What the tests of the PaperDecoder show it.
#pragma once

#include <algorithm>
#include <cstdint>

#include <gtest/gtest.h>

#include <xtrack/paper_decoder.hpp>

#include "tests/core/pipeline/step_scene.hpp"

namespace xtrack::test {

inline const PatternSequence& fringes() {
    static const PatternSequence patterns = three_step_sequence(Axis::x, {1280, 768}, 32.0);
    return patterns;
}

inline const PatternSequence& wide_fringes() {
    static const PatternSequence patterns = three_step_sequence(Axis::x, {1280, 768}, 64.0);
    return patterns;
}

// The paper's way: every image for itself.
inline DecodeSettings plain() {
    DecodeSettings settings;
    settings.motion = MotionHandling::off;
    settings.keep_maps = true;
    return settings;
}

inline PaperDecoder make(const DecodeSettings& settings = plain(), const Rig* rig = nullptr,
                         const PatternSequence& patterns = fringes()) {
    auto decoder = PaperDecoder::create(patterns, StepScene::kCamera, settings, rig);
    EXPECT_TRUE(decoder) << decoder.error().message;
    return *std::move(decoder);
}

/// Images number * 3 and the two after it. @return what push() said of the last
inline DecodeState show(PaperDecoder& decoder, const StepScene& scene, int number,
                        const PatternSequence& patterns = fringes()) {
    DecodeState state = DecodeState::need_more;
    const int count = static_cast<int>(patterns.patterns.size());
    for (int n = 0; n < count; ++n) {
        state = decoder.push(scene.frame(patterns, n, count * number + n)).state;
    }
    return state;
}

inline int with_depth(const PaperDecoder& decoder) {
    int count = 0;
    const Image<std::uint16_t>& depth = decoder.depth().depth;
    for (int v = 0; v < depth.height(); ++v) {
        count += static_cast<int>(std::count_if(depth.row(v), depth.row(v) + depth.width(),
                                                [](std::uint16_t d) { return d != 0; }));
    }
    return count;
}

inline double depth_at(const PaperDecoder& decoder, int u, int v) {
    return decoder.depth().depth.at(u, v) * decoder.depth().depth_unit_mm;
}

}  // namespace xtrack::test
