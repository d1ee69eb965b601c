// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <xtrack/sim.hpp>

#include "core/sim/renderer.hpp"

namespace xtrack::sim {

/// Reads ground truth out of the renderer's geometry.
/// @thread one at a time
class TruthMaker {
 public:
    explicit TruthMaker(const Renderer& renderer);
    /// @param renderer after draw_geometry(frame)
    void make(const Renderer& renderer, std::uint64_t frame, SimTruth& truth);

 private:
    void find_palm(const Renderer& renderer, std::size_t hand, const SimTruth& truth,
                   SimHandTruth& out);

    std::vector<float> distance2_;  ///< squared pixels to the nearest pixel off the hand
    std::vector<float> line_;
    std::vector<int> apex_;
    std::vector<float> bound_;
};

}  // namespace xtrack::sim
