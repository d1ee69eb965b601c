// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include <xtrack/sim.hpp>

#include "core/base/frame_pool.hpp"
#include "core/base/setting_up.hpp"
#include "core/sim/renderer.hpp"
#include "core/sim/sensor.hpp"
#include "core/sim/truth.hpp"

namespace xtrack {
namespace {

// Frames that consumers may hold at once before the heap is asked for more: what a decoder keeps of
// every pattern, and a queue. Beyond this a frame of its own is made: a simulation drops nothing.
constexpr std::size_t kPoolFramesPerPattern = 4;
constexpr std::size_t kPoolFrames = 12;
// After the last step: time for the last events to be decided.
constexpr double kTailS = 0.5;

}  // namespace

class SimulatedRig::Impl {
 public:
    explicit Impl(const SimSettings& given)
        : settings(given),
          sensor(given.camera, given.seed, given.rig.camera.size),
          renderer(given, sensor.channels()),
          truth_maker(renderer),
          pool(kPoolFrames + kPoolFramesPerPattern * given.patterns.patterns.size(),
               given.rig.camera.size,
               given.camera.colour ? PixelFormat::bgr8 : PixelFormat::grey8) {
        double end_s = 0.0;
        for (const sim::HandMotion& hand : renderer.hands()) {
            end_s = std::max(end_s, hand.end_s() + kTailS);
            labels.insert(labels.end(), hand.labels().begin(), hand.labels().end());
        }
        std::stable_sort(labels.begin(), labels.end(),
                         [](const SimLabel& a, const SimLabel& b) { return a.start < b.start; });
        if (settings.duration_s > 0.0) {
            end_s = settings.duration_s;
        }
        frames = static_cast<std::uint64_t>(std::llround(end_s * settings.camera.frame_hz));
    }

    SimSettings settings;
    sim::Sensor sensor;
    sim::Renderer renderer;
    sim::TruthMaker truth_maker;
    base::FramePool pool;
    std::vector<SimLabel> labels;
    std::uint64_t frames = 0;
    std::uint64_t next_frame = 0;
    std::uint64_t given_frame = 0;
    bool truth_made = false;
    SimTruth truth;
};

SimulatedRig::SimulatedRig(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
SimulatedRig::~SimulatedRig() = default;

Result<std::unique_ptr<SimulatedRig>> SimulatedRig::create(const SimSettings& settings) {
    if (auto ok = settings.validate(); !ok) {
        return ok.error();
    }
    return base::setting_up("SimulatedRig::create", [&]() -> Result<std::unique_ptr<SimulatedRig>> {
        return std::unique_ptr<SimulatedRig>(new SimulatedRig(std::make_unique<Impl>(settings)));
    });
}

const Rig& SimulatedRig::rig() const { return impl_->settings.rig; }
const PatternSequence& SimulatedRig::patterns() const { return impl_->settings.patterns; }
const std::vector<SimLabel>& SimulatedRig::labels() const { return impl_->labels; }
const SimSettings& SimulatedRig::settings() const { return impl_->settings; }

Duration SimulatedRig::duration() const {
    return Duration{
        std::llround(static_cast<double>(impl_->frames) * 1e9 / impl_->settings.camera.frame_hz)};
}

Duration SimulatedRig::delivery_delay() const {
    const SimCamera& camera = impl_->settings.camera;
    return Duration{std::llround((camera.exposure_s + camera.readout_s) / 2.0 * 1e9)};
}

FrameSource::Item SimulatedRig::next(Duration /*timeout*/) {
    Impl& s = *impl_;
    Item item;
    if (s.next_frame >= s.frames) {
        item.status = SourceStatus::end;
        return item;
    }
    std::shared_ptr<Frame> frame = s.pool.acquire();
    if (frame == nullptr) {
        const SimCamera& camera = s.settings.camera;
        const Size size = s.settings.rig.camera.size;
        frame = std::make_shared<Frame>();
        frame->format = camera.colour ? PixelFormat::bgr8 : PixelFormat::grey8;
        frame->pixels.resize(size.width * frame->channels(), size.height);
    }
    const std::uint64_t sequence = s.next_frame++;
    const PatternAssignment seen = s.renderer.timing().assign(sequence);
    frame->stamp = s.renderer.timing().stamp(sequence);
    frame->sequence = sequence;
    frame->pattern = seen.pattern;
    frame->clean_row_begin = seen.clean_row_begin;
    frame->clean_row_end = seen.clean_row_end;
    s.renderer.expose(sequence, s.sensor.light());
    s.sensor.read_out(sequence, frame->pixels.view());
    s.given_frame = sequence;
    s.truth_made = false;
    item.status = SourceStatus::ok;
    item.frame = std::move(frame);
    return item;
}

const SimTruth& SimulatedRig::truth() {
    Impl& s = *impl_;
    if (!s.truth_made && s.next_frame > 0) {
        s.renderer.draw_geometry(s.given_frame);
        s.truth_maker.make(s.renderer, s.given_frame, s.truth);
        s.truth_made = true;
    }
    return s.truth;
}

}  // namespace xtrack
