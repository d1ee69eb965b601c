// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <span>

#include "core/pipeline/depth_decoder_impl.hpp"

namespace xtrack {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
constexpr float kTurn_rad = 2.0F * std::numbers::pi_v<float>;
// Differences of one pixel below this are camera noise and compression, grey levels.
constexpr float kPixelNoise = 8.0F;

}  // namespace

double DepthDecoder::Impl::find_moving_depth_mm() noexcept {
    // The depth of what moves, from the depth image before this one.
    moving_depths.clear();
    constexpr int kCell = MotionEstimator::kCellPx;
    for (int cy = 0; cy < motion->cells_y(); ++cy) {
        for (int cx = 0; cx < motion->cells_x(); ++cx) {
            // The only cell of an image narrower than a cell may end before its centre.
            const int x = std::min(cx * kCell + kCell / 2, size.width - 1);
            const int y = std::min(cy * kCell + kCell / 2, size.height - 1);
            const std::uint16_t z =
                motion->follows(cx, cy) ? depth.depth.at(x, y) : std::uint16_t{0};
            if (z > 0) {
                moving_depths.push_back(z);
            }
        }
    }
    if (moving_depths.empty()) {
        return 0.0;
    }
    const auto middle =
        moving_depths.begin() + static_cast<std::ptrdiff_t>(moving_depths.size() / 2);
    std::nth_element(moving_depths.begin(), middle, moving_depths.end());
    const double z_mm = *middle * depth.depth_unit_mm;
    return z_mm;
}

// How far the projector coordinate of what moves was from where it is now, px.
double DepthDecoder::Impl::drift_px_since(const Frame& frame) const noexcept {
    if (!geometry || !(moving_depth_mm > 0.0)) {
        return 0.0;
    }
    const Vec2f here = motion->centre_px();
    const Vec2f there = here - motion->path_since(frame);
    const auto coordinate_at = [&](const Vec2f& at) {
        return geometry->coordinate_of_depth(static_cast<double>(at.x()),
                                             static_cast<double>(at.y()), moving_depth_mm);
    };
    return coordinate_at(there) - coordinate_at(here);
}

// Before the newest images are looked at: from where what moves was a frame ago.
void DepthDecoder::Impl::set_phase_gradient() noexcept {
    if (!geometry || plan.sines.size() != 1 || !(moving_depth_mm > 0.0)) {
        return;
    }
    const Vec2f here = motion->centre_px();
    const auto coordinate_at = [&](double dx, double dy) {
        return geometry->coordinate_of_depth(static_cast<double>(here.x()) + dx,
                                             static_cast<double>(here.y()) + dy, moving_depth_mm);
    };
    // A secant as long as a finger is wide: the lens bends little within it.
    constexpr double kReach_px = 8.0;
    const double rad_per_px = 2.0 * std::numbers::pi / plan.sines.front().period_px;
    const double scale = rad_per_px / (2.0 * kReach_px);
    motion->set_gradient(Vec2f(static_cast<float>(scale * (coordinate_at(kReach_px, 0.0) -
                                                           coordinate_at(-kReach_px, 0.0))),
                               static_cast<float>(scale * (coordinate_at(0.0, kReach_px) -
                                                           coordinate_at(0.0, -kReach_px)))));
}

void DepthDecoder::Impl::follow_images() noexcept {
    can_follow = moves();
    drift_rad_per_cycle = 0.0;
    if (!can_follow) {
        return;
    }
    for (std::size_t sine = 0; sine < still.size(); ++sine) {
        const SinePlan& period = plan.sines[sine];
        Images& moved = following[sine];
        moved = still[sine];
        const auto count = static_cast<std::size_t>(moved.taps.count);
        std::array<double, kMaxTaps> phases{};
        std::array<double, kMaxTaps> drifts{};
        for (std::size_t n = 0; n < count; ++n) {
            const Frame& frame = *moved.frames[n];
            const double drift_rad =
                motion->knows_drift()
                    ? static_cast<double>(motion->drift_rad_since(frame))
                    : 2.0 * std::numbers::pi / period.period_px * drift_px_since(frame);
            drifts[n] = drift_rad;
            phases[n] = plan.pattern_phase_rad[static_cast<std::size_t>(frame.pattern)] + drift_rad;
            const double back_s = to_seconds(*last_stamp - frame.stamp);
            if (back_s > 0.0) {
                drift_rad_per_cycle =
                    std::max(drift_rad_per_cycle,
                             std::fabs(drift_rad) / back_s * motion->seconds_per_cycle());
            }
        }
        if (period.kind == PeriodKind::colour) {
            for (std::size_t n = 0; n < count; ++n) {
                const auto turn =
                    std::complex<double>(moved.taps.taps[n].re, moved.taps.taps[n].im) *
                    std::polar(1.0, -drifts[n]);
                moved.taps.taps[n].re = static_cast<float>(turn.real());
                moved.taps.taps[n].im = static_cast<float>(turn.imag());
            }
        } else {
            can_follow = can_follow && fit_taps(std::span(phases).first(count), moved.taps);
        }
        for (std::size_t n = 0; n < count; ++n) {
            const Shift shift = motion->to(*moved.frames[n]);
            moved.taps.taps[n].dx = shift.dx;
            moved.taps.taps[n].dy = shift.dy;
        }
    }
}

void DepthDecoder::Impl::mask_disagreeing(int y, int begin, int end, bool follow,
                                          const RowOut& out) noexcept {
    // A drift of the phase changes the images of one pattern as well, and is no disagreement.
    const double drift =
        motion->knows_drift() ? 0.0 : std::min(drift_rad_per_cycle, std::numbers::pi);
    const auto allowed = static_cast<float>(settings.motion_tolerance +
                                            (follow ? 2.0 * std::sin(0.5 * drift) : 0.0));
    for (int x = begin; x < end; ++x) {
        const float worst = motion->mismatch(x, y, follow);
        if (worst > std::max(kPixelNoise, allowed * out.modulation[x])) {
            out.phase[x] = kNone;
            out.modulation[x] = 0.0F;
            out.coordinate[x] = kNone;
        }
    }
}

// What is left of the drift, from the middle of the images to the newest of them.
void DepthDecoder::Impl::add_cell_drift(int cx, int cy, int begin, int end, bool follow,
                                        const RowOut& out) noexcept {
    const Images& images = (follow ? following : still).back();
    const auto count = static_cast<std::size_t>(images.taps.count);
    double age_s = 0.0;
    for (std::size_t n = 0; n < count; ++n) {
        age_s += to_seconds(*last_stamp - images.frames[n]->stamp) / static_cast<double>(count);
    }
    const auto drift_rad =
        static_cast<float>(motion->cell_drift_rad(cx, cy) * age_s / motion->seconds_per_cycle());
    const auto px_per_rad =
        static_cast<float>(plan.sines.back().period_px / (2.0 * std::numbers::pi));
    for (int x = begin; x < end; ++x) {
        // NaN stays what it is; a phase is within half a turn wherever it is handed on.
        out.phase[x] = std::remainder(out.phase[x] - drift_rad, kTurn_rad);
        if (geometry) {
            out.coordinate[x] -= drift_rad * px_per_rad;
        }
    }
}

void DepthDecoder::Impl::decode_moving_row(int y, const RowOut& out, Scratch& scratch) noexcept {
    constexpr int kCell = MotionEstimator::kCellPx;
    const int cy = std::min(y / kCell, motion->cells_y() - 1);
    if (!motion->row_disturbed(cy)) {
        return;
    }
    const RowOut moved{scratch.moving_phase.row(0), scratch.moving_modulation.row(0),
                       scratch.moving_coordinate.row(0)};
    bool decoded = false;
    for (int cx = 0; cx < motion->cells_x(); ++cx) {
        if (!motion->disturbed(cx, cy)) {
            continue;
        }
        const int begin = cx * kCell;
        const int end = cx + 1 == motion->cells_x() ? size.width : begin + kCell;
        const bool follow = can_follow && motion->follows(cx, cy);
        if (follow) {
            if (!decoded) {
                decode_row_chain(following, y, moved, scratch);
                decoded = true;
            }
            std::copy(moved.phase + begin, moved.phase + end, out.phase + begin);
            std::copy(moved.modulation + begin, moved.modulation + end, out.modulation + begin);
            std::copy(moved.coordinate + begin, moved.coordinate + end, out.coordinate + begin);
        }
        mask_disagreeing(y, begin, end, follow, out);
        if (motion->knows_drift()) {
            add_cell_drift(cx, cy, begin, end, follow, out);
        }
    }
}

}  // namespace xtrack
