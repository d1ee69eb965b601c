// SPDX-License-Identifier: Apache-2.0
#include "tools/corpus/images.hpp"

#include <algorithm>
#include <utility>

#include "core/sim/random.hpp"

namespace xtrack::tools::corpus {

namespace {

// Twice what the fastest rig's exposures can tell apart.
constexpr double kPosesHz = 240.0;

SimPath path_of(const Movement& m, double end_s) {
    SimPath path;
    path.hand = m.hand();
    const auto poses = static_cast<std::size_t>(end_s * kPosesHz);
    path.poses.reserve(poses + 1);
    for (std::size_t i = 0; i <= poses; ++i) {
        const double t = static_cast<double>(i) / kPosesHz;
        const sim::HandPose pose = m.at(t);
        path.poses.push_back({t, pose.palm_mm, pose.turn_rad, pose.fingers});
    }
    return path;
}

}  // namespace

Person before_a_rig(Person person) {
    constexpr float kNearestMm = 550.0F;
    constexpr float kFarthestMm = 780.0F;
    const double before_chest = person.chest_mm - person.home_mm.z();
    person.home_mm.z() = std::clamp(person.home_mm.z(), kNearestMm, kFarthestMm);
    person.chest_mm = person.home_mm.z() + before_chest;
    return person;
}

TrialOptions trial_of(const Sequence& sequence, const ImageRig& rig,
                      const GestureSettings& settings) {
    TrialOptions options;
    options.preset = rig.preset;
    options.method = rig.method;
    options.seed = sequence.seed;  // room, light, skin; the hand is the person's own
    options.gestures = settings;
    options.labels = sequence.labels;
    options.arrange = [&sequence](SimSettings& sim) {
        const Person& person = sequence.hands.front().person();
        sim.user.hand_length_mm = person.hand_length_mm;
        sim.user.hand_distance_mm = person.home_mm.z();
        sim.user.chest_distance_mm = std::clamp(person.chest_mm, 600.0, 2000.0);
        // Of all skins: vary() has those of the middle.
        sim.user.skin_albedo = sim::Random(sim::mix(person.seed, 81U)).between(0.15, 0.8);
        sim.room.wall_distance_mm =
            std::max(sim.room.wall_distance_mm, sim.user.chest_distance_mm + 250.0);
        for (const Movement& m : sequence.hands) {
            if (sim.paths.size() < kSimMaxHands) {
                sim.paths.push_back(path_of(m, sequence.end_s));
            }
        }
    };
    return options;
}

Result<Tally> run_images(const Sequence& sequence, const ImageRig& rig,
                         const GestureSettings& settings) {
    auto result = run_trial(trial_of(sequence, rig, settings));
    if (!result) {
        return result.error();
    }
    // Ids are the tracker's own; a hand is told by its side.
    const HandOf hand_of = [&sequence](const GestureEvent& event) -> std::size_t {
        for (std::size_t i = 0; i < sequence.hands.size(); ++i) {
            const bool right = sequence.hands[i].hand() == SimHand::right;
            if (right == (event.hand == Chirality::right)) {
                return i;
            }
        }
        return 0;
    };
    return tally_of(sequence, std::move(result->gestures), result->events, hand_of, {});
}

}  // namespace xtrack::tools::corpus
