// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <xtrack/image.hpp>
#include <xtrack/sim.hpp>

namespace xtrack::sim {

/// Lens blur, shot and read noise, quantisation, and the YUYV transport of colour cameras.
class Sensor {
 public:
    Sensor(const SimCamera& camera, std::uint64_t seed, Size size);

    [[nodiscard]] std::size_t channels() const noexcept { return channels_; }
    /// The light of a frame, to be filled: width x channels.
    [[nodiscard]] ImageView<float> light() noexcept { return light_.view(); }
    /// Turns light() into the pixels of frame `frame`; light() is used up.
    void read_out(std::uint64_t frame, ImageView<std::uint8_t> pixels);

 private:
    void blur();
    void add_noise(std::uint64_t frame);
    void pack_422(ImageView<std::uint8_t> pixels) const;

    std::size_t channels_;
    bool chroma_422_;
    float side_weight_;  ///< of each neighbour in the blur
    float shot_;
    float read_;
    std::uint64_t seed_;
    Image<float> light_;
    std::vector<float> lines_;   ///< three rows, blurred along x
    std::vector<float> normal_;  ///< quantiles of the normal distribution
};

}  // namespace xtrack::sim
