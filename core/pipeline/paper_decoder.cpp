// SPDX-License-Identifier: Apache-2.0
#include <xtrack/paper_decoder.hpp>

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include "core/base/setting_up.hpp"
#include "core/pipeline/paper_decoder_impl.hpp"

namespace xtrack {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

Error bad(std::string message) { return {ErrorCode::invalid_argument, std::move(message)}; }

SpatialUnwrapSettings spatial_of(const DecodeSettings& settings) {
    return {settings.step_limit_rad, settings.min_support, settings.min_component_px};
}

// What is dark is masked here; all that a change of would be no change of phases is left out.
DecodeSettings settings_of_phases(const DecodeSettings& paper, bool followed) {
    DecodeSettings settings;
    settings.order = OrderSource::none;
    settings.keep_maps = true;
    settings.min_modulation = 0.0;
    settings.mask_saturated = paper.mask_saturated;
    settings.threads = paper.threads;
    settings.motion = MotionHandling::off;
    if (followed) {
        settings.motion = paper.motion;
        settings.motion_tolerance = paper.motion_tolerance;
        settings.max_motion_px = paper.max_motion_px;
    }
    return settings;
}

// True where projector coordinates fall as the camera's rise, at any depth.
bool falls(const Triangulation& geometry, Axis axis, Size image) {
    constexpr double kAnyDepth_mm = 1000.0;
    const double u = 0.5 * image.width;
    const double v = 0.5 * image.height;
    const bool down = axis == Axis::y;
    return geometry.coordinate_of_depth(u + (down ? 0.0 : 1.0), v + (down ? 1.0 : 0.0),
                                        kAnyDepth_mm) <
           geometry.coordinate_of_depth(u, v, kAnyDepth_mm);
}

}  // namespace

PaperDecoder::Impl::Impl(DecodePlan decode_plan, Size image, const DecodeSettings& paper_settings,
                         SpatialUnwrapper made, std::optional<Triangulation> rig_geometry,
                         const Pinhole& camera)
    : settings(paper_settings),
      plan(std::move(decode_plan)),
      period(&plan.sines.back()),
      used(static_cast<std::size_t>(plan.pattern_count), 0),
      size(image),
      window(plan.pattern_count),
      shown(plan.pattern_count),
      unwrapper(std::move(made)),
      geometry(std::move(rig_geometry)),
      rays(camera),
      orders(image, plan.axis, geometry ? &*geometry : nullptr, period->period_px,
             plan.coded_length_px, (kBackground_mm - kDefaultNearMm) / kMmPerProjectorPx),
      unwrapped(image.width, image.height, kNone),
      unwrapped_before(image.width, image.height, kNone),
      component(image.width, image.height, 0),
      component_before(image.width, image.height, 0) {
    for (const int pattern : period->patterns) {
        used[static_cast<std::size_t>(pattern)] = 1;
    }
    components.reserve(std::min<std::size_t>(
        static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height),
        kMaxPhaseComponents));
    phase_map.period_px = period->period_px;
    phase_map.phase_rad = Image<float>(image.width, image.height, kNone);
    phase_map.modulation = Image<float>(image.width, image.height, 0.0F);
    if (!geometry) {
        difference.resize(image.width, image.height);
    }
    depth.metric = geometry.has_value();
    depth.depth = Image<std::uint16_t>(image.width, image.height, 0);
    depth.quality = Image<std::uint8_t>(image.width, image.height, 0);
    points = Image<float>(3 * image.width, image.height, kNone);
    row_coordinate.resize(image.width, 1);
    row_rays.resize(2 * image.width, 1);
    row_grey.resize(image.width, static_cast<int>(period->patterns.size()));
}

Result<PaperDecoder> PaperDecoder::create(const PatternSequence& patterns, Size image,
                                          const DecodeSettings& settings, const Rig* rig) {
    if (auto valid = validate(settings); !valid) {
        return valid.error();
    }
    if (!is_image_size(image)) {
        return bad("images of " + std::to_string(image.width) + "x" + std::to_string(image.height) +
                   " pixels; give 1 to " + std::to_string(kMaxImageSide_px) +
                   " a side, and 64 million in all");
    }
    DecodeSettings plain;
    plain.taps = PhaseTaps::least_squares;
    auto plan = DecodePlan::create(patterns, plain);
    if (!plan) {
        return plan.error();
    }
    if (plan->sines.empty()) {
        return Error{ErrorCode::unsupported,
                     "pattern sequence: it has no sines, which spatial unwrapping goes by; use "
                     "three or more phases of one period"};
    }
    if (plan->sines.back().kind == PeriodKind::ramp) {
        return Error{ErrorCode::unsupported,
                     "pattern sequence: ramps jump where they begin again, and are not unwrapped "
                     "in space; use sines"};
    }
    const bool metric = rig != nullptr && rig->projector.has_value();
    if (metric && rig->projector->size != patterns.projector_size) {
        return bad("projector_size of the rig and of the pattern sequence differ");
    }
    if (rig != nullptr && rig->camera.size != image) {
        return bad("camera_size of the rig is not that of the images");
    }
    if (rig != nullptr) {
        if (auto valid = validate(*rig); !valid) {
            return bad("rig: " + valid.error().message);
        }
    }
    return base::setting_up("PaperDecoder::create", [&]() -> Result<PaperDecoder> {
        std::optional<Triangulation> geometry;
        if (metric) {
            auto made = Triangulation::create(*rig, patterns.axis, image);
            if (!made) {
                return made.error();
            }
            geometry.emplace(*std::move(made));
        }
        auto unwrapper = SpatialUnwrapper::create(image, spatial_of(settings));
        if (!unwrapper) {
            return unwrapper.error();
        }
        auto impl = std::make_unique<Impl>(*std::move(plan), image, settings, *std::move(unwrapper),
                                           std::move(geometry),
                                           rig != nullptr ? rig->camera : nominal_camera(image));
        impl->carrier_falls =
            impl->geometry && impl->plan.carrier() && falls(*impl->geometry, patterns.axis, image);
        impl->patterns = patterns;
        if (rig != nullptr) {
            impl->rig = *rig;
        }
        if (auto ready = impl->prepare_phases_and_scene(settings); !ready) {
            return ready.error();
        }
        return PaperDecoder(std::move(impl));
    });
}

// Phases are a DepthDecoder's where a period is one image, and where the motion of three steps is
// followed: with a rig DepthDecoder is there for hands that move. Nothing changes on an Error.
Result<void> PaperDecoder::Impl::prepare_phases_and_scene(const DecodeSettings& wanted) {
    const bool steps = period->kind == PeriodKind::steps;
    const bool followed =
        steps && !geometry && plan.pattern_count == 3 && wanted.motion == MotionHandling::follow;
    const DecodeSettings of_phases = settings_of_phases(wanted, followed);
    std::optional<StillScene> new_scene;
    if (wanted.motion != MotionHandling::off && !scene) {
        new_scene.emplace(size);
    }
    if (steps && !followed) {
        phases.reset();
        from_phases = false;
    } else if (phases) {
        const bool other = phases->settings() != of_phases;
        if (auto set = phases->set_settings(of_phases); !set) {
            return set;
        }
        phases_are_stale = phases_are_stale || other;
    } else {
        auto made = DepthDecoder::create(rig, patterns, size, of_phases);
        if (!made) {
            return made.error();
        }
        phases = *std::move(made);
    }
    if (wanted.motion == MotionHandling::off) {
        scene.reset();
    } else if (new_scene) {
        scene = std::move(new_scene);
    }
    return {};
}

DecodeStatus PaperDecoder::Impl::push(const FramePtr& frame) noexcept {
    const auto reject = [](RejectReason reason) {
        return DecodeStatus{DecodeState::rejected, reason};
    };
    if (settings.mode == CaptureMode::hold) {
        return reject(RejectReason::on_hold);
    }
    if (!frame || frame->status != FrameStatus::ok) {
        return reject(RejectReason::damaged);
    }
    if (frame->size() != size || frame->pixels.width() != size.width * frame->channels()) {
        return reject(RejectReason::wrong_size);
    }
    if (frame->pattern == kUnknownPattern) {
        return reject(RejectReason::unknown_pattern);
    }
    if (frame->pattern < 0 || frame->pattern >= plan.pattern_count) {
        return reject(RejectReason::pattern_out_of_range);
    }
    if (last_stamp && frame->stamp < *last_stamp) {
        return reject(RejectReason::time_backwards);
    }
    last_stamp = frame->stamp;
    constexpr DecodeStatus kMore{DecodeState::need_more, RejectReason::none};
    if (used[static_cast<std::size_t>(frame->pattern)] == 0) {
        if (phases) {
            (void)phases->push(frame);
        }
        return kMore;
    }
    bool phase_ready = false;
    const bool steps = period->kind == PeriodKind::steps;
    const bool burst = settings.mode == CaptureMode::burst;
    if (phases && !(steps && burst)) {  // a burst is of its own images, whatever was before it
        const DecodeStatus status = phases->push(frame);
        phase_ready = status.state == DecodeState::depth_ready;
        phases_are_stale = phases_are_stale && !phase_ready;
        if (!phase_ready && !steps) {
            return status;
        }
    }
    window.push(frame);
    const bool complete = std::all_of(period->patterns.begin(), period->patterns.end(),
                                      [&](int pattern) { return window.has(pattern); });
    if (!complete) {
        return kMore;
    }
    shown = window;
    from_phases = phase_ready;
    if (burst) {
        window.clear();
    }
    decode(true);
    learn_still();
    return {DecodeState::depth_ready, RejectReason::none};
}

PaperDecoder::PaperDecoder(std::unique_ptr<Impl> impl) noexcept : impl_(std::move(impl)) {}
PaperDecoder::PaperDecoder(PaperDecoder&&) noexcept = default;
PaperDecoder& PaperDecoder::operator=(PaperDecoder&&) noexcept = default;
PaperDecoder::~PaperDecoder() = default;

DecodeStatus PaperDecoder::push(const FramePtr& frame) noexcept { return impl_->push(frame); }

DecodeStatus PaperDecoder::decode_again() noexcept {
    if (!impl_->decoded) {
        return {DecodeState::need_more, RejectReason::none};
    }
    impl_->decode(false);
    return {DecodeState::depth_ready, RejectReason::none};
}

Result<void> PaperDecoder::set_settings(const DecodeSettings& settings) {
    if (auto valid = validate(settings); !valid) {
        return valid;
    }
    auto set = base::setting_up("PaperDecoder::set_settings",
                                [&] { return impl_->prepare_phases_and_scene(settings); });
    if (set) {
        set = impl_->unwrapper.set_settings(spatial_of(settings));
    }
    if (!set) {
        return set;
    }
    if (settings.mode == CaptureMode::burst && impl_->settings.mode != CaptureMode::burst) {
        impl_->window.clear();  // a decode has used them
    }
    if (settings.keep_maps && !impl_->settings.keep_maps) {
        impl_->points.fill(kNone);  // they are of a decode long ago
    }
    impl_->settings = settings;
    if (settings.mode == CaptureMode::hold) {
        (void)decode_again();
    }
    return {};
}

Result<void> PaperDecoder::learn_background() {
    return base::setting_up("PaperDecoder::learn_background",
                            [&] { return impl_->learn_background(); });
}

void PaperDecoder::forget_background() noexcept {
    impl_->background_wrapped = {};
    impl_->background = {};
    impl_->forget_scene();
}

void PaperDecoder::reset() noexcept {
    if (impl_->phases) {
        impl_->phases->reset();
    }
    impl_->window.clear();
    impl_->shown.clear();
    impl_->last_stamp.reset();
    impl_->decoded = false;
    impl_->orders.forget();
    if (impl_->scene) {
        impl_->scene->forget();
    }
}

int PaperDecoder::frames_needed() const noexcept {
    return static_cast<int>(impl_->period->patterns.size());
}

bool PaperDecoder::uses(const DecodeField& field) const noexcept {
    switch (field.use) {
        case FieldUse::both:
        case FieldUse::paper: return true;
        case FieldUse::pattern: return false;
        case FieldUse::phases: return impl_->phases.has_value();
    }
    return false;
}

const DecodeSettings& PaperDecoder::settings() const noexcept { return impl_->settings; }
const DepthFrame& PaperDecoder::depth() const noexcept { return impl_->depth; }
ImageView<const float> PaperDecoder::points_mm() const noexcept {
    return impl_->settings.keep_maps ? std::as_const(impl_->points).view()
                                     : ImageView<const float>{};
}
const PhaseMap& PaperDecoder::phase() const noexcept { return impl_->phase_map; }
const Image<float>& PaperDecoder::unwrapped_rad() const noexcept { return impl_->unwrapped; }
const Image<std::uint16_t>& PaperDecoder::component() const noexcept { return impl_->component; }
std::span<const PaperComponent> PaperDecoder::components() const noexcept {
    return impl_->components;
}

}  // namespace xtrack
