// SPDX-License-Identifier: Apache-2.0
#include "tools/bench/motion/sweep.hpp"

#include <algorithm>
#include <utility>

namespace xtrack::tools::bench {

namespace {

// Methods that want the same images: they are simulated once.
using Group = std::vector<MotionMethod>;

Result<std::vector<Group>> groups_of(const std::vector<std::string>& only) {
    auto methods = motion_methods(motion_rig());
    if (!methods) {
        return methods.error();
    }
    std::vector<Group> groups;
    for (MotionMethod& method : *methods) {
        if (!only.empty() && std::find(only.begin(), only.end(), method.name) == only.end()) {
            continue;
        }
        if (groups.empty() || !(groups.back().front().patterns == method.patterns)) {
            groups.emplace_back();
        }
        groups.back().push_back(std::move(method));
    }
    return groups;
}

// A method that the decoder refuses keeps its reason and no figures; nothing is rendered for it.
std::string refusal_of(const MotionMethod& method, const Rig& rig) {
    const auto decoder = MotionDecoder::create(rig, method.patterns, method.settings);
    return decoder ? std::string() : decoder.error().message;
}

// One stroke each way; toward the camera, two that differ in noise and sway.
Result<std::vector<HandAccuracy>> measure_group(MotionCamera camera, const Group& group,
                                                const Vec3f& velocity_mmps, bool turn) {
    std::vector<HandAccuracy> sums(group.size());
    for (const std::uint64_t seed : {1U, 2U}) {
        const Vec3f velocity = turn && seed == 2 ? Vec3f(-velocity_mmps) : velocity_mmps;
        const auto stroke =
            simulate_stroke(camera, group.front().patterns, group.front().colour, velocity, seed);
        if (!stroke) {
            return stroke.error();
        }
        for (std::size_t m = 0; m < group.size(); ++m) {
            const auto hand = measure_stroke(*stroke, group[m].patterns, group[m].settings);
            if (!hand) {
                return hand.error();
            }
            sums[m].add(*hand);
        }
    }
    return sums;
}

// The decoder's rig of a method, without a stroke.
Rig rig_for(const MotionMethod& method) {
    Rig rig = motion_rig();
    if (method.colour) {
        rig.camera_from_projector_rgb = motion_crosstalk();
    }
    return rig;
}

// Takes those out that the decoder refuses. @return their reasons, in the order of the group
std::vector<std::string> drop_refused(Group& group) {
    std::vector<std::string> reasons;
    Group taken;
    for (MotionMethod& method : group) {
        reasons.push_back(refusal_of(method, rig_for(method)));
        if (reasons.back().empty()) {
            taken.push_back(std::move(method));
        }
    }
    group = std::move(taken);
    return reasons;
}

}  // namespace

bool works(const HandAccuracy& hand) noexcept {
    return hand.pixels > 0 && hand.off_percent() <= kWorksOff_percent &&
           hand.missing_percent() <= kWorksMissing_percent;
}

Result<std::size_t> sequence_count(const std::vector<std::string>& only) {
    const auto groups = groups_of(only);
    if (!groups) {
        return groups.error();
    }
    return groups->size();
}

Result<std::vector<MethodReport>> sweep_speeds(const std::vector<std::string>& only,
                                               const std::function<void()>& step) {
    auto groups = groups_of(only);
    if (!groups) {
        return groups.error();
    }
    const auto hz = static_cast<float>(frames_per_second(MotionCamera::ideal_60));
    std::vector<MethodReport> reports;
    for (Group& group : *groups) {
        const std::size_t first = reports.size();
        for (const MotionMethod& method : group) {
            reports.push_back({method, {}, {}, {}});
        }
        const std::vector<std::string> reasons = drop_refused(group);
        std::vector<MethodReport*> taken;
        for (std::size_t m = 0; m < reasons.size(); ++m) {
            reports[first + m].not_decoded = reasons[m];
            if (reasons[m].empty()) {
                taken.push_back(&reports[first + m]);
            }
        }
        for (std::size_t i = 0; i < kSpeedSteps; ++i, step()) {
            if (group.empty()) {
                continue;
            }
            const bool toward = i >= kSideways_mm.size();
            const std::size_t at = toward ? i - kSideways_mm.size() : i;
            const Vec3f move_mm = toward ? Vec3f(0.0F, 0.0F, static_cast<float>(-kToward_mm[at]))
                                         : Vec3f(static_cast<float>(kSideways_mm[at]), 0.0F, 0.0F);
            const auto hands = measure_group(MotionCamera::ideal_60, group, move_mm * hz, !toward);
            if (!hands) {
                return hands.error();
            }
            for (std::size_t m = 0; m < taken.size(); ++m) {
                (toward ? taken[m]->toward[at] : taken[m]->sideways[at]) = (*hands)[m];
            }
        }
    }
    return reports;
}

Result<std::vector<FastestReport>> find_fastest(const std::vector<std::string>& only,
                                                const std::function<void()>& step) {
    std::vector<FastestReport> reports;
    for (const MotionCamera camera : kMotionCameras) {
        auto groups = groups_of(only);
        if (!groups) {
            return groups.error();
        }
        for (Group& group : *groups) {
            const std::size_t first = reports.size();
            for (const MotionMethod& method : group) {
                reports.push_back({camera, std::string(method.name), {}, 0.0, {}});
            }
            const std::vector<std::string> reasons = drop_refused(group);
            std::vector<std::size_t> climbing;  // reports of those that still work
            for (std::size_t m = 0; m < reasons.size(); ++m) {
                reports[first + m].not_decoded = reasons[m];
                if (reasons[m].empty()) {
                    climbing.push_back(first + m);
                }
            }
            for (const double speed_mps : kLadder_mps) {
                if (group.empty()) {
                    break;
                }
                const Vec3f velocity(static_cast<float>(1e3 * speed_mps), 0.0F, 0.0F);
                const auto hands = measure_group(camera, group, velocity, true);
                if (!hands) {
                    return hands.error();
                }
                Group working;
                std::vector<std::size_t> higher;
                for (std::size_t m = 0; m < group.size(); ++m) {
                    if (works((*hands)[m])) {
                        reports[climbing[m]].speed_mps = speed_mps;
                        reports[climbing[m]].there = (*hands)[m];
                        higher.push_back(climbing[m]);
                        working.push_back(std::move(group[m]));
                    }
                }
                group = std::move(working);
                climbing = std::move(higher);
            }
            step();
        }
    }
    return reports;
}

}  // namespace xtrack::tools::bench
