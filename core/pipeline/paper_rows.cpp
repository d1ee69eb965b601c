// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <utility>

#include "core/base/setting_up.hpp"
#include "core/decode/decode_row.hpp"
#include "core/decode/luma.hpp"
#include "core/pipeline/paper_decoder_impl.hpp"
#include "core/unwrap/reference_plane.hpp"
#include "core/unwrap/spatial_row.hpp"

namespace xtrack {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
constexpr double kTurn_rad = 2.0 * std::numbers::pi;
constexpr int kClipped = 255;

}  // namespace

const std::uint8_t* PaperDecoder::Impl::grey_row(const Frame& frame, int y,
                                                 std::size_t buffer) noexcept {
    const std::uint8_t* pixels = frame.pixels.row(y);
    if (frame.format == PixelFormat::grey8) {
        return pixels;
    }
    std::uint8_t* grey = row_grey.row(static_cast<int>(buffer));
    luma_row(pixels, size.width, grey);
    return grey;
}

void PaperDecoder::Impl::decode_phase_rows(int begin, int end) noexcept {
    std::array<const Frame*, kMaxTaps> frames{};
    bool complete = true;
    for (std::size_t n = 0; n < period->patterns.size(); ++n) {
        frames[n] = shown.clean(period->patterns[n], begin);
        complete = complete && frames[n] != nullptr;
    }
    DecodeRow row;
    row.taps = period->newest_taps.count;
    for (std::size_t n = 0; n < static_cast<std::size_t>(row.taps); ++n) {
        row.re[n] = period->newest_taps.taps[n].re;
        row.im[n] = period->newest_taps.taps[n].im;
    }
    row.count = size.width;
    row.min_modulation = static_cast<float>(settings.min_modulation);
    row.saturation_limit = settings.mask_saturated ? kClipped : kNoSaturationLimit;
    for (int y = begin; y < end; ++y) {
        row.phase_rad = phase_map.phase_rad.row(y);
        row.modulation = phase_map.modulation.row(y);
        if (!complete) {
            std::fill_n(row.phase_rad, size.width, kNone);
            std::fill_n(row.modulation, size.width, 0.0F);
            continue;
        }
        for (std::size_t n = 0; n < static_cast<std::size_t>(row.taps); ++n) {
            row.source[n] = grey_row(*frames[n], y, n);
        }
        decode_row(row);
        period->gamma.apply(size.width, row.phase_rad);
    }
}

void PaperDecoder::Impl::take_phase() noexcept {
    const PhaseMap& seen = phases->phase();
    const auto least = static_cast<float>(settings.min_modulation);
    const auto pattern_rad = static_cast<float>(period->phases_rad.front());
    for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x) {
            const float modulation = seen.modulation.at(x, y);
            const bool good = modulation >= least;
            float phase = seen.phase_rad.at(x, y);
            if (carrier_falls) {
                phase = std::remainder(-phase - 2.0F * pattern_rad, static_cast<float>(kTurn_rad));
            }
            phase_map.phase_rad.at(x, y) = good ? phase : kNone;
            phase_map.modulation.at(x, y) = good ? modulation : 0.0F;
        }
    }
}

void PaperDecoder::Impl::decode_phase() noexcept {
    if (from_phases) {
        take_phase();
        return;
    }
    const std::span<const int> edges = shown.row_edges(size.height);
    for (std::size_t n = 0; n + 1 < edges.size(); ++n) {
        decode_phase_rows(edges[n], edges[n + 1]);
    }
}

bool PaperDecoder::Impl::subtract_background() noexcept {
    if (background_wrapped.empty()) {
        return false;
    }
    for (int y = 0; y < size.height; ++y) {
        subtract_row(
            {size.width, phase_map.phase_rad.row(y), background_wrapped.row(y), difference.row(y)});
    }
    return true;
}

// Where the image shows no background of its own, it is the plane's: behind a thing that stood
// there, or in a shadow.
bool PaperDecoder::Impl::learn_plane(bool keep_seen) {
    const auto found = unwrapper.unwrap(phase_map.phase_rad.view(), phase_map.modulation.view(),
                                        unwrapped.view(), component.view());
    if (found.empty()) {
        return false;
    }
    const auto plane = ReferencePlane::fit(unwrapped.view(), component.view(), found.front().id);
    if (!plane && !keep_seen) {
        return false;
    }
    Image<float> turned(size.width, size.height);
    Image<float> wrapped(size.width, size.height);
    for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x) {
            const double seen = static_cast<double>(phase_map.phase_rad.at(x, y));
            double phase = plane ? plane->at(x, y) : static_cast<double>(unwrapped.at(x, y));
            if (keep_seen && plane && std::isfinite(seen)) {
                phase += std::remainder(seen - phase, kTurn_rad);
            }
            turned.at(x, y) = static_cast<float>(phase);
            wrapped.at(x, y) = std::clamp(static_cast<float>(std::remainder(phase, kTurn_rad)),
                                          -std::numbers::pi_v<float>, std::numbers::pi_v<float>);
        }
    }
    background.swap(turned);
    background_wrapped.swap(wrapped);
    return true;
}

Result<void> PaperDecoder::Impl::learn_background() {
    if (!decoded) {
        return Error{ErrorCode::unsupported,
                     "PaperDecoder::learn_background: nothing was decoded yet; push the images of "
                     "the empty scene first"};
    }
    if (geometry) {
        return {};  // depth is from the camera, not from a background
    }
    if (!learn_plane(true)) {
        return Error{ErrorCode::unsupported,
                     "PaperDecoder::learn_background: the image shows no surface; show a wall"};
    }
    forget_scene();
    decode(false);
    return {};
}

void PaperDecoder::Impl::mask_results() noexcept {
    unwrapped.fill(kNone);
    component.fill(0);
    depth.depth.fill(0);
    depth.quality.fill(0);
    points.fill(kNone);
    components.clear();
    orders.forget();
}

void PaperDecoder::Impl::write_row(int y) noexcept {
    const float* phase = scene      ? scene->moving_rad().row(y)
                         : geometry ? std::as_const(phase_map.phase_rad).row(y)
                                    : std::as_const(difference).row(y);
    float* row_unwrapped = unwrapped.row(y);
    unwrapper.write_row(y, phase, orders.orders(), row_unwrapped, component.row(y));
    if (scene) {
        write_still_row(y);
    }
}

void PaperDecoder::Impl::write_depth_row(int y) noexcept {
    const float* row_unwrapped = unwrapped.row(y);
    DepthRow row;
    const double px_per_rad = period->period_px / kTurn_rad;
    if (geometry) {
        geometry->prepare_row(y, row_rays.row(0), row);
        const auto scale = static_cast<float>(px_per_rad);
        float* coordinate = row_coordinate.row(0);
        for (int x = 0; x < size.width; ++x) {
            coordinate[x] = scale * row_unwrapped[x];
        }
        geometry->undistort_projector_row(y, size.width, coordinate);
        row.coordinate_px = coordinate;
    } else {
        row.coordinate_px = row_unwrapped;
        row.a0 = 1.0F;
        row.b = static_cast<float>(-kBackground_mm);
        row.d = static_cast<float>(-front * kMmPerProjectorPx * px_per_rad);
        row.near_mm = static_cast<float>(kDefaultNearMm);
        row.far_mm = static_cast<float>(kDefaultFarMm);
    }
    row.count = size.width;
    row.modulation = phase_map.modulation.row(y);
    row.depth = depth.depth.row(y);
    row.quality = depth.quality.row(y);
    depth_row(row);
    if (settings.keep_maps) {
        PointsRow of;
        rays.prepare_row(y, of);
        of.count = size.width;
        of.depth = row.depth;
        of.unit_mm = static_cast<float>(kDepthUnitMm);
        of.xyz_mm = points.row(y);
        points_row(of);
    }
}

void PaperDecoder::Impl::write_results(bool fresh) noexcept {
    const ImageView<const float> all =
        geometry ? std::as_const(phase_map.phase_rad).view() : std::as_const(difference).view();
    ImageView<const float> phase = all;
    if (scene) {
        scene->divide(all, std::as_const(phase_map.modulation).view());
        phase = scene->moving_rad().view();
    }
    const auto found = unwrapper.solve(phase, phase_map.modulation.view());
    unwrapped.swap(unwrapped_before);
    component.swap(component_before);
    ComponentOrders::Input input{unwrapper,
                                 found,
                                 phase,
                                 std::as_const(background).view(),
                                 std::as_const(unwrapped_before).view(),
                                 std::as_const(component_before).view(),
                                 front_is_sure || standing_out != 0.0 ? front : 0.0};
    if (scene) {
        input.still_rad = scene->still_rad().view();
        input.known_rad = scene->known_rad().view();
        input.modulation = std::as_const(phase_map.modulation).view();
        input.all_rad = all;
        input.still_pixels = scene->still_pixels();
    }
    orders.choose(input);
    if (!geometry && fresh && find_front()) {
        order_scene_anew();
        write_results(false);
        return;
    }
    for (int y = 0; y < size.height; ++y) {
        write_row(y);
        if (!scene) {
            write_depth_row(y);
        }
    }
    if (scene) {
        fill_outlines();
        if (!geometry) {
            close_bands();  // at the price of fingers that nearly meet
        }
        for (int y = 0; y < size.height; ++y) {
            write_depth_row(y);
        }
    }
    components.clear();
    for (std::size_t i = 0; i < found.size(); ++i) {
        components.push_back(
            {found[i].id, found[i].pixels, orders.orders()[i], orders.ambiguous(i)});
    }
}

void PaperDecoder::Impl::stamp_results() noexcept {
    const auto older = [](const Frame* a, const Frame* b) {
        return a->stamp != b->stamp ? a->stamp < b->stamp : a->sequence < b->sequence;
    };
    std::array<const Frame*, kMaxTaps> frames{};
    std::size_t count = 0;
    for (const int pattern : period->patterns) {
        frames[count++] = shown.newest(pattern);
    }
    std::sort(frames.begin(), frames.begin() + static_cast<std::ptrdiff_t>(count), older);
    const Frame& centre = *frames[count / 2];
    depth.stamp = centre.stamp;
    depth.sequence = centre.sequence;
    depth.span = frames[count - 1]->stamp - frames[0]->stamp;
    phase_map.stamp = centre.stamp;
    if (from_phases) {
        depth.stamp = phase_map.stamp = phases->depth().stamp;
        depth.sequence = phases->depth().sequence;
        depth.span = phases->depth().span;
    }
}

void PaperDecoder::Impl::decode(bool fresh) noexcept {
    if (!fresh && from_phases && std::exchange(phases_are_stale, false)) {
        (void)phases->decode_again();
    }
    stamp_results();
    decode_phase();
    decoded = true;
    if (!geometry && !subtract_background()) {
        // Memory that runs out leaves the background unknown, as too little of a surface does.
        const auto learnt =
            base::setting_up("PaperDecoder", [&]() -> Result<bool> { return learn_plane(false); });
        if (!learnt || !*learnt || !subtract_background()) {
            mask_results();
            return;
        }
    }
    write_results(fresh);
}

}  // namespace xtrack
