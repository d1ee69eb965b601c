// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include <xtrack/depth_decoder.hpp>

#include "tools/bench/scene.hpp"
#include "tools/bench/timing.hpp"

namespace xtrack::tools::bench {

/// The stages of three steps, each over a whole image, a row at a time as the decoder does it: what
/// the next stage reads is still in the cache, images come from the ring.
/// @return contenders `phase`, `unwrap` and `depth`
[[nodiscard]] Result<std::vector<Contender>> stage_contenders(
    const Scene& scene, const std::shared_ptr<FrameRing>& three_step);

/// A DepthDecoder that forgets everything and is given one set of a ring: all frames are cold, and
/// the last one makes it decode. Nothing moves, so nothing is looked for.
class WholeDecode {
 public:
    [[nodiscard]] static Result<std::shared_ptr<WholeDecode>> create(
        const Scene& scene, const PatternSequence& patterns, std::shared_ptr<FrameRing> ring);

    void run() noexcept;
    /// Of the newest run.
    [[nodiscard]] const DepthFrame& depth() const noexcept { return decoder_.depth(); }
    /// False once a run gave no depth.
    [[nodiscard]] bool made_depth() const noexcept { return made_depth_; }

 private:
    WholeDecode(DepthDecoder decoder, std::shared_ptr<FrameRing> ring)
        : decoder_(std::move(decoder)), ring_(std::move(ring)) {}

    DepthDecoder decoder_;
    std::shared_ptr<FrameRing> ring_;
    bool made_depth_ = true;
};

}  // namespace xtrack::tools::bench
