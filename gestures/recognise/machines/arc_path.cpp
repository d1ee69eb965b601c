// SPDX-License-Identifier: Apache-2.0
#include "gestures/recognise/machines/arc_path.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace xtrack::recognise {

namespace {

using Vec2d = Eigen::Vector2d;

constexpr float kStepMm = 15.0F;        // noise of 3 mm turns it by less than 20 degrees
constexpr std::size_t kLeastNodes = 6;  // through fewer any bend is a circle
// A path on a circle is at least nearly as long as its arc; and the quick measure of its error,
// root mean square of the squared distances, is never above the farthest.
constexpr double kWayShare = 0.8;

/// Circle through points, least squares of the squared distances (Kasa 1976). Sums only, so that a
/// point more costs nothing.
class CircleFit {
 public:
    void add(const Vec2d& p) {
        const double z = p.squaredNorm();
        ++n_;
        sum_ += p;
        xx_ += p.x() * p.x();
        yy_ += p.y() * p.y();
        xy_ += p.x() * p.y();
        zp_ += z * p;
        z_ += z;
        zz_ += z * z;
    }
    struct Circle {
        bool found = false;
        Vec2d centre = Vec2d::Zero();
        double radius = 0.0;
        double error = 0.0;  ///< root mean square, a share of the radius
    };
    [[nodiscard]] Circle solve() const {
        const double n = static_cast<double>(n_);
        const Vec2d mean = sum_ / n;
        const double mean_z = z_ / n;
        const double a = xx_ / n - mean.x() * mean.x();
        const double b = xy_ / n - mean.x() * mean.y();
        const double c = yy_ / n - mean.y() * mean.y();
        const Vec2d d = zp_ / n - mean_z * mean;
        const double det = a * c - b * b;
        constexpr double kFlat = 1e-6;  // of the trace squared: on a line
        if (det <= kFlat * (a + c) * (a + c)) {
            return {};
        }
        const Vec2d twice{(d.x() * c - d.y() * b) / det, (d.y() * a - d.x() * b) / det};
        const Vec2d centre = 0.5 * twice;
        const double squared = mean_z - twice.dot(mean) + centre.squaredNorm();
        const double left = zz_ / n - mean_z * mean_z - twice.dot(d);
        if (squared <= 0.0) {
            return {};
        }
        return {true, centre, std::sqrt(squared), std::sqrt(std::max(left, 0.0)) / (2.0 * squared)};
    }

 private:
    int n_ = 0;
    Vec2d sum_ = Vec2d::Zero();
    double xx_ = 0.0;
    double yy_ = 0.0;
    double xy_ = 0.0;
    Vec2d zp_ = Vec2d::Zero();
    double z_ = 0.0;
    double zz_ = 0.0;
};

double turn_rad(const Vec2f& from, const Vec2f& to) {
    return static_cast<double>(std::atan2(from.x() * to.y() - from.y() * to.x(), from.dot(to)));
}

}  // namespace

bool ArcPath::add(const Vec3f& point_mm, Stamp now) noexcept {
    const Vec2f p = point_mm.head<2>();
    if (count_ == 0) {
        newest_ = 0;
        count_ = 1;
        nodes_[0] = {p, 0.0, now};
        return true;
    }
    const Node& last = at(0);
    const float step_mm = (p - last.point_mm).norm();
    if (step_mm < kStepMm) {
        if (count_ == 1) {
            nodes_[newest_].stamp = now;  // the path begins where the rest ends
        }
        return false;
    }
    const Node node{p, last.way_mm + static_cast<double>(step_mm), now};
    newest_ = (newest_ + 1) % kCapacity;
    count_ = std::min(count_ + 1, kCapacity);
    nodes_[newest_] = node;
    return true;
}

Arc ArcPath::measure(std::size_t count, const Vec2f& centre_mm, double radius_mm) const noexcept {
    Arc arc;
    arc.found = true;
    arc.centre_mm = centre_mm;
    arc.radius_mm = radius_mm;
    arc.start = at(count - 1).stamp;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec2f spoke = at(i).point_mm - centre_mm;
        const double off_mm = std::abs(static_cast<double>(spoke.norm()) - radius_mm);
        arc.error = std::max(arc.error, off_mm / radius_mm);
        if (i + 1 < count) {
            arc.turned_rad += turn_rad(at(i + 1).point_mm - centre_mm, spoke);
        }
    }
    return arc;
}

Arc ArcPath::find(const Limits& limits) const noexcept {
    Arc best;
    CircleFit fit;
    for (std::size_t i = 0; i < count_ && newest() - at(i).stamp <= limits.within; ++i) {
        // About the newest point, so that squares stay small.
        fit.add((at(i).point_mm - at(0).point_mm).cast<double>());
        if (i + 1 < kLeastNodes) {
            continue;
        }
        const CircleFit::Circle circle = fit.solve();
        const double way_mm = at(0).way_mm - at(i).way_mm;
        if (!circle.found || circle.radius < limits.least_mm || circle.radius > limits.most_mm ||
            circle.error > limits.error || way_mm < kWayShare * limits.turned_rad * circle.radius) {
            continue;
        }
        const Vec2f centre_mm = at(0).point_mm + circle.centre.cast<float>();
        const Arc arc = measure(i + 1, centre_mm, circle.radius);
        const double turned = std::abs(arc.turned_rad);
        if (arc.error <= limits.error && turned >= limits.turned_rad &&
            turned > std::abs(best.turned_rad)) {
            best = arc;
            if (turned >= limits.enough_rad) {
                break;
            }
        }
    }
    return best;
}

Arc ArcPath::newest_turn(double radius_mm, const Limits& limits) const noexcept {
    const double turn_mm = 2.0 * std::numbers::pi * radius_mm;
    CircleFit fit;
    std::size_t n = 0;
    while (n < count_ && at(0).way_mm - at(n).way_mm <= turn_mm) {
        fit.add((at(n).point_mm - at(0).point_mm).cast<double>());
        ++n;
    }
    const CircleFit::Circle circle = n >= kLeastNodes ? fit.solve() : CircleFit::Circle{};
    if (!circle.found || circle.radius < limits.least_mm || circle.radius > limits.most_mm) {
        return {};
    }
    Arc arc = measure(n, at(0).point_mm + circle.centre.cast<float>(), circle.radius);
    arc.found = arc.error <= limits.error;
    return arc;
}

double ArcPath::step_rad(const Vec2f& centre_mm) const noexcept {
    return count_ < 2 ? 0.0 : turn_rad(at(1).point_mm - centre_mm, at(0).point_mm - centre_mm);
}

}  // namespace xtrack::recognise
