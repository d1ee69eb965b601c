// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <xtrack/hand.hpp>

#include "core/sim/random.hpp"
#include "gestures/track/hand_from_joints.hpp"
#include "gestures/track/pointer.hpp"
#include "tools/corpus/movement.hpp"
#include "tools/corpus/noise.hpp"
#include "tools/corpus/seen_hand.hpp"

namespace xtrack::tools::corpus {

/// Turns movements into what a tracker says of them: noise that lasts, tips that merge, hands that
/// are lost and come back, before a body that hides them.
class Tracked {
 public:
    /// @param hands borrowed for the object's life; the first kMaxHands in sight are followed
    Tracked(View view, double frame_hz, std::uint64_t seed, std::span<const Movement* const> hands);

    /// The hands of a moment, interaction frame. Moments must increase.
    const HandFrame& at(double t_s);

    /// Whose hand an id is: an index of `hands`. @pre it was in a frame
    [[nodiscard]] std::size_t owner_of(int hand_id) const {
        return owners_[static_cast<std::size_t>(hand_id) - 1];
    }

 private:
    /// A normal variable that forgets its past with a time constant.
    struct Drift {
        double value = 0.0;
        void step(sim::Random& random, double dt_s, double tau_s);
    };
    /// An even one of 0..1 that is drawn anew now and then.
    struct Mood {
        double value = 0.5;
        void step(sim::Random& random, double dt_s, double tau_s);
    };
    struct Follow {
        const Movement* movement = nullptr;
        int id = 0;
        double last_seen_s = -1e9;
        Vec3f last_mm = Vec3f::Zero();
        double lost_until_s = -1e9;
        double first_seen_s = 0.0;
        double confidence = 0.0;
        bool taken_for_other = false;
        std::array<Drift, 3> palm;
        std::array<std::array<Drift, 3>, kJointCount> points;  ///< tips, or joints
        std::array<Drift, kFingerCount> extension;
        std::array<Mood, kFingerCount> tip_mood;
        std::array<Drift, 3> normal;
        Drift aperture;
        Drift grab;
        std::array<Mood, kFingerCount> finger_mood;
        Mood outlier;
        Mood wild;
        Mood known;
        Mood side;
        std::array<Stamp, 32> stamps{};
        std::array<Vec3f, 32> path_mm{};
        std::size_t path = 0;
    };

    void step(Follow& f, double dt_s);
    [[nodiscard]] double clearance_mm(const Follow& f, const SeenHand& seen) const;
    bool see(Follow& f, double t_s, double dt_s, Hand& hand);
    void see_depth(Follow& f, const SeenHand& seen, bool moves, Hand& hand);
    void see_joints(Follow& f, const SeenHand& seen, bool moves, Hand& hand);
    void name_side(Follow& f, double t_s, Hand& hand);
    void measure_velocity(Follow& f, Stamp stamp, Hand& hand);

    View view_;
    const Noise& noise_;
    double frame_s_;
    sim::Random random_;
    double last_s_ = -1.0;
    std::vector<Follow> follows_;
    std::vector<std::size_t> owners_;
    HandFromJoints from_joints_;
    Pointer pointer_;
    HandFrame frame_;
};

}  // namespace xtrack::tools::corpus
