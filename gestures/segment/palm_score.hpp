// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "gestures/segment/limb.hpp"
#include "gestures/segment/palm_search.hpp"
#include "gestures/segment/parts.hpp"

namespace xtrack::segment {

/// How much a candidate whose arm and wrist are known looks like a hand: its rank, its score and
/// its reach.
/// @param ahead_mm a hand is nearer than the body beside it by this
void score_palm(const Limb& limb, const Part& part, std::span<const Body> bodies, float ahead_mm,
                PalmCandidate& c);

}  // namespace xtrack::segment
