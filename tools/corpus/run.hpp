// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include <xtrack/gesture_settings.hpp>
#include <xtrack/result.hpp>
#include <xtrack/scoring.hpp>

#include "tools/corpus/sequence.hpp"

namespace xtrack::tools::corpus {

/// An event that was none, or a gesture that was missed, and what is known of why.
struct Finding {
    std::string sequence;  ///< with its seed and view
    double t_s = 0.0;
    std::string gesture;  ///< of the event, or of the label that nothing matched
    std::string doing;    ///< what the hand did
    bool missed = false;
    bool wrong_hand = false;
    bool strange = false;  ///< a stranger's
    /// The movement fulfils the plain definition (definitions::fulfilled_before()).
    bool by_definition = false;
    std::string why_not;  ///< missed: what its machine said last
};

/// All that sequences gave, added up.
struct Tally {
    std::map<std::string, GestureScore> scores;
    std::vector<Finding> findings;
    double hours = 0.0;
    double engaged_hours = 0.0;  ///< of these, with a session of anybody's
    int sequences = 0;
    int false_events = 0;    ///< of hands that were listened to
    int strange_events = 0;  ///< of hands that should not have been
    int owner_changes = 0;   ///< a stranger took the session after its owner had, who never left
    int engagements = 0;
    int short_of_definition = 0;

    void add(const Tally& other);
    [[nodiscard]] GestureScore all() const;
};

/// What a machine said no to.
struct Refusal {
    Stamp stamp;
    const char* machine = "";
    const char* why = "";
};

/// Which of a sequence's hands an event is of.
using HandOf = std::function<std::size_t(const GestureEvent&)>;

/// Adds up what a scorer made of a sequence's events.
[[nodiscard]] Tally tally_of(const Sequence& sequence, std::map<std::string, GestureScore> scores,
                             std::span<const JudgedEvent> judged, const HandOf& hand_of,
                             std::span<const Refusal> refusals);

/// Runs one sequence through one recogniser.
/// @errors invalid_argument: settings out of range
[[nodiscard]] Result<Tally> run(const Sequence& sequence, const GestureSettings& settings);

/// The hands of a sequence frame by frame, interaction frame, with all their joints: whatever it is
/// seen by, what a tracker of joints would have seen.
[[nodiscard]] std::vector<HandFrame> joints_of(const Sequence& sequence);

}  // namespace xtrack::tools::corpus
