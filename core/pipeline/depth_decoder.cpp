// SPDX-License-Identifier: Apache-2.0
#include <xtrack/depth_decoder.hpp>

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/base/setting_up.hpp"
#include "core/decode/decode_row.hpp"
#include "core/decode/luma.hpp"
#include "core/pipeline/depth_decoder_impl.hpp"
#include "core/unwrap/gray_code.hpp"

namespace xtrack {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
// For the direction in which coordinates grow, which is the same at all depths.
constexpr double kAnyDepth_mm = 1000.0;
// That one row is decoded from.
constexpr int kMostImages = std::max(kMaxTaps, 2 * kMaxGrayBits + 2);

}  // namespace

DepthDecoder::Impl::Impl(DecodePlan decode_plan, const DecodeSettings& decode_settings, Size image)
    : settings(decode_settings),
      plan(std::move(decode_plan)),
      size(image),
      window(plan.pattern_count),
      still(plan.sines.size()),
      following(plan.sines.size()) {}

DepthDecoder::Impl::Scratch::Scratch(int width) : grey(width, kMostImages) {
    for (Image<float>* row : {&phase, &modulation, &coordinate, &reference, &ideal, &moving_phase,
                              &moving_modulation, &moving_coordinate}) {
        row->resize(width, 1);
    }
    rays.resize(2 * width, 1);
}

Result<void> DepthDecoder::Impl::prepare() {
    team.emplace(settings.threads);
    for (int member = 0; member < team->members(); ++member) {
        scratches.emplace_back(size.width);
    }
    if (settings.order != OrderSource::none) {
        auto made = Triangulation::create(rig, plan.axis, size);
        if (!made) {
            return made.error();
        }
        geometry.emplace(*std::move(made));
    }
    if (plan.carrier() && geometry) {
        const double u = 0.5 * size.width;
        const double v = 0.5 * size.height;
        const bool down = plan.axis == Axis::y;
        carrier_sign =
            geometry->coordinate_of_depth(u + (down ? 0 : 1), v + (down ? 1 : 0), kAnyDepth_mm) <
                    geometry->coordinate_of_depth(u, v, kAnyDepth_mm)
                ? -1.0
                : 1.0;
    }
    if (plan.colour()) {
        if (auto made = prepare_colours(); !made) {
            return made.error();
        }
    }
    if (settings.order == OrderSource::automatic && !plan.gray) {
        auto made = OrderReference::create(geometry ? &*geometry : nullptr, size,
                                           plan.sines.front().period_px, plan.coded_length_px);
        if (!made) {
            return made.error();
        }
        order = *std::move(made);
    }
    if (settings.order != OrderSource::automatic && plan.sines.empty()) {
        return Error{ErrorCode::unsupported,
                     "pattern sequence: a Gray code without sines has no phase; it gives depth, "
                     "for which order must be automatic and the rig known"};
    }
    if (settings.order == OrderSource::depth_image) {
        order_px = Image<float>(size.width, size.height, kNone);
    }
    depth.depth = Image<std::uint16_t>(size.width, size.height, 0);
    depth.quality = Image<std::uint8_t>(size.width, size.height, 0);
    depth.metric = geometry.has_value();
    if (settings.keep_maps) {
        phase_map.period_px = plan.sines.empty() ? 0.0 : plan.sines.back().period_px;
        if (!plan.sines.empty()) {
            phase_map.phase_rad = Image<float>(size.width, size.height, kNone);
        }
        phase_map.modulation = Image<float>(size.width, size.height, 0.0F);
        average = Image<float>(size.width, size.height, 0.0F);
        if (geometry) {
            coordinate = Image<float>(size.width, size.height, kNone);
            const bool phases = !plan.sines.empty() && plan.sines.back().kind != PeriodKind::ramp;
            if (phases) {
                sigma = Image<float>(size.width, size.height, 0.0F);
            }
        }
    }
    if (plan.carrier()) {
        carrier_grey.resize(size.width, size.height);
    }
    if (settings.motion != MotionHandling::off && plan.motion_matters()) {
        MotionEstimator::Settings motion_settings;
        motion_settings.max_shift_px = settings.max_motion_px;
        if (plan.cycle && plan.pattern_count == 3) {
            motion_settings.phases_rad = plan.pattern_phase_rad;
        }
        motion.emplace(size, plan.pattern_count, motion_settings);
        moving_depths.reserve(static_cast<std::size_t>(motion->cells_x()) *
                              static_cast<std::size_t>(motion->cells_y()));
    }
    return {};
}

DecodeStatus DepthDecoder::Impl::push(const FramePtr& frame) noexcept {
    const auto reject = [](RejectReason reason) {
        return DecodeStatus{DecodeState::rejected, reason};
    };
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
    if (palette && frame->format == PixelFormat::grey8) {
        return reject(RejectReason::no_colour);
    }
    last_stamp = frame->stamp;
    newest = frame;
    window.push(frame);
    if (motion) {
        set_phase_gradient();
        motion->update(window, *frame);
    }
    for (const int pattern : plan.needed) {
        if (!window.has(pattern)) {
            return {DecodeState::need_more, RejectReason::none};
        }
    }
    if (palette && frame->pattern != plan.sines.back().patterns.front()) {
        // Of use for the order of the next image, but no phase that was not seen before.
        return {DecodeState::need_more, RejectReason::none};
    }
    last_decoded = frame;
    decode(*frame);
    if (palette) {
        palette->learn();
    }
    return {DecodeState::depth_ready, RejectReason::none};
}

void DepthDecoder::Impl::decode(const Frame& frame) noexcept {
    before.reset();
    moving_depth_mm = motion && motion->moving() ? find_moving_depth_mm() : 0.0;
    oldest_image = frame.stamp;
    if (palette) {
        tell_surfaces();
    }
    if (plan.carrier()) {
        find_carrier(frame);
    }
    const std::span<const int> edges = window.row_edges(size.height);
    for (std::size_t n = 0; n + 1 < edges.size(); ++n) {
        decode_rows(edges[n], edges[n + 1]);
    }
    register_depth(frame);
}

void DepthDecoder::Impl::find_carrier(const Frame& frame) noexcept {
    const bool down = plan.axis == Axis::y;
    ImageView<const std::uint8_t> grey = frame.pixels.view();
    if (frame.format == PixelFormat::bgr8) {
        for (int y = 0; y < size.height; ++y) {
            luma_row(frame.pixels.row(y), size.width, carrier_grey.row(y));
        }
        grey = std::as_const(carrier_grey).view();
    }
    if (const double period_px = find_carrier_px(grey, down); period_px > 0.0) {
        carrier =
            carrier_taps(carrier_sign * period_px, down, plan.sines.front().phases_rad.front());
    }
}

void DepthDecoder::Impl::register_depth(const Frame& frame) noexcept {
    Images images;
    const Frame* centre = nullptr;
    if (motion && settings.motion == MotionHandling::follow) {
        centre = &frame;
    } else if (!plan.sines.empty() &&
               choose_images(plan.sines.size() - 1, size.height / 2, images)) {
        std::sort(images.frames.begin(), images.frames.begin() + images.taps.count,
                  [](const Frame* a, const Frame* b) {
                      return a->stamp != b->stamp ? a->stamp < b->stamp : a->sequence < b->sequence;
                  });
        centre = images.frames[static_cast<std::size_t>(images.taps.count / 2)];
    } else {
        // The middle image of those that are used, by time.
        const auto older = [](const Frame& a, const Frame& b) {
            return a.stamp != b.stamp ? a.stamp < b.stamp : a.sequence < b.sequence;
        };
        for (const int candidate : plan.needed) {
            const Frame* image = window.newest(candidate);
            std::size_t earlier = 0;
            for (const int other : plan.needed) {
                earlier += older(*window.newest(other), *image) ? 1U : 0U;
            }
            if (earlier == plan.needed.size() / 2 || centre == nullptr) {
                centre = image;
            }
        }
    }
    depth.span = frame.stamp - oldest_image;
    depth.stamp = centre->stamp;
    depth.sequence = centre->sequence;
    phase_map.stamp = centre->stamp;
}

const char* describe(RejectReason reason) noexcept {
    switch (reason) {
        case RejectReason::none: return "taken";
        case RejectReason::damaged: return "the frame is missing or marked as damaged";
        case RejectReason::wrong_size: return "the frame is not of the rig's camera_size";
        case RejectReason::unknown_pattern: return "nobody knows which pattern the frame saw";
        case RejectReason::pattern_out_of_range:
            return "the frame's pattern index is not in the pattern sequence";
        case RejectReason::no_colour:
            return "the frame is grey, its pattern is told apart by colour; record in colour";
        case RejectReason::time_backwards:
            return "the frame's stamp is before that of the frame before it";
        case RejectReason::on_hold: return "the decoder is on hold and takes no frames";
    }
    return "";
}

Result<DepthDecoder> DepthDecoder::create(const Rig& rig, const PatternSequence& patterns,
                                          Size image, const DecodeSettings& settings) {
    if (auto valid = validate(settings); !valid) {
        return valid.error();
    }
    if (!is_image_size(image)) {
        return Error{ErrorCode::invalid_argument,
                     "images of " + std::to_string(image.width) + "x" +
                         std::to_string(image.height) + " pixels; give 1 to " +
                         std::to_string(kMaxImageSide_px) + " a side, and 64 million in all"};
    }
    if (settings.order != OrderSource::none && rig.projector &&
        rig.projector->size != patterns.projector_size) {
        return Error{ErrorCode::invalid_argument,
                     "projector_size of the rig and of the pattern sequence differ"};
    }
    return base::setting_up("DepthDecoder::create", [&]() -> Result<DepthDecoder> {
        auto plan = DecodePlan::create(patterns, settings);
        if (!plan) {
            return plan.error();
        }
        auto impl = std::make_unique<Impl>(*std::move(plan), settings, image);
        impl->rig = rig;
        impl->patterns = patterns;
        if (auto ready = impl->prepare(); !ready) {
            return ready.error();
        }
        return DepthDecoder(std::move(impl));
    });
}

DepthDecoder::DepthDecoder(std::unique_ptr<Impl> impl) noexcept : impl_(std::move(impl)) {}
DepthDecoder::DepthDecoder(DepthDecoder&&) noexcept = default;
DepthDecoder& DepthDecoder::operator=(DepthDecoder&&) noexcept = default;
DepthDecoder::~DepthDecoder() = default;

DecodeStatus DepthDecoder::push(const FramePtr& frame) noexcept { return impl_->push(frame); }

DecodeStatus DepthDecoder::decode_again() noexcept {
    // What moves is known of the newest image alone.
    if (!impl_->last_decoded || impl_->newest != impl_->last_decoded) {
        return {DecodeState::need_more, RejectReason::none};
    }
    impl_->decode(*impl_->last_decoded);
    return {DecodeState::depth_ready, RejectReason::none};
}

Result<void> DepthDecoder::set_settings(const DecodeSettings& settings) {
    const DecodeSettings& now = impl_->settings;
    const bool same_maps = settings.taps == now.taps && settings.order == now.order &&
                           settings.motion == now.motion &&
                           settings.max_motion_px == now.max_motion_px &&
                           settings.keep_maps == now.keep_maps && settings.threads == now.threads;
    if (same_maps) {
        if (auto valid = validate(settings); !valid) {
            return valid;
        }
        impl_->settings = settings;
        return {};
    }
    auto made = create(impl_->rig, impl_->patterns, impl_->size, settings);
    if (!made) {
        return made.error();
    }
    Impl& fresh = *made->impl_;
    fresh.window = std::move(impl_->window);
    fresh.newest = impl_->newest;
    fresh.last_decoded = std::move(impl_->last_decoded);
    fresh.last_stamp = impl_->last_stamp;
    if (!fresh.order_px.empty() && !impl_->order_px.empty()) {
        fresh.order_px = std::move(impl_->order_px);
    }
    const bool same_places = fresh.geometry.has_value() == impl_->geometry.has_value();
    if (fresh.palette && same_places) {
        fresh.palette = std::move(impl_->palette);
    }
    if (same_places) {
        fresh.carrier = impl_->carrier;
    }
    fresh.before = impl_->before ? std::move(impl_->before) : std::move(impl_);
    impl_ = std::move(made->impl_);
    return {};
}

bool DepthDecoder::uses(const DecodeField& field) noexcept { return field.use != FieldUse::paper; }

const DecodeSettings& DepthDecoder::settings() const noexcept { return impl_->settings; }
const DepthFrame& DepthDecoder::depth() const noexcept { return impl_->results().depth; }
const PhaseMap& DepthDecoder::phase() const noexcept { return impl_->results().phase_map; }
const Image<float>& DepthDecoder::coordinate_px() const noexcept {
    return impl_->results().coordinate;
}
const Image<float>& DepthDecoder::sigma_mm() const noexcept { return impl_->results().sigma; }

const Image<float>& DepthDecoder::average() const noexcept { return impl_->results().average; }

Result<void> DepthDecoder::set_order_depth(ImageView<const std::uint16_t> depth, double unit_mm) {
    if (impl_->order_px.empty()) {
        return Error{ErrorCode::invalid_argument,
                     "order depth: the decoder was not made with OrderSource::depth_image"};
    }
    if (depth.size() != impl_->size) {
        return Error{ErrorCode::invalid_argument,
                     "order depth: the depth image is not of the frames' size"};
    }
    if (!(unit_mm > 0.0)) {
        return Error{ErrorCode::invalid_argument, "order depth: the unit must be above 0 mm"};
    }
    for (int y = 0; y < depth.height; ++y) {
        impl_->geometry->coordinate_of_depth_row(y, depth.width, depth.row(y), unit_mm,
                                                 impl_->order_px.row(y));
    }
    return {};
}

void DepthDecoder::reset() noexcept {
    impl_->window.clear();
    impl_->newest.reset();
    impl_->last_decoded.reset();
    if (impl_->motion) {
        impl_->motion->clear();
    }
    if (impl_->palette) {
        impl_->palette->clear();
    }
    impl_->carrier.count = 0;
    impl_->last_stamp.reset();
}

int DepthDecoder::frames_needed() const noexcept {
    return static_cast<int>(impl_->plan.needed.size());
}

const char* DepthDecoder::instruction_set() noexcept { return decode_instruction_set(); }

}  // namespace xtrack
