// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/corpus/movement.hpp"

namespace xtrack::tools::corpus {

/// What people do with their hands that is meant for nobody: rests, reaches, scratches, drinks,
/// types, talks. What is a gesture by definition whoever makes it (a wave to a friend, a held-up
/// thumb, a ring of thumb and index while talking) is left out; docs/corpus.md lists it.
/// Goes on until `end_s` at least, with marks of what is done.
void live(Movement& m, double end_s);

/// One who does not stop: the hand swings across the image while its owner walks.
/// @param distance_mm camera Z
void walk_past(Movement& m, double distance_mm);

/// Talks with the hands for so long.
void talk(Movement& m, double seconds);

}  // namespace xtrack::tools::corpus
