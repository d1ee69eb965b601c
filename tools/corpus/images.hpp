// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "tools/corpus/run.hpp"
#include "tools/trial.hpp"

namespace xtrack::tools::corpus {

/// A simulated rig that people are looked at with, and what it shows.
struct ImageRig {
    const char* name;
    const char* preset;
    const char* method;  ///< empty: the preset's own three grey patterns
};
inline constexpr std::array<ImageRig, 4> kImageRigs{
    {{"ideal-60 grey", "ideal-60", ""},
     {"webcam-30 rgb", "webcam-30", "rgb"},
     {"webcam-30 grey", "webcam-30", ""},
     {"webcam-30 one colour", "webcam-30", "rgb-static"}}};

/// The person as a rig can see them: within its working distance.
[[nodiscard]] Person before_a_rig(Person person);

/// A trial in which a rig sees the sequence's first two hands.
/// @param sequence borrowed as long as the options live
[[nodiscard]] TrialOptions trial_of(const Sequence& sequence, const ImageRig& rig,
                                    const GestureSettings& settings);

/// Fringe images of the sequence's first two hands, through the whole pipeline.
/// @pre the people are before_a_rig(), nobody is strange
[[nodiscard]] Result<Tally> run_images(const Sequence& sequence, const ImageRig& rig,
                                       const GestureSettings& settings);

}  // namespace xtrack::tools::corpus
