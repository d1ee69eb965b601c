// SPDX-License-Identifier: Apache-2.0
#include "tools/trial.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>

#include "tools/hand_accuracy.hpp"
#include "tools/method_choice.hpp"

namespace xtrack::tools {

namespace {

constexpr std::uint64_t kMeasureEvery = 20;  // frames; rendering truth costs as much as a frame
constexpr double kInlier_mm = 15.0;

GestureLabel label_of(const SimLabel& sim) {
    GestureLabel label;
    label.gesture = sim.gesture;
    label.hand = sim.hand == SimHand::left ? Chirality::left : Chirality::right;
    label.start = sim.start;
    label.end = sim.end;
    label.commit = sim.commit;
    return label;
}

/// Truth of the last few frames, since a depth image belongs to the middle of its window.
class TruthMeter {
 public:
    TruthMeter(SimulatedRig& rig, TrialResult& result) : rig_(rig), result_(result) {}

    void see(const PipelineView& view) {
        if (view.frame != nullptr && (*view.frame)->sequence % kMeasureEvery < kKept) {
            kept_[next_++ % kKept] = rig_.truth();
        }
        if (view.depth == nullptr) {
            return;
        }
        for (const SimTruth& truth : kept_) {
            if (truth.stamp == view.depth->stamp && truth.sequence > last_measured_) {
                last_measured_ = truth.sequence;
                measure_depth(truth, *view.depth);
                if (view.camera_hands != nullptr) {
                    measure_palm(truth, *view.camera_hands);
                }
            }
        }
    }

 private:
    static constexpr std::size_t kKept = 4;  // frames from the middle of a window to its newest

    void measure_depth(const SimTruth& truth, const DepthFrame& depth) {
        const HandAccuracy hand =
            measure_hand(depth, truth.depth.view(), truth.mask.view(), kInlier_mm);
        constexpr std::size_t kEnough = 500;  // pixels; fewer is a hand on its way in or out
        if (hand.pixels < kEnough || hand.close == 0) {
            return;
        }
        result_.depth_rms_mm.push_back(hand.rms_mm());
        result_.depth_off.push_back(hand.off_percent() * 1e-2);
        result_.depth_missing.push_back(hand.missing_percent() * 1e-2);
    }

    void measure_palm(const SimTruth& truth, const HandFrame& hands) {
        for (std::size_t i = 0; i < truth.hand_count; ++i) {
            const SimHandTruth& real = truth.hands[i];
            if (!real.palm_visible) {
                continue;
            }
            double nearest_mm = INFINITY;
            for (const Hand& hand : hands.all()) {
                nearest_mm = std::min<double>(nearest_mm, (hand.palm_mm - real.palm_mm).norm());
            }
            if (std::isfinite(nearest_mm)) {
                result_.palm_error_mm.push_back(nearest_mm);
            }
        }
    }

    SimulatedRig& rig_;
    TrialResult& result_;
    std::array<SimTruth, kKept> kept_;
    std::size_t next_ = 0;
    std::uint64_t last_measured_ = 0;
};

void append(std::vector<double>& to, const std::vector<double>& from) {
    to.insert(to.end(), from.begin(), from.end());
}

}  // namespace

void TrialResult::add(const TrialResult& other) {
    score.add(other.score);
    for (const auto& [name, one] : other.gestures) {
        gestures[name].add(one);
    }
    append(depth_rms_mm, other.depth_rms_mm);
    append(depth_off, other.depth_off);
    append(depth_missing, other.depth_missing);
    append(palm_error_mm, other.palm_error_mm);
    statistics = other.statistics;
}

GestureSettings gestures_of(const TrialOptions& options) {
    if (options.gestures) {
        return *options.gestures;
    }
    return options.use_rig ? GestureSettings{} : without_millimetres({});
}

Result<TrialResult> run_trial(const TrialOptions& options, const TrialSetup& setup) {
    auto settings = SimSettings::preset(options.preset);
    if (!settings) {
        return settings.error();
    }
    if (options.seed != 0) {
        settings->vary(options.seed);
    }
    if (!options.method.empty()) {
        if (auto shown = show_method(options.method, gestures_of(options), *settings); !shown) {
            return shown.error();
        }
    }
    if (options.arrange) {
        options.arrange(*settings);
    }
    auto rig = SimulatedRig::create(*settings);
    if (!rig) {
        return rig.error();
    }
    SimulatedRig& sim = **rig;
    TrialResult result;
    result.labels = options.labels;
    for (const SimLabel& label : sim.labels()) {
        result.labels.push_back(label_of(label));
    }
    const Duration length = sim.duration();

    SessionOptions session_options;
    session_options.pace = options.pace;
    session_options.use_rig = options.use_rig;
    session_options.gestures = gestures_of(options);
    auto session = Session::create(std::unique_ptr<FrameSource>(std::move(*rig)), session_options);
    if (!session) {
        return session.error();
    }
    std::vector<GestureEvent> events;
    session->subscribe([&events](const GestureEvent& event) { events.push_back(event); });
    TruthMeter meter(sim, result);
    if (options.measure_depth && session->metric() && options.pace == Pace::replay) {
        session->subscribe_pipeline([&meter](const PipelineView& view) { meter.see(view); });
    }
    if (setup) {
        setup(*session, sim);
    }
    if (const auto ran = session->run(); !ran) {
        return ran.error();
    }
    GestureScorer scorer(session_options.gestures);
    result.events = scorer.add(events, result.labels, length);
    result.score = scorer.all();
    result.gestures = scorer.gestures();
    result.statistics = session->statistics();
    return result;
}

}  // namespace xtrack::tools
