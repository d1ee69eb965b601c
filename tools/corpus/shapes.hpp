// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <xtrack/hand.hpp>

#include "core/sim/hand_pose.hpp"

namespace xtrack::tools::corpus {

// How hands are held, beside the simulator's own relaxed_open() and pinch_open().

[[nodiscard]] sim::FingerAngles flat();  ///< straight fingers, a little apart
[[nodiscard]] sim::FingerAngles fist();
[[nodiscard]] sim::FingerAngles pointing();   ///< index out
[[nodiscard]] sim::FingerAngles victory();    ///< index and middle out
[[nodiscard]] sim::FingerAngles thumb_out();  ///< a fist with its thumb out
[[nodiscard]] sim::FingerAngles pinched();    ///< thumb and index touch
[[nodiscard]] sim::FingerAngles gripping();   ///< round a cup
/// A hand in motion or at rest: between open and half curled. @param curl 0..1
[[nodiscard]] sim::FingerAngles loose(float curl);
/// With the index finger bent by so much more at its knuckle, rad, the rest following.
[[nodiscard]] sim::FingerAngles with_index_bent(sim::FingerAngles fingers, float rad);

/// How far the fingers are on the way from one shape to another, least of all five: 1 = there.
[[nodiscard]] float likeness(const sim::FingerAngles& fingers, const sim::FingerAngles& shape,
                             const sim::FingerAngles& from);

}  // namespace xtrack::tools::corpus
