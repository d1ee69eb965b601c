// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include <xtrack/hand.hpp>
#include <xtrack/hand_region.hpp>
#include <xtrack/stamp.hpp>

#include "gestures/track/fingers.hpp"

namespace xtrack::track {

/// What is known of one finger beyond the last frame. Positions are relative to the palm's centre.
struct FingerState {
    Vec3f tip_mm = Vec3f::Zero();  ///< from the palm's centre
    Stamp seen;
    bool known = false;  ///< seen a short while ago
    bool fresh = false;  ///< seen in this frame
    int tip = -1;        ///< which tip of the reading, if fresh
};

/// Five fingertips through time. A tip keeps the name that it had in the frame before: names come
/// from where the fingers just were and from their order round the palm, and only a hand that was
/// not seen before is named from a single frame. Knows when thumb and index have met, because two
/// tips that ran into each other are one tip, or a ring round a hole.
class FingerTracks {
 public:
    void reset() { *this = {}; }

    /// @param side +1: the thumb is clockwise of the fingers in the image, -1: the other way, 0:
    /// not
    ///        known
    /// @param reading the names of its tips are overwritten by those that time gives
    void update(Stamp stamp, const HandRegion& region, int side, FingerReading& reading);

    [[nodiscard]] const FingerState& finger(Finger f) const {
        return fingers_[static_cast<std::size_t>(f)];
    }
    /// Pad of the thumb to pad of the index finger; -1 = not known.
    [[nodiscard]] float aperture_mm() const noexcept {
        return aperture_known_ ? aperture_mm_ : -1.0F;
    }
    /// Thumb and index are seen as one.
    [[nodiscard]] bool touching() const noexcept { return touching_; }
    /// The tips of this frame were named by those of the frame before.
    [[nodiscard]] bool followed() const noexcept { return followed_; }

 private:
    [[nodiscard]] bool names_agree(const FingerReading& reading) const;
    void forget(Stamp stamp);
    void follow(Stamp stamp, const HandRegion& region, int side, FingerReading& reading);
    void adopt(Stamp stamp, const HandRegion& region, const FingerReading& reading);
    [[nodiscard]] bool met(Stamp stamp, const HandRegion& region, const FingerReading& reading,
                           Vec3f& where_mm) const;
    void measure_aperture(Stamp stamp, const HandRegion& region, int side,
                          const FingerReading& reading);
    void accept(Stamp stamp, float aperture_mm);

    std::array<FingerState, kFingerCount> fingers_{};
    float aperture_mm_ = -1.0F;  ///< as last measured
    Stamp aperture_at_;
    bool aperture_known_ = false;
    float course_mmps_ = 0.0F;  ///< of the aperture: negative closes
    bool course_known_ = false;
    bool touching_ = false;
    Vec3f touch_mm_ = Vec3f::Zero();  ///< where, from the palm's centre
    Stamp touch_seen_;                ///< when there was last something to see of it
    bool followed_ = false;
    Stamp agreed_;  ///< when a frame's own naming and time's agreed last
};

}  // namespace xtrack::track
