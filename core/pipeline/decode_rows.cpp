// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <span>

#include "core/decode/decode_row.hpp"
#include "core/decode/luma.hpp"
#include "core/decode/rgb_row.hpp"
#include "core/depth/sigma_row.hpp"
#include "core/pipeline/depth_decoder_impl.hpp"
#include "core/unwrap/gray_code.hpp"
#include "core/unwrap/unwrap_row.hpp"

namespace xtrack {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
constexpr int kClipped = 255;
// A coordinate may pass the projector's border by this much of noise, px.
constexpr double kBorderMarginPx = 1.0;
constexpr int kBandRows = 16;

}  // namespace

bool DepthDecoder::Impl::choose_images(std::size_t sine, int y, Images& images) const noexcept {
    const SinePlan& period = plan.sines[sine];
    if (plan.cycle) {
        const auto count = static_cast<std::size_t>(plan.cycle->images);
        if (window.consecutive(y, std::span(images.frames).first(count))) {
            images.taps = plan.cycle->designs[static_cast<std::size_t>(images.frames[0]->pattern)];
            return true;
        }
    }
    if (period.kind == PeriodKind::carrier) {
        return choose_carrier_image(period, y, images);
    }
    if (period.kind == PeriodKind::colour) {
        choose_colour_images(period, y, images);
        return images.taps.count > 0;
    }
    // Every frame of a pattern that is held: their mean has less noise, and as each pattern keeps
    // its weight, harmonics err as in the plain taps.
    images.taps.count = 0;
    for (std::size_t n = 0; n < period.patterns.size(); ++n) {
        std::array<const Frame*, FrameWindow::kFramesPerShow> frames{};
        const int left =
            kMaxTaps - images.taps.count - static_cast<int>(period.patterns.size() - n);
        const std::size_t seen = std::min(window.clean_show(period.patterns[n], y, frames),
                                          static_cast<std::size_t>(1 + std::max(left, 0)));
        if (seen == 0) {
            return false;
        }
        Tap tap = period.newest_taps.taps[n];
        tap.re /= static_cast<float>(seen);
        tap.im /= static_cast<float>(seen);
        for (std::size_t k = 0; k < seen; ++k) {
            const auto at = static_cast<std::size_t>(images.taps.count++);
            images.taps.taps[at] = tap;
            images.frames[at] = frames[k];
        }
    }
    return true;
}

bool DepthDecoder::Impl::choose_carrier_image(const SinePlan& period, int y,
                                              Images& images) const noexcept {
    const Frame* frame = window.clean(period.patterns.front(), y);
    images.taps = carrier;
    images.frames.fill(frame);
    return frame != nullptr && carrier.count > 0;
}

void DepthDecoder::Impl::choose_colour_images(const SinePlan& period, int y,
                                              Images& images) const noexcept {
    std::array<const Frame*, FrameWindow::kFramesPerShow> frames{};
    static_assert(FrameWindow::kFramesPerShow <= kMaxColourFrames);
    const std::size_t seen = window.clean_show(period.patterns.front(), y, frames);
    images.taps.count = static_cast<int>(seen);
    for (std::size_t k = 0; k < seen; ++k) {
        // The channels' taps are those of a pattern whose red has the phase 0.
        const auto turn = std::polar(1.0 / static_cast<double>(seen), -period.phases_rad.front());
        images.taps.taps[k] = {static_cast<float>(turn.real()), static_cast<float>(turn.imag())};
        images.frames[k] = frames[k];
    }
}

const std::uint8_t* DepthDecoder::Impl::grey_row(const Frame& frame, int y, std::size_t buffer,
                                                 Scratch& scratch) const noexcept {
    const std::uint8_t* pixels = frame.pixels.row(y);
    if (frame.format == PixelFormat::grey8) {
        return pixels;
    }
    std::uint8_t* grey = scratch.grey.row(static_cast<int>(buffer));
    luma_row(pixels, size.width, grey);
    return grey;
}

// A ramp's grey value between black and white, as a phase.
void DepthDecoder::Impl::decode_ramp_row(std::size_t sine, int y, const RowOut& out,
                                         Scratch& scratch) const noexcept {
    const SinePlan& period = plan.sines[sine];
    const std::uint8_t* ramp = grey_row(*window.clean(period.patterns.front(), y), y, 0, scratch);
    const std::uint8_t* white = grey_row(*window.clean(plan.white, y), y, 1, scratch);
    const std::uint8_t* black = grey_row(*window.clean(plan.black, y), y, 2, scratch);
    constexpr float kTurn = 2.0F * std::numbers::pi_v<float>;
    for (int x = 0; x < size.width; ++x) {
        const float range = static_cast<float>(white[x]) - static_cast<float>(black[x]);
        const bool good = range >= 2.0F * static_cast<float>(settings.min_modulation) &&
                          (white[x] < kClipped || !settings.mask_saturated);
        const float light = static_cast<float>(ramp[x] - black[x]) / std::max(range, 1.0F);
        float share = std::clamp(light, 0.0F, 1.0F);
        if (!plan.grey.linear()) {
            share = static_cast<float>(plan.grey.value(static_cast<double>(share)));
        }
        out.phase[x] = good ? (share > 0.5F ? share - 1.0F : share) * kTurn : kNone;
        out.modulation[x] = good ? 0.5F * range : 0.0F;
    }
}

void DepthDecoder::Impl::decode_sine_row(std::size_t sine, const Images& images, int y,
                                         const RowOut& out, Scratch& scratch) const noexcept {
    if (plan.sines[sine].kind == PeriodKind::ramp) {
        decode_ramp_row(sine, y, out, scratch);
        return;
    }
    const auto count = static_cast<std::size_t>(images.taps.count);
    // Columns in which every shifted image has a pixel.
    int begin = 0;
    int end = size.width;
    bool inside = true;
    for (std::size_t n = 0; n < count; ++n) {
        const Tap& tap = images.taps.taps[n];
        begin = std::max(begin, -tap.dx);
        end = std::min(end, size.width - tap.dx);
        inside = inside && y + tap.dy >= 0 && y + tap.dy < size.height &&
                 saw(*images.frames[n], y + tap.dy);
    }
    if (!inside || begin >= end) {
        std::fill_n(out.phase, size.width, kNone);
        std::fill_n(out.modulation, size.width, 0.0F);
        return;
    }
    std::fill_n(out.phase, begin, kNone);
    std::fill_n(out.modulation, begin, 0.0F);
    std::fill(out.phase + end, out.phase + size.width, kNone);
    std::fill(out.modulation + end, out.modulation + size.width, 0.0F);
    const auto fill = [&](auto& row) {
        row.count = end - begin;
        row.min_modulation = static_cast<float>(settings.min_modulation);
        row.saturation_limit = settings.mask_saturated ? kClipped : kNoSaturationLimit;
        row.phase_rad = out.phase + begin;
        row.modulation = out.modulation + begin;
    };
    if (plan.sines[sine].kind == PeriodKind::colour) {
        RgbRow row;
        fill(row);
        row.frames = count;
        for (std::size_t c = 0; c < 3; ++c) {
            row.re[c] = scratch.taps.row(static_cast<int>(c)) + begin;
            row.im[c] = scratch.taps.row(static_cast<int>(c) + 3) + begin;
        }
        for (std::size_t n = 0; n < count; ++n) {
            const Tap& tap = images.taps.taps[n];
            row.bgr[n] = images.frames[n]->pixels.row(y + tap.dy) +
                         static_cast<std::ptrdiff_t>(3) * (begin + tap.dx);
            row.turn[n] = {tap.re, tap.im};
        }
        rgb_row(row);
    } else {
        DecodeRow row;
        fill(row);
        row.taps = images.taps.count;
        for (std::size_t n = 0; n < count; ++n) {
            const Tap& tap = images.taps.taps[n];
            row.source[n] = grey_row(*images.frames[n], y + tap.dy, n, scratch) + begin + tap.dx;
            row.re[n] = tap.re;
            row.im[n] = tap.im;
        }
        decode_row(row);
    }
    plan.sines[sine].gamma.apply(size.width, out.phase);
}

void DepthDecoder::Impl::decode_gray_row(int y, float* coordinate_px, float* modulation,
                                         Scratch& scratch) noexcept {
    const GrayPlan& gray = *plan.gray;
    GrayRow row;
    row.count = size.width;
    row.bits = gray.bits;
    std::size_t buffer = 0;
    const auto source = [&](int pattern) -> const std::uint8_t* {
        return pattern < 0 ? nullptr : grey_row(*window.clean(pattern, y), y, buffer++, scratch);
    };
    for (std::size_t bit = 0; bit < static_cast<std::size_t>(gray.bits); ++bit) {
        row.image[bit] = source(gray.image[bit]);
        row.inverse[bit] = source(gray.inverse[bit]);
    }
    row.white = source(plan.white);
    row.black = source(plan.black);
    row.cell_px = gray.cell_px;
    row.offset_px = gray.offset_px;
    row.min_modulation = static_cast<float>(settings.min_modulation);
    row.edge_guard = static_cast<float>(settings.gray_edge_guard);
    row.centre_only = plan.sines.empty();
    row.coordinate_px = coordinate_px;
    row.modulation = modulation;
    gray_code_row(row);
    if (settings.keep_maps && plan.sines.empty()) {
        // Without flats every bit has its inverse: the two light each pixel once, as white does.
        const bool flats = row.white != nullptr && row.black != nullptr;
        const std::uint8_t* lit = flats ? row.white : row.image[0];
        const std::uint8_t* dark = flats ? row.black : row.inverse[0];
        float* mean = average.row(y);
        for (int i = 0; i < size.width; ++i) {
            mean[i] = 0.5F * static_cast<float>(lit[i] + dark[i]);
        }
    }
}

void DepthDecoder::Impl::decode_row_chain(const std::vector<Images>& chain, int y,
                                          const RowOut& out, Scratch& scratch) noexcept {
    const std::size_t sines = chain.size();
    if (!geometry) {
        if (sines > 0) {
            decode_sine_row(sines - 1, chain.back(), y, out, scratch);
        }
        return;
    }
    // Two buffers take turns as reference and result, so that the last result lands in `out`.
    float* result = sines % 2 == 1 ? out.coordinate : scratch.reference.row(0);
    float* spare = sines % 2 == 1 ? scratch.reference.row(0) : out.coordinate;
    const float* reference = spare;
    auto tolerance = static_cast<float>(settings.order_tolerance);
    if (settings.order == OrderSource::depth_image) {
        reference = order_px.row(y);
    } else if (plan.gray) {
        decode_gray_row(y, spare, out.modulation, scratch);
    } else {
        reference = order.row(y);
        tolerance = order.tolerance();
    }
    for (std::size_t n = 0; n < sines; ++n) {
        decode_sine_row(n, chain[n], y, out, scratch);
        UnwrapRow row;
        row.count = size.width;
        row.reference_px = reference;
        row.phase_rad = out.phase;
        row.period_px = plan.sines[n].period_px;
        row.tolerance = tolerance;
        row.coordinate_min_px = static_cast<float>(-0.5 - kBorderMarginPx);
        row.coordinate_max_px = static_cast<float>(plan.coded_length_px - 0.5 + kBorderMarginPx);
        row.coordinate_px = result;
        unwrap_row(row);
        reference = result;
        std::swap(result, spare);
        tolerance = static_cast<float>(settings.order_tolerance);
    }
}

void DepthDecoder::Impl::average_row(const Images& images, int y, Scratch& scratch) noexcept {
    float* mean = average.row(y);
    if (plan.sines.back().kind == PeriodKind::ramp) {
        const std::uint8_t* white = grey_row(*window.clean(plan.white, y), y, 0, scratch);
        const std::uint8_t* black = grey_row(*window.clean(plan.black, y), y, 1, scratch);
        for (int i = 0; i < size.width; ++i) {
            mean[i] = 0.5F * static_cast<float>(white[i] + black[i]);
        }
        return;
    }
    std::fill(mean, mean + size.width, 0.0F);
    const float weight = 1.0F / static_cast<float>(images.taps.count);
    for (std::size_t n = 0; n < static_cast<std::size_t>(images.taps.count); ++n) {
        const std::uint8_t* grey = grey_row(*images.frames[n], y, n, scratch);
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
            if (!sigma.empty()) {
                std::fill_n(sigma.row(y), size.width, 0.0F);
            }
            if (!coordinate.empty()) {
                std::fill_n(coordinate.row(y), size.width, kNone);
            }
        }
    }
}

void DepthDecoder::Impl::triangulate_row(int y, const RowOut& out, Scratch& scratch) noexcept {
    if (!geometry) {
        std::fill_n(depth.depth.row(y), size.width, std::uint16_t{0});
        std::fill_n(depth.quality.row(y), size.width, std::uint8_t{0});
        return;
    }
    DepthRow row;
    geometry->prepare_row(y, scratch.rays.row(0), row);
    row.count = size.width;
    row.coordinate_px = out.coordinate;
    if (geometry->projector_distorted()) {
        float* ideal = scratch.ideal.row(0);
        std::copy_n(out.coordinate, size.width, ideal);
        geometry->undistort_projector_row(y, size.width, ideal);
        row.coordinate_px = ideal;
    }
    row.modulation = out.modulation;
    row.depth = depth.depth.row(y);
    row.quality = depth.quality.row(y);
    depth_row(row);
    if (!sigma.empty()) {
        noise_gain_row(y, scratch.ideal.row(0));
        SigmaRow noise;
        noise.mean = average.row(y);
        noise.noise_gain = scratch.ideal.row(0);
        noise.period_px = static_cast<float>(plan.sines.back().period_px);
        noise.read_noise_levels = static_cast<float>(settings.read_noise_levels);
        noise.electrons_per_level = static_cast<float>(settings.electrons_per_level);
        noise.sigma_mm = sigma.row(y);
        sigma_row(row, noise);
    }
}

// Of the phase that gives the coordinate.
void DepthDecoder::Impl::noise_gain_row(int y, float* gain) const noexcept {
    if (!palette) {
        std::fill_n(gain, size.width, static_cast<float>(still.back().taps.noise_gain()));
        return;
    }
    constexpr int kFine = ColourPalette::kFineStepPx;
    const std::uint8_t* surfaces = palette->surfaces().row(y / kFine);
    const auto frames = static_cast<float>(std::max(still.back().taps.count, 1));
    for (int x = 0; x < size.width; ++x) {
        float power = 0.0F;
        for (const float tap : palette->taps(ColourPalette::surface_of(surfaces[x / kFine]))) {
            power += tap * tap;
        }
        gain[x] = std::sqrt(0.5F * power / frames);
    }
}

void DepthDecoder::Impl::decode_rows(int begin, int end) noexcept {
    bool complete = true;
    for (const int pattern : plan.needed) {
        complete = complete && window.clean(pattern, begin) != nullptr;
    }
    for (std::size_t n = 0; n < still.size(); ++n) {
        complete = complete && choose_images(n, begin, still[n]);
    }
    if (!complete) {
        mask_rows(begin, end);
        return;
    }
    if (plan.gray || plan.white >= 0) {
        for (const int pattern : plan.needed) {
            oldest_image = std::min(oldest_image, window.clean(pattern, begin)->stamp);
        }
    }
    for (const Images& images : still) {
        for (std::size_t k = 0; k < static_cast<std::size_t>(images.taps.count); ++k) {
            oldest_image = std::min(oldest_image, images.frames[k]->stamp);
        }
    }
    follow_images();
    team->run(begin, end, kBandRows, [this](int member, int first, int last) {
        for (int y = first; y < last; ++y) {
            decode_one_row(y, scratches[static_cast<std::size_t>(member)]);
        }
    });
}

void DepthDecoder::Impl::decode_one_row(int y, Scratch& scratch) noexcept {
    const bool keep = settings.keep_maps;
    const RowOut out{
        phase_map.phase_rad.empty() ? scratch.phase.row(0) : phase_map.phase_rad.row(y),
        keep ? phase_map.modulation.row(y) : scratch.modulation.row(0),
        coordinate.empty() ? scratch.coordinate.row(0) : coordinate.row(y)};
    if (palette) {
        colours_of_row(y, scratch);
    }
    decode_row_chain(still, y, out, scratch);
    if (palette) {
        decode_moved_colours(y, out, scratch);
    } else if (motion) {
        decode_moving_row(y, out, scratch);
    }
    if (keep && !still.empty()) {
        average_row(still.back(), y, scratch);
    }
    triangulate_row(y, out, scratch);
}

}  // namespace xtrack
