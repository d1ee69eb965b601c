// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "gestures/track/fingers.hpp"

namespace xtrack::track {

namespace {

constexpr float kDegree = 3.14159265F / 180.0F;
/// Between neighbouring fingers of a spread hand there are 15 to 25 degrees, seen from the palm's
/// centre; between thumb and index 35 and more.
constexpr float kThumbGapMinRad = 28.0F * kDegree;
constexpr float kThumbGapSureRad = 50.0F * kDegree;
/// A thumb is shorter than the fingers, in palm radii from the palm's centre.
constexpr float kThumbReachRadii = 2.4F;
/// A lone tip is a thumb only when it points this far from where the fingers are.
constexpr float kLoneThumbRad = 50.0F * kDegree;
/// A gap of more than this between fingers has a folded one in it.
constexpr float kFoldedGapRad = 32.0F * kDegree;

float wrapped(float a) {
    constexpr float kPi = 3.14159265F;
    while (a > kPi) {
        a -= 2.0F * kPi;
    }
    while (a < -kPi) {
        a += 2.0F * kPi;
    }
    return a;
}

/// 0..1: how much the tip at one end of the fan is a thumb beside its neighbour.
float thumbness(const HandRegion& region, const Tip& end, const Tip& neighbour) {
    const float gap = std::abs(wrapped(end.angle_rad - neighbour.angle_rad));
    const float by_gap =
        std::clamp((gap - kThumbGapMinRad) / (kThumbGapSureRad - kThumbGapMinRad), 0.0F, 1.0F);
    const bool shorter = end.distance_mm < neighbour.distance_mm &&
                         end.distance_mm < kThumbReachRadii * region.palm_radius_mm;
    return shorter ? by_gap : 0.3F * by_gap;
}

}  // namespace

void name_fingers(const HandRegion& region, int side_hint, FingerReading& reading) {
    const Vec3f away = -region.arm_direction;
    reading.finger_direction = away;
    if (reading.count == 0) {
        return;
    }
    // Angles are taken in the image plane, from the mean of tips and the direction off the arm.
    Vec2f axis = Vec2f(away.x(), away.y());
    for (std::size_t k = 0; k < reading.count; ++k) {
        const Vec3f d = reading.tips[k].position_mm - region.palm_mm;
        axis += Vec2f(d.x(), d.y()).normalized();
    }
    axis.normalize();
    const auto tips = reading.tips.begin();
    const auto end = tips + static_cast<std::ptrdiff_t>(reading.count);
    for (auto t = tips; t != end; ++t) {
        const Vec3f d = t->position_mm - region.palm_mm;
        t->angle_rad =
            std::atan2(axis.x() * d.y() - axis.y() * d.x(), axis.x() * d.x() + axis.y() * d.y());
    }
    std::sort(tips, end, [](const Tip& a, const Tip& b) { return a.angle_rad < b.angle_rad; });
    // More than five: the least prominent are noise.
    while (reading.count > kFingerCount) {
        std::size_t worst = 0;
        for (std::size_t k = 1; k < reading.count; ++k) {
            worst = reading.tips[k].prominence_mm < reading.tips[worst].prominence_mm ? k : worst;
        }
        for (std::size_t k = worst; k + 1 < reading.count; ++k) {
            reading.tips[k] = reading.tips[k + 1];
        }
        --reading.count;
    }

    const std::size_t n = reading.count;
    const std::size_t last = n - 1;
    float clockwise = 0.0F;
    float counter = 0.0F;
    if (n >= 2) {
        clockwise = thumbness(region, reading.tips[last], reading.tips[last - 1]);
        counter = thumbness(region, reading.tips[0], reading.tips[1]);
    } else {
        const Vec3f d = reading.tips[0].position_mm - region.palm_mm;
        const float off =
            std::atan2(away.x() * d.y() - away.y() * d.x(), away.x() * d.x() + away.y() * d.y());
        const bool sideways =
            std::abs(off) > kLoneThumbRad && std::hypot(away.x(), away.y()) > 0.5F &&
            reading.tips[0].distance_mm < kThumbReachRadii * region.palm_radius_mm;
        clockwise = sideways && off > 0.0F ? 0.5F : 0.0F;
        counter = sideways && off < 0.0F ? 0.5F : 0.0F;
    }
    // What was known before decides what this frame leaves open.
    constexpr float kHint = 0.25F;
    clockwise += side_hint > 0 && clockwise > 0.0F ? kHint : 0.0F;
    counter += side_hint < 0 && counter > 0.0F ? kHint : 0.0F;
    constexpr float kThumbMin = 0.2F;
    const float best = std::max(clockwise, counter);
    // Five tips have a thumb among them, however close it lies.
    if (best > kThumbMin || n == kFingerCount) {
        reading.thumb_side = clockwise >= counter ? 1 : -1;
        reading.thumb = reading.thumb_side > 0 ? static_cast<int>(last) : 0;
        reading.thumb_score = std::clamp(std::abs(clockwise - counter), 0.0F, 1.0F);
    }

    // From the thumb's side on: index, middle, ring, little; a wide gap skips one while enough
    // names are left for the tips that follow.
    const int side =
        reading.thumb_side != 0 ? reading.thumb_side : (side_hint != 0 ? side_hint : 1);
    std::size_t name = 1;
    std::size_t left = n - (reading.thumb >= 0 ? 1 : 0);
    float before = 0.0F;
    bool first = true;
    for (std::size_t k = 0; k < n; ++k) {
        const std::size_t i = side > 0 ? last - k : k;
        Tip& tip = reading.tips[i];
        if (static_cast<int>(i) == reading.thumb) {
            tip.finger = Finger::thumb;
            continue;
        }
        if (!first && std::abs(wrapped(tip.angle_rad - before)) > kFoldedGapRad &&
            name + left < kFingerCount) {
            ++name;
        }
        first = false;
        before = tip.angle_rad;
        tip.finger = static_cast<Finger>(std::min<std::size_t>(name, kFingerCount - 1));
        ++name;
        --left;
    }
    const Vec3f mean = [&] {
        Vec3f sum = Vec3f::Zero();
        for (std::size_t k = 0; k < n; ++k) {
            if (static_cast<int>(k) != reading.thumb) {
                sum += (reading.tips[k].position_mm - region.palm_mm).normalized();
            }
        }
        return sum;
    }();
    if (mean.norm() > 0.1F) {
        reading.finger_direction = mean.normalized();
    }
}

}  // namespace xtrack::track
