// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
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
// What stands out is in front. What was seen in so many images decides, so that one image of
// little else than noise does not turn depth over; turns times places.
// What a pixel of an outline may be off its neighbour.
constexpr float kOutline_rad = 0.8F;
constexpr int kOutline_px = 4;
// A band of what moves that looks as what stands still: how long it is at most, how far its phase
// may be off a straight line, and rise, and its light differ.
constexpr int kBand_px = 24;
constexpr float kBand_rad = 0.6F;
constexpr float kBandRise_rad = 1.5F;
constexpr float kBandLight = 1.4F;
constexpr double kMostStandingOut = 20000.0;
// So many lines with a shadow, less those that contradict, are sure; and no more are remembered.
constexpr int kSureShadows = 24;
constexpr int kMostShadows = 480;

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
    const PhaseMap& seen = one_image->phase();
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
    if (one_image) {
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
    orders.forget();
    standing_out = 0.0;
    shadows = 0;
    decode();
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

// 1: more phase is nearer; -1: less is; 0: nothing has said so.
double PaperDecoder::Impl::front_of_phase() const noexcept {
    return geometry ? (orders.far_is_low() ? 1.0 : -1.0) : front_is_sure() ? front : 0.0;
}

bool PaperDecoder::Impl::front_is_sure() const noexcept {
    return std::abs(shadows) >= kSureShadows;
}

// Shadows say which way is nearer; until one is seen, what stands out most is taken to be.
bool PaperDecoder::Impl::find_front() noexcept {
    standing_out =
        std::clamp(standing_out + orders.standing_out(), -kMostStandingOut, kMostStandingOut);
    shadows = std::clamp(shadows + orders.shadows(), -kMostShadows, kMostShadows);
    const double before = front;
    front = front_is_sure() ? (shadows < 0 ? -1.0 : 1.0) : standing_out < 0.0 ? -1.0 : 1.0;
    return front_is_sure() && front != before && scene;
}

// Of what stands still, whose orders were chosen for depth the other way round.
void PaperDecoder::Impl::order_scene_anew() noexcept {
    scene->show_known();
    const ImageView<const float> known = scene->moving_rad().view();
    const auto found = unwrapper.solve(known, scene->known_modulation().view());
    unwrapped_before.fill(kNone);
    component_before.fill(0);
    orders.forget();
    const ImageView<const float> nothing = std::as_const(unwrapped_before).view();
    ComponentOrders::Input input{unwrapper, found,
                                 known,     std::as_const(background).view(),
                                 nothing,   std::as_const(component_before).view(),
                                 front};
    input.known_rad = nothing;
    orders.choose(input);
    for (int y = 0; y < size.height; ++y) {
        unwrapper.write_row(y, known.row(y), orders.orders(), unwrapped.row(y), component.row(y));
    }
    scene->replace_known(std::as_const(unwrapped).view());
    component.fill(0);
    unwrapped.fill(kNone);
    orders.forget();
}

// What stands still, beside the components.
void PaperDecoder::Impl::write_still_row(int y) noexcept {
    const float* still = scene->still_rad().row(y);
    float* row_unwrapped = unwrapped.row(y);
    std::uint16_t* ids = component.row(y);
    for (int x = 0; x < size.width; ++x) {
        const bool stands = still[x] == still[x];
        row_unwrapped[x] = stands ? still[x] : row_unwrapped[x];
        ids[x] = stands ? ComponentOrders::kStill : ids[x];
    }
}

void PaperDecoder::Impl::learn_still() noexcept {
    if (scene) {
        scene->learn(std::as_const(unwrapped).view(), std::as_const(component).view(),
                     std::as_const(phase_map.modulation).view(), front_of_phase(), depth.stamp);
    }
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

// An outline that was cut out is of what moves, where its phase goes on from there. It stays in no
// component: nothing is learnt from it.
void PaperDecoder::Impl::fill_outline(int x, int y) noexcept {
    const float phase = (geometry ? phase_map.phase_rad : difference).at(x, y);
    constexpr std::array<std::array<int, 2>, 4> kWays{{{-1, 0}, {1, 0}, {0, -1}, {0, 1}}};
    float best = kOutline_rad;
    for (const auto& way : kWays) {
        for (int n = 1; n <= kOutline_px; ++n) {
            const int u = x + n * way[0];
            const int v = y + n * way[1];
            if (u < 0 || v < 0 || u >= size.width || v >= size.height) {
                break;
            }
            const std::uint16_t id = component.at(u, v);
            if (id == 0) {
                continue;
            }
            const float beside = unwrapped.at(u, v);
            const float off = std::remainder(phase - beside, static_cast<float>(kTurn_rad));
            if (id != ComponentOrders::kStill && std::fabs(off) < best) {
                best = std::fabs(off);
                unwrapped.at(x, y) = beside + off;
            }
            break;
        }
    }
}

void PaperDecoder::Impl::fill_outlines() noexcept {
    for (int y = 0; y < size.height; ++y) {
        const float* phase = (geometry ? phase_map.phase_rad : difference).row(y);
        const std::uint16_t* ids = component.row(y);
        for (int x = 0; x < size.width; ++x) {
            if (ids[x] == 0 && !std::isnan(phase[x])) {
                fill_outline(x, y);
            }
        }
    }
}

// Pixels of what moves that happen to look as what stands still behind them did: a run of them that
// goes on, in phase and in light, from what moves before it to what moves after it.
void PaperDecoder::Impl::close_band(int x, int y, int dx, int dy, int length) noexcept {
    const int end_x = x + (length + 1) * dx;
    const int end_y = y + (length + 1) * dy;
    const float begin_rad = unwrapped.at(x, y);
    const float slope = (unwrapped.at(end_x, end_y) - begin_rad) / static_cast<float>(length + 1);
    const float light =
        0.5F * (phase_map.modulation.at(x, y) + phase_map.modulation.at(end_x, end_y));
    if (std::fabs(slope) * static_cast<float>(length + 1) > kBandRise_rad) {
        return;
    }
    const Image<float>& phase = geometry ? phase_map.phase_rad : difference;
    const auto off = [&](int n) {
        return std::remainder(
            phase.at(x + n * dx, y + n * dy) - begin_rad - slope * static_cast<float>(n),
            static_cast<float>(kTurn_rad));
    };
    for (int n = 1; n <= length; ++n) {
        const float here = phase_map.modulation.at(x + n * dx, y + n * dy);
        if (!(std::fabs(off(n)) < kBand_rad) || here > kBandLight * light ||
            light > kBandLight * here) {
            return;
        }
    }
    for (int n = 1; n <= length; ++n) {
        const int u = x + n * dx;
        const int v = y + n * dy;
        unwrapped.at(u, v) = begin_rad + slope * static_cast<float>(n) + off(n);
        component.at(u, v) = component.at(x, y);
        scene->moves(u, v);
    }
}

void PaperDecoder::Impl::close_bands() noexcept {
    const auto moves = [&](int x, int y) {
        const std::uint16_t id = component.at(x, y);
        return id != 0 && id != ComponentOrders::kStill;
    };
    const auto close_line = [&](int x, int y, int dx, int dy, int length) {
        int last = -1;  // that moves
        for (int n = 0; n < length; ++n, x += dx, y += dy) {
            if (component.at(x, y) == ComponentOrders::kStill) {
                continue;
            }
            const int gap = n - last - 1;
            if (!moves(x, y)) {
                last = -1;
            } else {
                if (last >= 0 && gap > 0 && gap <= kBand_px) {
                    close_band(x - (gap + 1) * dx, y - (gap + 1) * dy, dx, dy, gap);
                }
                last = n;
            }
        }
    };
    for (int y = 0; y < size.height; ++y) {
        close_line(0, y, 1, 0, size.width);
    }
    for (int x = 0; x < size.width; ++x) {
        close_line(x, 0, 0, 1, size.height);
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
    if (settings.points) {
        PointsRow of;
        rays.prepare_row(y, of);
        of.count = size.width;
        of.depth = row.depth;
        of.unit_mm = static_cast<float>(kDepthUnitMm);
        of.xyz_mm = points.row(y);
        points_row(of);
    }
}

void PaperDecoder::Impl::write_results() noexcept {
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
                                 front_is_sure() || standing_out != 0.0 ? front : 0.0};
    if (scene) {
        input.still_rad = scene->still_rad().view();
        input.known_rad = scene->known_rad().view();
        input.modulation = std::as_const(phase_map.modulation).view();
        input.all_rad = all;
        input.still_pixels = scene->still_pixels();
    }
    orders.choose(input);
    if (!geometry && find_front()) {
        order_scene_anew();
        write_results();
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
}

void PaperDecoder::Impl::decode() noexcept {
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
    write_results();
}

}  // namespace xtrack
