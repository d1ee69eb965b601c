// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <xtrack/rig.hpp>

#include "core/sim/hand_pose.hpp"
#include "core/sim/motion.hpp"
#include "core/sim/random.hpp"
#include "core/sim/sway.hpp"
#include "tools/corpus/person.hpp"

namespace xtrack::tools::corpus {

/// The camera that all of this is seen with.
[[nodiscard]] const Pinhole& corpus_camera();

/// What a hand was doing for a while, for whoever asks what made an event.
struct Doing {
    double start_s = 0.0;
    const char* what = "";
};

/// One hand of one person, laid down stroke by stroke, then asked for any moment. Camera frame.
class Movement {
 public:
    /// Begins out of sight, below the image.
    Movement(const Person& person, SimHand hand);

    [[nodiscard]] const Person& person() const noexcept { return person_; }
    [[nodiscard]] SimHand hand() const noexcept { return hand_; }
    [[nodiscard]] Vec3f home() const noexcept { return person_.home_of(hand_); }
    /// Below the image, fingers too.
    [[nodiscard]] Vec3f away() const noexcept;
    [[nodiscard]] double now() const noexcept { return now_; }
    /// Where the plan has the palm at now().
    [[nodiscard]] Vec3f place() const;
    [[nodiscard]] sim::Random& random() noexcept { return random_; }
    [[nodiscard]] double draw(double low, double high) { return random_.between(low, high); }

    void wait(double seconds) { now_ += seconds; }
    void wait_until(double t_s) { now_ = std::max(now_, t_s); }
    /// In a straight line with the least jerk; now() is its end.
    void go(const Vec3f& target, double seconds);
    /// The same at a mean speed.
    void go_at(const Vec3f& target, double mean_mmps);
    /// Straight and even, a piece of a curve.
    void go_evenly(const Vec3f& target, double seconds);
    /// Begin now and take so long; now() stays.
    void turn(const Vec3f& turn_rad, double seconds);
    void shape(const sim::FingerAngles& fingers, double seconds);
    /// From now on this is what it does. @param what a literal
    void begin(const char* what) { doings_.push_back({now_, what}); }
    [[nodiscard]] const char* doing_at(double t_s) const;

    /// As it was meant: no sway, no tremor.
    [[nodiscard]] sim::HandPose planned(double t_s) const;
    /// As it is.
    [[nodiscard]] sim::HandPose at(double t_s) const;

 private:
    void fit_body(sim::HandPose& pose) const;

    Person person_;
    SimHand hand_;
    sim::Random random_;
    sim::Sway sway_;
    double now_ = 0.0;
    double turned_s_ = 0.0;  ///< when the last turn (shape) is over
    double shaped_s_ = 0.0;
    sim::Track<3> place_;
    sim::Track<3> turn_;
    sim::Track<20> fingers_;
    std::vector<Doing> doings_;
};

}  // namespace xtrack::tools::corpus
