// SPDX-License-Identifier: Apache-2.0
#include "tools/bench/ours.hpp"

#include <utility>

#include "core/decode/decode_row.hpp"
#include "core/depth/depth_row.hpp"
#include "core/depth/triangulation.hpp"
#include "core/unwrap/unwrap_row.hpp"

namespace xtrack::tools::bench {

namespace {

// Rows that the stages hand to each other.
enum RowBuffer { phase_row, modulation_row, reference_row, coordinate_row, row_buffers };

class Stages {
 public:
    Stages(const Scene& scene, const TapSet& taps, Triangulation geometry,
           std::shared_ptr<FrameRing> ring)
        : size_(scene.size()),
          geometry_(std::move(geometry)),
          ring_(std::move(ring)),
          rows_(size_.width, row_buffers),
          depth_(size_.width, size_.height),
          quality_(size_.width, size_.height) {
        decode_.taps = taps.count;
        for (std::size_t n = 0; n < static_cast<std::size_t>(taps.count); ++n) {
            decode_.re[n] = taps.taps[n].re;
            decode_.im[n] = taps.taps[n].im;
        }
        decode_.count = size_.width;
        decode_.min_modulation = static_cast<float>(DecodeSettings{}.min_modulation);
        decode_.saturation_limit = 255;
        decode_.phase_rad = rows_.row(phase_row);
        decode_.modulation = rows_.row(modulation_row);

        for (int u = 0; u < size_.width; ++u) {
            rows_.at(u, reference_row) = static_cast<float>(scene.volume_middle_px(u));
        }
        unwrap_.count = size_.width;
        unwrap_.phase_rad = rows_.row(phase_row);
        unwrap_.reference_px = rows_.row(reference_row);
        unwrap_.coordinate_px = rows_.row(coordinate_row);
        unwrap_.period_px = scene.three_step().patterns.front().period_px;

        // The later stages work on what the earlier ones make of a row.
        decode(ring_->next(), 0);
        unwrap_row(unwrap_);
    }

    void phase() noexcept {
        const auto set = ring_->next();
        for (int y = 0; y < size_.height; ++y) {
            decode(set, y);
        }
    }

    void unwrap() const noexcept {
        for (int y = 0; y < size_.height; ++y) {
            unwrap_row(unwrap_);
        }
    }

    void depth() noexcept {
        DepthRow row;
        row.count = size_.width;
        row.coordinate_px = rows_.row(coordinate_row);
        row.modulation = rows_.row(modulation_row);
        for (int y = 0; y < size_.height; ++y) {
            geometry_.prepare_row(y, nullptr, row);  // no lens, no scratch
            row.depth = depth_.row(y);
            row.quality = quality_.row(y);
            depth_row(row);
        }
    }

 private:
    void decode(std::span<const FramePtr> set, int y) noexcept {
        for (std::size_t n = 0; n < set.size(); ++n) {
            decode_.source[n] = set[n]->pixels.row(y);
        }
        decode_row(decode_);
    }

    Size size_;
    Triangulation geometry_;
    std::shared_ptr<FrameRing> ring_;
    Image<float> rows_;
    Image<std::uint16_t> depth_;
    Image<std::uint8_t> quality_;
    DecodeRow decode_;
    UnwrapRow unwrap_;
};

}  // namespace

Result<std::vector<Contender>> stage_contenders(const Scene& scene,
                                                const std::shared_ptr<FrameRing>& three_step) {
    std::vector<double> phases_rad;
    for (const Pattern& pattern : scene.three_step().patterns) {
        phases_rad.push_back(pattern.phase_rad[0]);
    }
    const auto taps = least_squares_taps(phases_rad);
    if (!taps) {
        return taps.error();
    }
    auto geometry = Triangulation::create(scene.rig(), Axis::x, scene.size());
    if (!geometry) {
        return geometry.error();
    }
    const auto stages = std::make_shared<Stages>(scene, *taps, std::move(*geometry), three_step);
    return std::vector<Contender>{{"phase", {}, {}, [stages] { stages->phase(); }},
                                  {"unwrap", {}, {}, [stages] { stages->unwrap(); }},
                                  {"depth", {}, {}, [stages] { stages->depth(); }}};
}

Result<std::shared_ptr<WholeDecode>> WholeDecode::create(const Scene& scene,
                                                         const PatternSequence& patterns,
                                                         std::shared_ptr<FrameRing> ring) {
    DecodeSettings settings;
    settings.taps = PhaseTaps::least_squares;
    settings.motion = MotionHandling::off;
    auto decoder = DepthDecoder::create(scene.rig(), patterns, scene.size(), settings);
    if (!decoder) {
        return decoder.error();
    }
    return std::shared_ptr<WholeDecode>(new WholeDecode(std::move(*decoder), std::move(ring)));
}

void WholeDecode::run() noexcept {
    decoder_.reset();
    DecodeStatus status;
    for (const FramePtr& frame : ring_->next()) {
        status = decoder_.push(frame);
    }
    made_depth_ = made_depth_ && status.state == DecodeState::depth_ready;
}

}  // namespace xtrack::tools::bench
