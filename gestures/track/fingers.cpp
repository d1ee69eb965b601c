// SPDX-License-Identifier: Apache-2.0
#include "gestures/track/fingers.hpp"

#include <algorithm>
#include <cmath>

namespace xtrack::track {

namespace {

/// A tip is at least this far from the palm's centre, in palm radii: nearer is a knuckle.
constexpr float kTipRadii = 1.3F;
/// The finger's width is read this far below its tip, mm.
constexpr float kWidthBelowMm = 14.0F;
/// A wider end is no fingertip, mm: two fingers that touch are 34.
constexpr float kTipWidthMaxMm = 31.0F;
constexpr float kTipWidthMinMm = 4.0F;
/// A tip of this prominence is a finger's, whatever depth its rim has, mm.
constexpr float kClearTipMm = 30.0F;
/// Skin within this of an outline pixel gives the depth there, grid px: the pixel itself may mix
/// finger and background.
constexpr int kSkinReach = 2;
/// Beyond this many palm radii the hand is fingers.
constexpr float kFingersBeyondRadii = 1.35F;
/// A hole between thumb and index: its area, mm2, and how far from the palm, in palm radii.
constexpr float kRingAreaMinMm2 = 70.0F;
constexpr float kRingAreaMaxMm2 = 3500.0F;
constexpr float kRingNearRadii = 0.9F;
constexpr float kRingFarRadii = 2.3F;
/// The outline this near to the wrist's cut is the cut, grid px.
constexpr float kCutPixels = 2.5F;
/// What points closer to the arm is none of the fingers: cosine of the angle between them.
constexpr float kArmCone = 0.6F;
/// No finger points this far toward the arm: cosine of the angle between them.
constexpr float kArmSide = 0.2F;
constexpr int kSmoothRounds = 2;
/// The pad of a finger is this far from its distal end.
constexpr float kPadBelowMm = 11.0F;
/// Two fingers that have met, or lie together, are no wider than this, mm.
constexpr float kWideTipMaxMm = 60.0F;
constexpr float kTwoPi = 6.2831853F;

/// Distance across the line of sight of two points of one finger, mm.
float seen_width(const Vec3f& a, const Vec3f& b) {
    const Vec2f rays = a.head<2>() / a.z() - b.head<2>() / b.z();
    return std::min(a.z(), b.z()) * rays.norm();
}

std::size_t reach_bin(const Vec3f& v) {
    const float turn = std::atan2(v.y(), v.x()) / kTwoPi + 0.5F;
    const auto bin = static_cast<std::size_t>(turn * static_cast<float>(kReachBins));
    return std::min(bin, kReachBins - 1);
}

}  // namespace

void FingerReader::create(const segment::Grid& grid) {
    contour_.create(grid);
    const std::size_t n = grid.size();
    points_.reserve(n);
    distance_.reserve(n);
    scratch_.reserve(n);
    gaps_.create(grid);
    holes_.reserve(n);
}

void FingerReader::read(const segment::Grid& grid, std::span<const std::uint8_t> labels,
                        const HandRegion& region, const Vec3f& palm_normal, int side_hint,
                        float tip_prominence_mm, FingerReading& out) {
    out = {};
    contour_.trace(grid, labels, region);
    if (contour_.points().size() < 16) {
        return;
    }
    measure_profile(grid, labels, region);
    find_tips(region, tip_prominence_mm, out);
    measure_reach(region, out);

    const float beyond = kFingersBeyondRadii * region.palm_radius_mm;
    // Every other row says enough.
    constexpr int kRowStep = 2;
    const float row_pitch = static_cast<float>(kRowStep) * grid.inverse_focal * grid.inverse_focal;
    float seen = 0.0F;  // squared depths
    for (int y = region.y_begin; y < region.y_end; y += kRowStep) {
        for (int x = region.x_begin; x < region.x_end; ++x) {
            const int i = grid.index(x, y);
            if (labels[static_cast<std::size_t>(i)] != region.label) {
                continue;
            }
            const Vec3f d = grid.point(i) - region.palm_mm;
            const float squared = d.squaredNorm();
            const float along = d.dot(region.arm_direction);
            if (squared > beyond * beyond &&
                (along < 0.0F || along * along < kArmCone * kArmCone * squared)) {
                const float z = grid.z[static_cast<std::size_t>(i)];
                seen += z * z;
            }
        }
    }
    out.finger_area_mm2 = seen * row_pitch;
    name_fingers(region, side_hint, out);
    if (out.count > 0) {
        float sum = 0.0F;
        float n = 0.0F;
        for (std::size_t k = 0; k < out.count; ++k) {
            if (static_cast<int>(k) != out.thumb) {
                sum += (out.tips[k].position_mm - region.palm_mm).dot(palm_normal);
                n += 1.0F;
            }
        }
        out.curl_mm = n > 0.0F ? sum / n : 0.0F;
    }
    find_ring(grid, labels, region, out);
}

void FingerReader::measure_profile(const segment::Grid& grid, std::span<const std::uint8_t> labels,
                                   const HandRegion& region) {
    const auto outline = contour_.points();
    points_.clear();
    distance_.clear();
    for (const int i : outline) {
        float sum = 0.0F;
        float n = 0.0F;
        for (int dy = -kSkinReach; dy <= kSkinReach; ++dy) {
            for (int dx = -kSkinReach; dx <= kSkinReach; ++dx) {
                const auto k = static_cast<std::size_t>(i + dy * grid.width + dx);
                if (labels[k] == region.label) {
                    sum += grid.z[k];
                    n += 1.0F;
                }
            }
        }
        const float z = sum / n;
        const Vec2f ray = grid.ray[static_cast<std::size_t>(i)];
        const Vec3f p(ray.x() * z, ray.y() * z, z);
        const Vec3f d = p - region.palm_mm;
        const bool cut =
            (p - region.wrist_mm).dot(region.arm_direction) > -kCutPixels * grid.pitch_mm(z) ||
            d.dot(region.arm_direction) > kArmSide * d.norm();
        const bool border = region.touches_border && grid.at_border(i);
        points_.push_back(p);
        distance_.push_back(cut || border ? 0.0F : d.norm());
    }
    const std::size_t n = distance_.size();
    for (int round = 0; round < kSmoothRounds; ++round) {
        scratch_.assign(distance_.begin(), distance_.end());
        for (std::size_t k = 0; k < n; ++k) {
            const float before = scratch_[(k + n - 1) % n];
            const float after = scratch_[(k + 1) % n];
            if (scratch_[k] > 0.0F && before > 0.0F && after > 0.0F) {
                distance_[k] = 0.25F * before + 0.5F * scratch_[k] + 0.25F * after;
            }
        }
    }
}

void FingerReader::find_tips(const HandRegion& region, float tip_prominence_mm,
                             FingerReading& out) const {
    const auto n = static_cast<int>(distance_.size());
    // Never farther than once round from either end.
    const auto wrapped = [n](int k) {
        return static_cast<std::size_t>(k < 0 ? k + n : (k >= n ? k - n : k));
    };
    const auto at = [&](int k) { return distance_[wrapped(k)]; };
    const auto point = [&](int k) { return points_[wrapped(k)]; };
    const float least = kTipRadii * region.palm_radius_mm;
    for (int k = 0; k < n; ++k) {
        const float d = at(k);
        if (d < least || d < at(k - 1) || d <= at(k + 1)) {
            continue;
        }
        // Walk down to both valleys; the walk ends where something stands higher.
        float low_before = d;
        for (int m = 1; m < n && at(k - m) <= d; ++m) {
            low_before = std::min(low_before, at(k - m));
        }
        float low_after = d;
        for (int m = 1; m < n && at(k + m) < d; ++m) {
            low_after = std::min(low_after, at(k + m));
        }
        const float prominence = d - std::max(low_before, low_after);
        if (prominence < tip_prominence_mm) {
            continue;
        }
        const float level = d - std::min(kWidthBelowMm, 0.9F * prominence);
        int before = 1;
        while (before < n && at(k - before) > level) {
            ++before;
        }
        int after = 1;
        while (after < n && at(k + after) > level) {
            ++after;
        }
        // At its rim the skin's depth may be mixed with that of what lies behind. A finger that
        // stands out is not wider for it; what hardly does, or ends within a pixel, may be nothing
        // but such depth.
        const bool clear = prominence > kClearTipMm && std::min(before, after) > 1;
        const float width = clear ? seen_width(point(k - before), point(k + after))
                                  : (point(k - before) - point(k + after)).norm();
        if (width > kTipWidthMaxMm && width < kWideTipMaxMm && out.wide_count < kTipsMax) {
            out.wide_mm[out.wide_count++] = point(k);
        }
        if (width > kTipWidthMaxMm || width < kTipWidthMinMm || out.count >= kTipsMax) {
            continue;
        }
        Tip& tip = out.tips[out.count++];
        tip.contour_index = k;
        tip.distance_mm = d;
        tip.prominence_mm = prominence;
        tip.width_mm = width;
        // The outline runs through the centres of the outermost pixels; the rim is half one on.
        const Vec3f outward = (point(k) - region.palm_mm).normalized();
        const float half = 0.5F * region.palm_radius_mm / std::max(1.0F, region.palm_radius_px);
        tip.position_mm = point(k) + half * outward;
        const auto pad = [&](int step) {
            int m = step;
            while (std::abs(m) < n && (point(k + m) - point(k)).norm() < kPadBelowMm) {
                m += step;
            }
            return point(k + m);
        };
        tip.pad_before_mm = pad(-1);
        tip.pad_after_mm = pad(1);
    }
}

void FingerReader::measure_reach(const HandRegion& region, FingerReading& out) const {
    for (std::size_t k = 0; k < points_.size(); ++k) {
        float& reach = out.reach_mm[reach_bin(points_[k] - region.palm_mm)];
        reach = std::max(reach, distance_[k]);
    }
}

float FingerReading::reach_toward(const Vec3f& from_palm) const {
    const std::size_t bin = reach_bin(from_palm);
    return std::max(reach_mm[bin], std::max(reach_mm[(bin + 1) % kReachBins],
                                            reach_mm[(bin + kReachBins - 1) % kReachBins]));
}

void FingerReader::find_ring(const segment::Grid& grid, std::span<const std::uint8_t> labels,
                             const HandRegion& region, FingerReading& out) {
    // What is not hand and cannot be reached from the corner of a box round it is a hole.
    const segment::Box box{region.x_begin - 1, region.y_begin - 1, region.x_end + 1,
                           region.y_end + 1};
    const auto gap = [&](int i) { return labels[static_cast<std::size_t>(i)] != region.label; };
    gaps_.find(
        grid, box,
        [&](int i, int end) {
            while (i < end && !gap(i)) {
                ++i;
            }
            return i;
        },
        [&](int a, int b) { return (a == b + 1 || a == b + grid.width) && gap(a) && gap(b); });
    constexpr int kOutside = 0;
    if (gaps_.count() == 1) {
        return;
    }
    holes_.assign(static_cast<std::size_t>(gaps_.count()), {});
    for (const segment::Components::Run& run : gaps_.runs()) {
        if (run.component == kOutside) {
            continue;
        }
        Hole& hole = holes_[static_cast<std::size_t>(run.component)];
        const auto n = static_cast<float>(run.end - run.begin);
        hole.pixels += n;
        hole.sum_px += n * Vec2f(static_cast<float>(grid.x_of(run.begin)) + 0.5F * (n - 1.0F),
                                 static_cast<float>(grid.y_of(run.begin)));
    }
    const float pitch = grid.pitch_mm(region.palm_mm.z());
    float best_area = 0.0F;
    Vec2f best = Vec2f::Zero();
    for (std::size_t k = 1; k < holes_.size(); ++k) {
        const float area = holes_[k].pixels * pitch * pitch;
        if (area < kRingAreaMinMm2 || area > kRingAreaMaxMm2 || area <= best_area) {
            continue;
        }
        const Vec2f centre = holes_[k].sum_px / holes_[k].pixels;
        const float radii = (centre - region.palm_px).norm() / region.palm_radius_px;
        if (radii > kRingNearRadii && radii < kRingFarRadii) {
            best_area = area;
            best = centre;
        }
    }
    if (best_area <= 0.0F) {
        return;
    }
    // The ring closes at the skin beyond the hole, seen from the palm.
    const Vec2f u = (best - region.palm_px).normalized();
    float far = 0.0F;
    for (std::size_t k = 0; k < points_.size(); ++k) {
        const int i = contour_.points()[k];
        const Vec2f p(static_cast<float>(grid.x_of(i)), static_cast<float>(grid.y_of(i)));
        const Vec2f d = p - region.palm_px;
        const float along = d.dot(u);
        if (along > far && (d - along * u).norm() < 0.35F * along) {
            far = along;
            out.ring_tip_mm = points_[k];
        }
    }
    out.ring = far > 0.0F;
}

}  // namespace xtrack::track
