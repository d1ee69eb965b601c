// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <xtrack/result.hpp>
#include <xtrack/scoring.hpp>
#include <xtrack/tracker_settings.hpp>

namespace xtrack::tools {

/// How the tracker reads single depth images, of which each is a stream of its own.
struct EvaluatedStills {
    std::string name;  ///< of the folder
    int with_hand = 0;
    int found = 0;  ///< of these, at least one hand
    int without_hand = 0;
    int none_found = 0;   ///< of these, no hand
    int counted = 0;      ///< images with a hand whose extended fingers somebody counted
    int count_right = 0;  ///< of these, the most confident hand has as many
    int count_near = 0;   ///< of these, one more or less at most

    [[nodiscard]] Estimate found_share() const noexcept { return wilson(found, with_hand); }
    [[nodiscard]] Estimate none_share() const noexcept { return wilson(none_found, without_hand); }
    [[nodiscard]] Estimate right_share() const noexcept { return wilson(count_right, counted); }
    [[nodiscard]] Estimate near_share() const noexcept { return wilson(count_near, counted); }
    void add(const EvaluatedStills& other);
};

/// Whether a folder says what its single images show.
[[nodiscard]] bool has_stills(const std::string& folder);

/// Compares every image of poses.csv with what a tracker that has seen nothing else finds in it.
/// @errors as RecordingReader::open() and read_poses(); malformed: a row names a frame that is not
///         there; unsupported: the folder holds no depth images, or no rig.yaml
[[nodiscard]] Result<EvaluatedStills> evaluate_stills(const std::string& folder,
                                                      const TrackerSettings& settings);

}  // namespace xtrack::tools
