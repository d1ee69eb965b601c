// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include <xtrack/geometry.hpp>
#include <xtrack/stamp.hpp>

namespace xtrack::recognise {

/// A circle through the newest part of a path, in the x-y plane: as the user sees it.
struct Arc {
    bool found = false;
    Vec2f centre_mm = Vec2f::Zero();
    double radius_mm = 0.0;
    double error = 0.0;     ///< the farthest off the circle, as a share of the radius
    double turned_rad = 0;  ///< about the centre; positive is counterclockwise
    Stamp start;
};

/// The way of a point, thinned to steps of 15 mm, so that it is as long in time as the motion is
/// slow. Fixed size; never allocates.
class ArcPath {
 public:
    struct Limits {
        double least_mm = 0.0;  ///< radius
        double most_mm = 0.0;
        double error = 0.0;
        double turned_rad = 0.0;  ///< at least
        double enough_rad = 0.0;  ///< no need to look for more
        Duration within = Duration::zero();
    };

    void clear() noexcept { count_ = 0; }
    /// @return whether it was a step
    bool add(const Vec3f& point_mm, Stamp now) noexcept;
    [[nodiscard]] bool empty() const noexcept { return count_ == 0; }
    /// Of the newest step; not when empty.
    [[nodiscard]] Stamp newest() const noexcept { return at(0).stamp; }

    /// The longest arc that ends with the newest step and keeps within the limits.
    [[nodiscard]] Arc find(const Limits& limits) const noexcept;
    /// The circle of the newest turn of a radius, however long its arc; not found off the limits.
    [[nodiscard]] Arc newest_turn(double radius_mm, const Limits& limits) const noexcept;
    /// The newest step, as an angle about a centre.
    [[nodiscard]] double step_rad(const Vec2f& centre_mm) const noexcept;

 private:
    static constexpr std::size_t kCapacity = 176;  // a turn of 400 mm
    struct Node {
        Vec2f point_mm = Vec2f::Zero();
        double way_mm = 0.0;  ///< since the path began
        Stamp stamp;
    };

    [[nodiscard]] const Node& at(std::size_t back) const noexcept {
        return nodes_[(newest_ + kCapacity - back) % kCapacity];
    }
    [[nodiscard]] Arc measure(std::size_t count, const Vec2f& centre_mm,
                              double radius_mm) const noexcept;

    std::array<Node, kCapacity> nodes_{};
    std::size_t newest_ = 0;
    std::size_t count_ = 0;
};

}  // namespace xtrack::recognise
