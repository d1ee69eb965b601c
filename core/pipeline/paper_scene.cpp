// SPDX-License-Identifier: Apache-2.0
// Of PaperDecoder: what moves and what stands still, and which way is nearer.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <utility>

#include "core/pipeline/paper_decoder_impl.hpp"

namespace xtrack {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
constexpr double kTurn_rad = 2.0 * std::numbers::pi;
// What stands out is in front. What was seen in so many images decides, so that one image of
// little else than noise does not turn depth over; turns times places.
constexpr double kMostStandingOut = 20000.0;
// So many lines with a shadow, less those that contradict, are sure; and no more are remembered.
constexpr int kSureShadows = 24;
constexpr int kMostShadows = 480;
// What a pixel of an outline may be off its neighbour.
constexpr float kOutline_rad = 0.8F;
constexpr int kOutline_px = 4;
// A band of what moves that looks as what stands still: how long it is at most, how far its phase
// may be off a straight line, and rise, and its light differ.
constexpr int kBand_px = 24;
constexpr float kBand_rad = 0.6F;
constexpr float kBandRise_rad = 1.5F;
constexpr float kBandLight = 1.4F;

}  // namespace

static_assert(PaperDecoder::kStill == ComponentOrders::kStill);

void PaperDecoder::Impl::forget_scene() noexcept {
    orders.forget();
    if (scene) {
        scene->forget();
    }
    standing_out = 0.0;
    shadows = 0;
    front_is_sure = false;
}

// Shadows say which way is nearer; until one is seen, what stands out most is taken to be.
bool PaperDecoder::Impl::find_front() noexcept {
    standing_out =
        std::clamp(standing_out + orders.standing_out(), -kMostStandingOut, kMostStandingOut);
    shadows = std::clamp(shadows + orders.shadows(), -kMostShadows, kMostShadows);
    const double before = front;
    const bool was_sure = front_is_sure;
    if (std::abs(shadows) >= kSureShadows) {
        front_is_sure = true;
        front = shadows < 0 ? -1.0 : 1.0;
    } else if (!front_is_sure) {
        front = standing_out < 0.0 ? -1.0 : 1.0;
    }
    return front_is_sure && !(was_sure && front == before) && scene;
}

// Of what stands still, whose orders were chosen before anything said which way is nearer.
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

// 1: more phase is nearer; -1: less is; 0: nothing has said so.
double PaperDecoder::Impl::front_of_phase() const noexcept {
    return geometry ? (orders.far_is_low() ? 1.0 : -1.0) : front_is_sure ? front : 0.0;
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
        scene->set_moving(u, v);
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

}  // namespace xtrack
