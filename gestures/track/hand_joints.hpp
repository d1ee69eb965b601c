// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <xtrack/hand.hpp>
#include <xtrack/hand_region.hpp>

namespace xtrack::track {

/// Fills Hand::joints as far as depth tells: palm and wrist always, and where a finger is straight
/// the fingers' roots, the tips that are seen, and the joints of fingers that are straight, by the
/// proportions of a hand (Buryanov, Kotiuk: Proportions of hand segments, Int. J. Morphol. 28,
/// 2010). Joints lie inside the hand, not at its skin, and where the thumb's side is not known
/// nothing of the fingers is told. What is bent or not seen stays invalid.
/// @param hand palm, normal, tips and extension are set; camera frame
/// @param thumb_side +1: clockwise of the fingers in the image, -1: the other way, 0: not known
void infer_joints(const HandRegion& region, int thumb_side, Hand& hand);

}  // namespace xtrack::track
