// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <xtrack/sim.hpp>

#include "core/sim/hand_model.hpp"
#include "core/sim/hand_pose.hpp"
#include "core/sim/sway.hpp"

namespace xtrack::sim {

/// x(t) of kValues values that move from target to target with the least jerk (Flash, Hogan 1985),
/// or evenly.
template <std::size_t kValues>
class Track {
 public:
    using Value = std::array<float, kValues>;
    explicit Track(const Value& start) : start_(start) {}

    /// Moves to `target` between the two times; moves must not overlap.
    void move(double start_s, double end_s, const Value& target) {
        moves_.push_back({start_s, end_s, target, false});
    }
    /// The same at constant velocity; in no time at all, it is a jump.
    void move_evenly(double start_s, double end_s, const Value& target) {
        moves_.push_back({start_s, end_s, target, true});
    }
    [[nodiscard]] const Value& target() const {
        return moves_.empty() ? start_ : moves_.back().target;
    }
    [[nodiscard]] Value at(double t_s) const {
        // Binary search: scripts are long, frames many.
        std::size_t low = 0;
        std::size_t high = moves_.size();
        while (low < high) {
            const std::size_t middle = (low + high) / 2;
            (moves_[middle].start_s <= t_s ? low : high) =
                moves_[middle].start_s <= t_s ? middle + 1 : middle;
        }
        if (low == 0) {
            return start_;
        }
        const Move& move = moves_[low - 1];
        const Value& from = low == 1 ? start_ : moves_[low - 2].target;
        if (t_s >= move.end_s) {
            return move.target;
        }
        const double u = (t_s - move.start_s) / (move.end_s - move.start_s);
        const auto s =
            static_cast<float>(move.even ? u : u * u * u * (10.0 + u * (-15.0 + 6.0 * u)));
        Value value{};
        for (std::size_t i = 0; i < kValues; ++i) {
            value[i] = from[i] + (move.target[i] - from[i]) * s;
        }
        return value;
    }

 private:
    struct Move {
        double start_s;
        double end_s;
        Value target;
        bool even;
    };
    Value start_;
    std::vector<Move> moves_;
};

/// All that one hand does, from its first to its last moment.
class HandMotion {
 public:
    /// Performs the script of this hand.
    HandMotion(const SimSettings& settings, SimHand hand, const HandModel& model);
    /// Moves as it is told, without a sway of its own. @pre the path has poses
    HandMotion(const SimSettings& settings, const SimPath& path);

    [[nodiscard]] SimHand hand() const noexcept { return hand_; }
    [[nodiscard]] HandPose at(double t_s) const;
    /// When the script of this hand is over, s.
    [[nodiscard]] double end_s() const noexcept { return clock_s_; }
    [[nodiscard]] const std::vector<SimLabel>& labels() const noexcept { return labels_; }

 private:
    class Planner;

    SimHand hand_;
    Vec3f shoulder_mm_ = Vec3f::Zero();
    double clock_s_ = 0.0;
    Track<3> place_;     ///< palm, camera frame, mm
    Track<3> turn_;      ///< rad
    Track<20> fingers_;  ///< FingerAngles
    std::optional<Sway> sway_;
    std::vector<SimLabel> labels_;
};

}  // namespace xtrack::sim
