// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include <xtrack/hand.hpp>
#include <xtrack/hand_region.hpp>
#include <xtrack/tracker_settings.hpp>

#include "gestures/track/finger_tracks.hpp"
#include "gestures/track/fingers.hpp"

namespace xtrack::track {

/// One hand through time: what is known of it beyond the last frame.
class HandTrack {
 public:
    void begin(int id);
    void end() { id_ = 0; }
    [[nodiscard]] bool active() const noexcept { return id_ != 0; }
    [[nodiscard]] int id() const noexcept { return id_; }
    [[nodiscard]] Stamp last_seen() const noexcept { return last_seen_; }

    /// Where the palm should be at a moment: along its velocity, for a short while.
    [[nodiscard]] Vec3f predict(Stamp at) const;
    [[nodiscard]] const Vec3f& arm_direction() const noexcept { return arm_direction_; }
    [[nodiscard]] float palm_radius_mm() const noexcept { return palm_radius_mm_; }
    /// +1 or -1 when the thumb's side is known, else 0.
    [[nodiscard]] int thumb_side() const noexcept;

    /// Takes one frame's reading, names its tips, and gives the hand.
    void update(Stamp stamp, const HandRegion& region, const Vec3f& normal, FingerReading& fingers,
                const TrackerSettings& settings, Hand& hand);

 private:
    struct Sample {
        Stamp stamp;
        Vec3f palm_mm = Vec3f::Zero();
    };

    [[nodiscard]] Vec3f fit_velocity(Duration window) const;
    void weigh_chirality(const HandRegion& region, const FingerReading& fingers, float seconds,
                         Hand& hand);
    void fill_fingers(const HandRegion& region, const FingerReading& fingers, Hand& hand);
    void fill_pinch(Hand& hand) const;

    /// 200 ms at 240 frames a second.
    static constexpr std::size_t kHistory = 48;

    int id_ = 0;
    FingerTracks finger_tracks_;
    Stamp last_seen_;
    std::array<Sample, kHistory> history_{};
    std::size_t samples_ = 0;
    std::size_t newest_ = 0;
    Vec3f velocity_mmps_ = Vec3f::Zero();
    Vec3f arm_direction_ = Vec3f::Zero();
    float palm_radius_mm_ = 0.0F;
    float confidence_ = 0.0F;
    float side_log_odds_ = 0.0F;   ///< > 0: the thumb is clockwise of the fingers in the image
    float palm_log_odds_ = 0.0F;   ///< > 0: the palm faces the camera, not the back
    float entry_log_odds_ = 0.0F;  ///< > 0: the forearm comes from the user's right
};

/// Slope of a straight line through samples (least squares), per second.
/// @param stamps, points of the same length
[[nodiscard]] Vec3f line_slope(std::span<const Stamp> stamps, std::span<const Vec3f> points);

}  // namespace xtrack::track
