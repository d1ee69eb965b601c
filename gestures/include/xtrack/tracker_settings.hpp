// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <xtrack/stamp.hpp>

namespace xtrack {

/// What the hand tracker takes for a hand, and how long it remembers. The defaults fit adults
/// between 0.2 and 1.5 m; sizes leave 20 % for a depth scale that is only estimated.
/// @since 0.1
struct TrackerSettings {
    int max_hands = 2;  ///< 1 to kMaxHands

    /// Depth that is looked at, mm. 0: the rig's working volume, or 150..1500 where it has none.
    double near_mm = 0.0;
    double far_mm = 0.0;

    double palm_radius_min_mm = 20.0;   ///< of the largest inscribed circle; a child's fist
    double palm_radius_max_mm = 62.0;   ///< above it is a head, a torso, a wall
    double hand_length_max_mm = 240.0;  ///< wrist to the middle finger's tip
    double hand_area_min_mm2 = 1800.0;  ///< seen surface; a hand seen edge-on
    /// A hand must be nearer than the front of the body beside it by this, and is not doubted from
    /// twice this on: a shoulder is as far as the chest, a face is 100 mm nearer.
    double ahead_of_body_mm = 60.0;

    bool learn_background = true;
    /// A surface that no hand was seen on becomes background after this long.
    Duration background_hold = std::chrono::seconds{2};
    /// A hand may rest without moving for this long before its pixels become background.
    Duration hand_rest = std::chrono::seconds{30};
    double background_margin_mm = 15.0;  ///< nearer than the background by more is foreground

    Duration reacquire_time = std::chrono::milliseconds{300};   ///< same id if back within this
    double reacquire_distance_mm = 100.0;                       ///< and within this
    Duration velocity_window = std::chrono::milliseconds{100};  ///< of the line fit
    double tip_prominence_mm = 12.0;  ///< a fingertip stands out from its valleys by this much
};

}  // namespace xtrack
