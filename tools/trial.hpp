// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <xtrack/scoring.hpp>
#include <xtrack/session.hpp>
#include <xtrack/sim.hpp>

namespace xtrack::tools {

/// One simulated person before one simulated rig.
struct TrialOptions {
    std::string preset = "ideal-60";
    std::uint64_t seed = 0;  ///< 0: the preset's own person; else another for every number
    std::string method;      ///< of show_method(); empty: the preset's own patterns
    bool use_rig = true;     ///< false: relative depth, no pinches
    Pace pace = Pace::replay;
    /// What is looked for; absent: the standard gestures, without pinches where there is no rig.
    std::optional<GestureSettings> gestures;
    /// Has the last word on what is simulated; what it lets happen, `labels` say instead of the
    /// simulator.
    std::function<void(SimSettings&)> arrange;
    std::vector<GestureLabel> labels;
    /// Compare depth and palm with the truth now and then. Only in replay: truth is rendered by the
    /// source, which is read in another thread otherwise.
    bool measure_depth = false;
};

/// How well it went, against what the simulator knows.
struct TrialResult {
    GestureScore score;
    std::map<std::string, GestureScore> gestures;
    std::vector<JudgedEvent> events;
    std::vector<GestureLabel> labels;
    std::vector<double> depth_rms_mm;   ///< a measured frame: hand, pixels within 15 mm
    std::vector<double> depth_off;      ///< share of the hand off by more
    std::vector<double> depth_missing;  ///< share of the hand without depth
    std::vector<double> palm_error_mm;
    SessionStatistics statistics;

    void add(const TrialResult& other);
};

/// The gestures that are looked for.
[[nodiscard]] GestureSettings gestures_of(const TrialOptions& options);

/// Called before the session runs, to subscribe to it.
using TrialSetup = std::function<void(Session&, const SimulatedRig&)>;

[[nodiscard]] Result<TrialResult> run_trial(const TrialOptions& options,
                                            const TrialSetup& setup = {});

}  // namespace xtrack::tools
