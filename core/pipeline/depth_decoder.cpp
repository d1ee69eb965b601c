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

#include "core/decode/decode_row.hpp"
#include "core/decode/luma.hpp"
#include "core/depth/triangulation.hpp"
#include "core/pipeline/decode_plan.hpp"
#include "core/pipeline/frame_window.hpp"
#include "core/pipeline/order_reference.hpp"
#include "core/unwrap/gray_code.hpp"
#include "core/unwrap/unwrap_row.hpp"

namespace xtrack {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
constexpr int kClipped = 255;
// A coordinate may pass the projector's border by this much of noise, px.
constexpr double kBorderMarginPx = 1.0;

}  // namespace

struct DepthDecoder::Impl {
    Impl(DecodePlan decode_plan, const DecodeSettings& decode_settings, Size image)
        : settings(decode_settings),
          plan(std::move(decode_plan)),
          size(image),
          window(plan.pattern_count) {}

    // The images that one period is decoded from, in one stretch of rows.
    struct Images {
        const TapSet* taps = nullptr;
        std::array<const Frame*, kMaxTaps> frames{};
    };

    Result<void> prepare(const Rig& rig);
    DecodeStatus push(const FramePtr& frame) noexcept;
    void decode_rows(int begin, int end) noexcept;
    void mask_rows(int begin, int end) noexcept;
    bool choose_images(std::size_t sine, int y, Images& images) const noexcept;
    const std::uint8_t* grey_row(const Frame& frame, int y, std::size_t buffer) noexcept;
    void decode_sine_row(std::size_t sine, const Images& images, int y, float* phase,
                         float* modulation) noexcept;
    void decode_gray_row(int y, float* coordinate, float* modulation) noexcept;
    const float* first_reference(int y, float* scratch, float* modulation) noexcept;
    void average_row(const Images& images, int y) noexcept;
    void register_depth() noexcept;

    DecodeSettings settings;
    DecodePlan plan;
    Size size;
    FrameWindow window;
    std::optional<Triangulation> geometry;
    OrderReference order;
    Image<float> order_px;  // from set_order_depth()
    std::optional<Stamp> last_stamp;
    DepthFrame depth;
    PhaseMap phase_map;
    Image<float> coordinate;
    Image<float> average;
    // Scratch rows, small enough to stay in the first-level cache.
    Image<float> row_phase, row_modulation, row_coordinate, row_reference, row_ideal, row_rays;
    Image<std::uint8_t> row_grey;
};

Result<void> DepthDecoder::Impl::prepare(const Rig& rig) {
    if (settings.order != OrderSource::none) {
        auto made = Triangulation::create(rig, plan.axis, size);
        if (!made) {
            return made.error();
        }
        geometry.emplace(*std::move(made));
    }
    if (settings.order == OrderSource::automatic && !plan.gray) {
        auto made = OrderReference::create(geometry ? &*geometry : nullptr, size,
                                           plan.sines.front().period_px, plan.coded_length_px);
        if (!made) {
            return made.error();
        }
        order = *std::move(made);
    }
    if (settings.order == OrderSource::depth_image) {
        if (plan.sines.empty()) {
            return Error{ErrorCode::unsupported,
                         "pattern sequence: without sines there is no order to take from a depth "
                         "image; choose automatic"};
        }
        order_px = Image<float>(size.width, size.height, kNone);
    }
    depth.depth.resize(size.width, size.height);
    depth.quality.resize(size.width, size.height);
    depth.metric = geometry.has_value();
    if (settings.keep_maps) {
        phase_map.period_px = plan.sines.empty() ? 0.0 : plan.sines.back().period_px;
        if (!plan.sines.empty()) {
            phase_map.phase_rad.resize(size.width, size.height);
        }
        phase_map.modulation.resize(size.width, size.height);
        average.resize(size.width, size.height);
        if (geometry) {
            coordinate.resize(size.width, size.height);
        }
    }
    for (Image<float>* row :
         {&row_phase, &row_modulation, &row_coordinate, &row_reference, &row_ideal}) {
        row->resize(size.width, 1);
    }
    row_rays.resize(2 * size.width, 1);
    row_grey.resize(size.width, std::max(kMaxTaps, 2 * kMaxGrayBits + 2));
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
    last_stamp = frame->stamp;
    window.push(frame);
    for (const int pattern : plan.needed) {
        if (!window.has(pattern)) {
            return {DecodeState::need_more, RejectReason::none};
        }
    }
    const std::span<const int> edges = window.row_edges(size.height);
    for (std::size_t n = 0; n + 1 < edges.size(); ++n) {
        decode_rows(edges[n], edges[n + 1]);
    }
    register_depth();
    return {DecodeState::depth_ready, RejectReason::none};
}

void DepthDecoder::Impl::register_depth() noexcept {
    Images images;
    const Frame* centre = nullptr;
    if (!plan.sines.empty() && choose_images(plan.sines.size() - 1, size.height / 2, images)) {
        std::sort(images.frames.begin(), images.frames.begin() + images.taps->count,
                  [](const Frame* a, const Frame* b) {
                      return a->stamp != b->stamp ? a->stamp < b->stamp : a->sequence < b->sequence;
                  });
        centre = images.frames[static_cast<std::size_t>(images.taps->count / 2)];
    } else {
        // The middle image of those that are used, by time.
        const auto older = [](const Frame& a, const Frame& b) {
            return a.stamp != b.stamp ? a.stamp < b.stamp : a.sequence < b.sequence;
        };
        for (const int candidate : plan.needed) {
            const Frame* frame = window.newest(candidate);
            std::size_t before = 0;
            for (const int other : plan.needed) {
                before += older(*window.newest(other), *frame) ? 1U : 0U;
            }
            if (before == plan.needed.size() / 2 || centre == nullptr) {
                centre = frame;
            }
        }
    }
    depth.stamp = centre->stamp;
    depth.sequence = centre->sequence;
    phase_map.stamp = centre->stamp;
}

bool DepthDecoder::Impl::choose_images(std::size_t sine, int y, Images& images) const noexcept {
    const SinePlan& period = plan.sines[sine];
    if (plan.cycle) {
        const auto count = static_cast<std::size_t>(plan.cycle->images);
        if (window.consecutive(y, std::span(images.frames).first(count))) {
            images.taps = &plan.cycle->designs[static_cast<std::size_t>(images.frames[0]->pattern)];
            return true;
        }
    }
    images.taps = &period.newest_taps;
    for (std::size_t n = 0; n < period.patterns.size(); ++n) {
        images.frames[n] = window.clean(period.patterns[n], y);
        if (images.frames[n] == nullptr) {
            return false;
        }
    }
    return true;
}

const std::uint8_t* DepthDecoder::Impl::grey_row(const Frame& frame, int y,
                                                 std::size_t buffer) noexcept {
    const std::uint8_t* pixels = frame.pixels.row(y);
    if (frame.format == PixelFormat::grey8) {
        return pixels;
    }
    std::uint8_t* grey = row_grey.row(static_cast<int>(buffer));
    luma_row(pixels, size.width, grey);
    return grey;
}

void DepthDecoder::Impl::decode_sine_row(std::size_t sine, const Images& images, int y,
                                         float* phase, float* modulation) noexcept {
    DecodeRow row;
    row.taps = images.taps->count;
    for (std::size_t n = 0; n < static_cast<std::size_t>(row.taps); ++n) {
        row.source[n] = grey_row(*images.frames[n], y, n);
        row.re[n] = images.taps->taps[n].re;
        row.im[n] = images.taps->taps[n].im;
    }
    row.count = size.width;
    row.min_modulation = static_cast<float>(settings.min_modulation);
    row.saturation_limit = settings.mask_saturated ? kClipped : kNoSaturationLimit;
    row.phase_rad = phase;
    row.modulation = modulation;
    decode_row(row);
    plan.sines[sine].gamma.apply(size.width, phase);
}

void DepthDecoder::Impl::decode_gray_row(int y, float* coordinate_px, float* modulation) noexcept {
    const GrayPlan& gray = *plan.gray;
    GrayRow row;
    row.count = size.width;
    row.bits = gray.bits;
    std::size_t buffer = 0;
    const auto source = [&](int pattern) -> const std::uint8_t* {
        return pattern < 0 ? nullptr : grey_row(*window.clean(pattern, y), y, buffer++);
    };
    for (std::size_t bit = 0; bit < static_cast<std::size_t>(gray.bits); ++bit) {
        row.image[bit] = source(gray.image[bit]);
        row.inverse[bit] = source(gray.inverse[bit]);
    }
    row.white = source(gray.white);
    row.black = source(gray.black);
    row.cell_px = gray.cell_px;
    row.offset_px = gray.offset_px;
    row.min_modulation = static_cast<float>(settings.min_modulation);
    row.edge_guard = static_cast<float>(settings.gray_edge_guard);
    row.centre_only = plan.sines.empty();
    row.coordinate_px = coordinate_px;
    row.modulation = modulation;
    gray_code_row(row);
    if (settings.keep_maps && row.white != nullptr && row.black != nullptr) {
        float* mean = average.row(y);
        for (int i = 0; i < size.width; ++i) {
            mean[i] = 0.5F * static_cast<float>(row.white[i] + row.black[i]);
        }
    }
}

const float* DepthDecoder::Impl::first_reference(int y, float* scratch,
                                                 float* modulation) noexcept {
    if (settings.order == OrderSource::depth_image) {
        return order_px.row(y);
    }
    if (plan.gray) {
        decode_gray_row(y, scratch, modulation);
        return scratch;
    }
    return order.row(y);
}

void DepthDecoder::Impl::average_row(const Images& images, int y) noexcept {
    float* mean = average.row(y);
    std::fill(mean, mean + size.width, 0.0F);
    const float weight = 1.0F / static_cast<float>(images.taps->count);
    for (std::size_t n = 0; n < static_cast<std::size_t>(images.taps->count); ++n) {
        const std::uint8_t* grey = grey_row(*images.frames[n], y, n);
        for (int i = 0; i < size.width; ++i) {
            mean[i] += weight * static_cast<float>(grey[i]);
        }
    }
}

void DepthDecoder::Impl::mask_rows(int begin, int end) noexcept {
    for (int y = begin; y < end; ++y) {
        std::fill_n(depth.depth.row(y), size.width, std::uint16_t{0});
        std::fill_n(depth.quality.row(y), size.width, std::uint8_t{0});
        if (settings.keep_maps) {
            if (!phase_map.phase_rad.empty()) {
                std::fill_n(phase_map.phase_rad.row(y), size.width, kNone);
            }
            std::fill_n(phase_map.modulation.row(y), size.width, 0.0F);
            std::fill_n(average.row(y), size.width, 0.0F);
            if (!coordinate.empty()) {
                std::fill_n(coordinate.row(y), size.width, kNone);
            }
        }
    }
}

void DepthDecoder::Impl::decode_rows(int begin, int end) noexcept {
    std::array<Images, kMaxTaps> images;
    const std::size_t sines = std::min<std::size_t>(plan.sines.size(), images.size());
    bool complete = true;
    for (const int pattern : plan.needed) {
        complete = complete && window.clean(pattern, begin) != nullptr;
    }
    for (std::size_t n = 0; n < sines; ++n) {
        complete = complete && choose_images(n, begin, images[n]);
    }
    if (!complete) {
        mask_rows(begin, end);
        return;
    }
    for (int y = begin; y < end; ++y) {
        float* phase = row_phase.row(0);
        float* modulation =
            settings.keep_maps ? phase_map.modulation.row(y) : row_modulation.row(0);
        float* found = coordinate.empty() ? row_coordinate.row(0) : coordinate.row(y);
        float* other = row_reference.row(0);
        if (!geometry) {
            if (sines > 0) {
                float* kept = settings.keep_maps ? phase_map.phase_rad.row(y) : phase;
                decode_sine_row(sines - 1, images[sines - 1], y, kept, modulation);
                if (settings.keep_maps) {
                    average_row(images[sines - 1], y);
                }
            }
            std::fill_n(depth.depth.row(y), size.width, std::uint16_t{0});
            std::fill_n(depth.quality.row(y), size.width, std::uint8_t{0});
            continue;
        }
        // Two buffers take turns as reference and result, so that the last result lands in `found`.
        float* result = sines % 2 == 1 ? found : other;
        float* spare = sines % 2 == 1 ? other : found;
        const float* reference = first_reference(y, spare, modulation);
        for (std::size_t n = 0; n < sines; ++n) {
            const bool last = n + 1 == sines;
            float* wrapped = last && settings.keep_maps ? phase_map.phase_rad.row(y) : phase;
            decode_sine_row(n, images[n], y, wrapped, modulation);
            UnwrapRow row;
            row.count = size.width;
            row.reference_px = reference;
            row.phase_rad = wrapped;
            row.period_px = plan.sines[n].period_px;
            row.tolerance = n == 0 && settings.order == OrderSource::automatic && !plan.gray
                                ? std::numeric_limits<float>::infinity()
                                : static_cast<float>(settings.order_tolerance);
            row.coordinate_min_px = static_cast<float>(-0.5 - kBorderMarginPx);
            row.coordinate_max_px =
                static_cast<float>(plan.coded_length_px - 0.5 + kBorderMarginPx);
            row.coordinate_px = result;
            unwrap_row(row);
            reference = result;
            std::swap(result, spare);
        }
        if (settings.keep_maps && sines > 0) {
            average_row(images[sines - 1], y);
        }
        float* ideal = row_ideal.row(0);
        DepthRow row;
        geometry->prepare_row(y, row_rays.row(0), row);
        row.count = size.width;
        row.coordinate_px = reference;
        if (geometry->projector_distorted()) {
            std::copy(reference, reference + size.width, ideal);
            geometry->undistort_projector_row(y, size.width, ideal);
            row.coordinate_px = ideal;
        }
        row.modulation = modulation;
        row.depth = depth.depth.row(y);
        row.quality = depth.quality.row(y);
        depth_row(row);
    }
}

const char* describe(RejectReason reason) noexcept {
    switch (reason) {
        case RejectReason::none: return "taken";
        case RejectReason::damaged: return "the frame is missing or marked as damaged";
        case RejectReason::wrong_size: return "the frame is not of the rig's camera_size";
        case RejectReason::unknown_pattern: return "nobody knows which pattern the frame saw";
        case RejectReason::pattern_out_of_range:
            return "the frame's pattern index is not in the pattern sequence";
        case RejectReason::time_backwards:
            return "the frame's stamp is before that of the frame before it";
    }
    return "";
}

Result<DepthDecoder> DepthDecoder::create(const Rig& rig, const PatternSequence& patterns,
                                          Size image, const DecodeSettings& settings) {
    if (auto valid = validate(settings); !valid) {
        return valid.error();
    }
    if (image.width < 1 || image.height < 1) {
        return Error{ErrorCode::invalid_argument, "images must have at least one pixel"};
    }
    auto plan = DecodePlan::create(patterns, settings);
    if (!plan) {
        return plan.error();
    }
    if (settings.order != OrderSource::none && rig.projector &&
        rig.projector->size != patterns.projector_size) {
        return Error{ErrorCode::invalid_argument,
                     "projector_size of the rig and of the pattern sequence differ"};
    }
    auto impl = std::make_unique<Impl>(*std::move(plan), settings, image);
    if (auto ready = impl->prepare(rig); !ready) {
        return ready.error();
    }
    return DepthDecoder(std::move(impl));
}

DepthDecoder::DepthDecoder(std::unique_ptr<Impl> impl) noexcept : impl_(std::move(impl)) {}
DepthDecoder::DepthDecoder(DepthDecoder&&) noexcept = default;
DepthDecoder& DepthDecoder::operator=(DepthDecoder&&) noexcept = default;
DepthDecoder::~DepthDecoder() = default;

DecodeStatus DepthDecoder::push(const FramePtr& frame) noexcept { return impl_->push(frame); }
const DepthFrame& DepthDecoder::depth() const noexcept { return impl_->depth; }
const PhaseMap& DepthDecoder::phase() const noexcept { return impl_->phase_map; }
const Image<float>& DepthDecoder::coordinate_px() const noexcept { return impl_->coordinate; }
const Image<float>& DepthDecoder::average() const noexcept { return impl_->average; }

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
    impl_->last_stamp.reset();
}

int DepthDecoder::frames_needed() const noexcept {
    return static_cast<int>(impl_->plan.needed.size());
}

const char* DepthDecoder::instruction_set() noexcept { return decode_instruction_set(); }

}  // namespace xtrack
