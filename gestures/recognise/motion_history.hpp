// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include <xtrack/hand.hpp>
#include <xtrack/stamp.hpp>

#include "gestures/track/hand_from_joints.hpp"

namespace xtrack::recognise {

[[nodiscard]] constexpr Duration from_ms(double ms) noexcept {
    return Duration{static_cast<Duration::rep>(ms * 1e6)};
}
[[nodiscard]] constexpr double to_ms(Duration d) noexcept {
    return static_cast<double>(d.count()) * 1e-6;
}

/// What the machines remember of a hand at one moment.
struct MotionSample {
    Stamp stamp;
    Duration span = Duration::zero();  ///< over which it was measured; 0 = not known
    Vec3f palm_mm = Vec3f::Zero();
    Vec3f pointer_mm = Vec3f::Zero();  ///< the palm through a 1-euro filter
    Vec3f index_tip_mm = Vec3f::Zero();
    bool index_tip_known = false;
    Vec3f facing = Vec3f::Zero();  ///< unit, out of the palm; zero where no joints say it
    Vec3f side = Vec3f::Zero();    ///< unit, out of the side that is seen, palm or back
    bool facing_signed = false;    ///< false: the chirality is unknown, so either sign may be true
    float aperture_mm = -1.0F;     ///< thumb tip to index tip; -1 = unknown
    float hand_length_mm = 0.0F;   ///< 0 = unknown
    std::array<float, kFingerCount> extension{-1.0F, -1.0F, -1.0F, -1.0F, -1.0F};
    /// Of index to little finger; joints alone say it.
    std::array<Flexion, kFingerCount> flexion{};
    float grab = -1.0F;                 ///< 0 open .. 1 fist; -1 = unknown
    float thumb_to_fingers_mm = -1.0F;  ///< tip to the nearest joint of index, middle and ring
                                        ///< finger beyond the knuckles; -1 = unknown
    Vec3f thumb_along = Vec3f::Zero();  ///< unit, to the thumb's tip; zero = unknown
    /// Thumb and index tip as seen from the index knuckle, so that the arm's motion drops out.
    Vec3f thumb_from_knuckle_mm = Vec3f::Zero();
    Vec3f index_from_knuckle_mm = Vec3f::Zero();
    bool knuckle_known = false;
    float thumb_to_middle_mm = -1.0F;  ///< tips; -1 = unknown
    /// Joints are known, so that an extension of 0 means folded. A depth camera says 0 of a finger
    /// that it cannot tell from its neighbour, too.
    bool from_joints = false;
    Vec3f distal = Vec3f::Zero();      ///< unit, along the hand to the fingertips; zero = unknown
    Vec3f far_tip_mm = Vec3f::Zero();  ///< the fingertip that is farthest from the palm
    bool far_tip_known = false;

    /// Mean extension of middle, ring and little finger; -1 where none is known.
    [[nodiscard]] float outer_extension() const noexcept;
};

[[nodiscard]] MotionSample sample_of(const Hand& seen, Stamp stamp, Duration span) noexcept;

/// The last second of one hand, newest first. Fixed size; never allocates.
class MotionHistory {
 public:
    /// Denser samples are left out, so that the ring holds a second at any frame rate.
    static constexpr Duration kMinSpacing{3'500'000};
    static constexpr std::size_t kCapacity = 288;

    /// An aperture that no hand can have after the one before is stored as unknown.
    /// @return false when the sample was left out: not later than the newest, or too close to it
    bool add(const MotionSample& sample) noexcept;
    void clear() noexcept { count_ = 0; }

    [[nodiscard]] std::size_t size() const noexcept { return count_; }
    /// @param back 0 is the newest; back < size()
    [[nodiscard]] const MotionSample& at(std::size_t back) const noexcept {
        return samples_[(newest_ + kCapacity - back) % kCapacity];
    }
    [[nodiscard]] const MotionSample& newest() const noexcept { return at(0); }

    /// Line fit of the palm over `window` that ends `back` samples ago; mm/s. At a frame rate where
    /// the window holds one sample, the one before it is taken too. Zero with a single sample.
    [[nodiscard]] Vec3f velocity(Duration window, std::size_t back = 0) const noexcept;

    /// The same for the fingertip farthest from the palm, where it is known in at least three
    /// samples of the window; else the palm's.
    [[nodiscard]] Vec3f tip_velocity(Duration window) const noexcept;

    /// Mean of what is known (not negative) over the newest 40 ms; -1 = unknown.
    [[nodiscard]] double recent(float MotionSample::*what) const noexcept;

    /// How far the palm moved while its depth was measured: a camera's depth is made of several
    /// images, and what is seen of the fingers in a stroke cannot be believed. 0 for joints.
    /// @param window of the velocity, at least
    [[nodiscard]] double smear_mm(Duration window, std::size_t back = 0) const noexcept;

    /// Half of the time between the two newest samples, 50 ms at most: what was first seen in a
    /// sample began so long before it, on average. 0 with a single sample.
    [[nodiscard]] Duration unseen() const noexcept;

    /// How many samples are not older than `age` (counted from the newest).
    [[nodiscard]] std::size_t count_within(Duration age) const noexcept;

 private:
    [[nodiscard]] bool believable(const MotionSample& sample) const noexcept;

    std::array<MotionSample, kCapacity> samples_{};
    std::size_t newest_ = 0;
    std::size_t count_ = 0;
};

}  // namespace xtrack::recognise
