// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "tools/bench/scene.hpp"
#include "tools/bench/timing.hpp"

namespace xtrack::tools::bench {

// What others do with the same three frames, from the same ring.

/// The loop that one writes first, and the paper's formula: a pixel at a time through atan2f to
/// x, y, z as float. No instruction set is chosen; the compiler may do with it what it can.
/// @param xyz_mm out: of the newest run, as long as the contender lives
[[nodiscard]] Contender scalar_peer(const Scene& scene, std::shared_ptr<FrameRing> ring,
                                    std::shared_ptr<std::vector<float>> xyz_mm);

/// Nothing but moving the bytes that go in (three grey images) to where as many come out (depth of
/// two bytes and quality of one): what no program can go below.
[[nodiscard]] Contender memcpy_peer(Size size, std::shared_ptr<FrameRing> ring);

/// OpenCV contrib's SinusoidalPattern (phase shifting) with its HistogramPhaseUnwrapping: an
/// unwrapped phase, no depth. Absent where the build found no such modules.
[[nodiscard]] std::optional<Contender> opencv_peer(const Scene& scene,
                                                   std::shared_ptr<FrameRing> ring);

}  // namespace xtrack::tools::bench
