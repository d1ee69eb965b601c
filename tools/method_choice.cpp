// SPDX-License-Identifier: Apache-2.0
#include "tools/method_choice.hpp"

#include <utility>

#include "tools/light_source.hpp"

namespace xtrack::tools {

namespace {

std::string known_methods() {
    std::string names = "auto";
    for (const MethodInfo& one : methods()) {
        names += std::string(", ") + one.name;
    }
    return names;
}

}  // namespace

bool is_simulator(const std::string& source) {
    return source == "sim" || source.starts_with("sim:");
}

Result<SimSettings> preset_of(const std::string& source) {
    if (source == "sim") {
        return SimSettings::preset("ideal-60");
    }
    constexpr std::string_view kPrefix = "sim:";
    if (source.starts_with(kPrefix)) {
        return SimSettings::preset(source.substr(kPrefix.size()));
    }
    return Error{ErrorCode::invalid_argument,
                 source + ": only the simulator can be asked; use sim or sim:PRESET"};
}

MethodNeeds needs_of(const SimSettings& settings, const GestureSettings& gestures) {
    const GestureDemands demands = demands_of(gestures);
    MethodNeeds needs;
    needs.colour = settings.camera.colour;
    needs.frame_hz = settings.camera.frame_hz;
    needs.hold_frames = settings.clocks.locked ? 1 : settings.clocks.hold_frames;
    // Swipes and pushes can do without mm, but are found far less surely: only on request.
    needs.metric = true;
    needs.hand_mmps = demands.hand_mmps;
    return needs;
}

std::string test_colours_of(const SimSettings& settings, MethodNeeds& needs) {
    if (!needs.colour) {
        return {};
    }
    const auto found = light_of_simulation(settings);
    if (!found || !found->light.colour) {
        needs.colour_works = false;
        return "failed, " + (found ? "the camera gave no colours" : found.error().message);
    }
    needs.colour_works = works_as_shown(*found->light.colour);
    return (found->light.colour->passed ? "passed, " : "failed, ") + found->light.colour->reason;
}

Result<ShownMethod> show_method(const std::string& name, const GestureSettings& gestures,
                                SimSettings& settings) {
    MethodNeeds needs = needs_of(settings, gestures);
    MethodVerdict verdict;
    std::string colours;
    if (name == "auto") {
        colours = test_colours_of(settings, needs);
        auto chosen = choose_method(needs);
        if (!chosen) {
            return chosen.error();
        }
        verdict = *chosen;
    } else {
        const auto method = method_of(name);
        if (!method) {
            return Error{ErrorCode::invalid_argument,
                         "--method " + name + ": not a method; choose from " + known_methods()};
        }
        needs.metric = demands_of(gestures).metric;
        const bool wants_colour = info(*method).colour && !settings.camera.colour;
        if (wants_colour) {
            needs.colour = settings.camera.colour = settings.camera.chroma_422 = true;
        }
        verdict = judge(*method, needs);
        verdict.reason += wants_colour ? "; the simulated camera sees colour for it" : "";
        if (!verdict.possible) {
            return Error{ErrorCode::unsupported, "--method " + name + ": " + verdict.reason +
                                                     "; xtrack methods lists what carries them"};
        }
    }
    auto sequence = method_sequence(verdict.method, settings.rig, settings.patterns.axis);
    if (!sequence) {
        return sequence.error();
    }
    const auto gamma = settings.patterns.gamma;
    settings.patterns = *std::move(sequence);
    settings.patterns.gamma = gamma;
    return ShownMethod{std::move(verdict), std::move(colours)};
}

}  // namespace xtrack::tools
