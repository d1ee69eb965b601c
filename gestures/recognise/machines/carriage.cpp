// SPDX-License-Identifier: Apache-2.0
#include "gestures/recognise/machines/carriage.hpp"

#include <algorithm>
#include <cmath>

#include "gestures/recognise/machines/angles.hpp"

namespace xtrack::recognise {

namespace {

constexpr float kUpright = 0.7F;  // 45 degrees over the horizontal
// Extension and grab of a flat hand. Measured: hands that swipe 0.75..1 and 0..0.2.
constexpr double kFlatExtension = 0.7;
constexpr double kFlatGrab = 0.25;
constexpr float kLeastChordMm = 20.0F;  // a shorter one has no direction

/// Mean of what is known.
class Mean {
 public:
    void add(float value) {
        if (value >= 0.0F) {
            sum_ += static_cast<double>(value);
            ++count_;
        }
    }
    /// @param least so many must be known
    [[nodiscard]] double value(std::size_t least = 1) const {
        return count_ >= std::max<std::size_t>(least, 1) ? sum_ / static_cast<double>(count_)
                                                         : -1.0;
    }

 private:
    double sum_ = 0.0;
    std::size_t count_ = 0;
};

double cross(const Vec3f& a, const Vec3f& b) {
    return static_cast<double>(a.x()) * static_cast<double>(b.y()) -
           static_cast<double>(a.y()) * static_cast<double>(b.x());
}

double bend_of(const MotionHistory& history, std::size_t samples) {
    const Vec3f from = history.at(samples - 1).palm_mm;
    const Vec3f chord = history.newest().palm_mm - from;
    const double chord_mm = static_cast<double>(chord.head<2>().norm());
    if (chord.head<2>().norm() < kLeastChordMm) {
        return 0.0;
    }
    double area = 0.0;
    for (std::size_t i = samples - 1; i > 0; --i) {
        area += 0.5 * cross(history.at(i).palm_mm - from, history.at(i - 1).palm_mm - from);
    }
    // A segment of a circle: two thirds of chord times height, and height over half the chord is
    // the tangent of a quarter of the angle.
    const double height_mm = 1.5 * std::abs(area) / chord_mm;
    return degrees(4.0 * std::atan(2.0 * height_mm / chord_mm));
}

}  // namespace

bool Carriage::is_upright() const noexcept {
    return distal.y() >= kUpright && extension.all >= kFlatExtension && grab <= kFlatGrab;
}

Extensions extensions_in(const MotionHistory& history, std::size_t back,
                         std::size_t count) noexcept {
    Mean index;
    Mean outer;
    Mean all;
    for (std::size_t i = back; i < std::min(back + count, history.size()); ++i) {
        const MotionSample& sample = history.at(i);
        for (const Finger f : {Finger::index, Finger::middle, Finger::ring, Finger::little}) {
            all.add(sample.extension[static_cast<std::size_t>(f)]);
        }
        index.add(sample.extension[static_cast<std::size_t>(Finger::index)]);
        outer.add(sample.outer_extension());
    }
    return {index.value(), outer.value(), all.value()};
}

Carriage carriage(const MotionHistory& history, std::size_t samples, const Vec3f& along) noexcept {
    Carriage held;
    Vec3f facing = Vec3f::Zero();
    Mean grab;
    for (std::size_t i = 0; i < samples; ++i) {
        const MotionSample& sample = history.at(i);
        facing += sample.facing;
        held.distal += sample.distal;
        held.side += sample.side;
        grab.add(sample.grab);
    }
    held.facing_known = facing.norm() > 0.0F;
    if (held.facing_known) {
        facing.normalize();
    }
    if (!held.distal.isZero()) {
        held.distal.normalize();
    }
    if (!held.side.isZero()) {
        held.side.normalize();
    }
    held.leads = static_cast<double>(facing.dot(along));
    held.shown = static_cast<double>(-facing.z());
    if (!history.newest().facing_signed) {
        held.leads = std::abs(held.leads);
        held.shown = std::abs(held.shown);
    }
    held.extension = extensions_in(history, 0, samples);
    held.grab = grab.value((samples + 1) / 2);
    held.bend_deg = bend_of(history, samples);
    return held;
}

}  // namespace xtrack::recognise
