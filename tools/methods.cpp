// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "tools/commands.hpp"
#include "tools/method_choice.hpp"
#include "tools/stream.hpp"

namespace xtrack::tools {

namespace {

struct MethodsOptions {
    std::string source = "sim";
    std::optional<std::string> gestures;
    bool static_only = false;
    bool relative = false;
    bool json = false;
};

void print_text(const MethodNeeds& needs, const std::string& colours,
                const Result<MethodVerdict>& chosen) {
    fmt::print("{} camera, {:g} images a second, each pattern held for {}\n",
               needs.colour ? "colour" : "grey", needs.frame_hz, needs.hold_frames);
    if (!colours.empty()) {
        fmt::print("colour self-test: {}\n", colours);
    }
    fmt::print("all of a hand of {:.2f} m/s must be seen{}\n\n",
               static_cast<double>(std::lround(needs.hand_mmps / 10.0)) / 100.0,
               needs.metric ? ", in mm" : "");
    fmt::print("{:<11}{:>7}  {:<8}{:<9}{}\n", "method", "images", "changes", "depth", "here");
    for (const MethodInfo& one : methods()) {
        const MethodVerdict verdict = judge(one.method, needs);
        fmt::print("{:<11}{:>7}  {:<8}{:<9}{}{}\n", one.name, one.images,
                   one.changes ? "yes" : "never", one.metric ? "mm" : "relative",
                   verdict.possible ? "" : "no: ", verdict.reason);
    }
    fmt::print(
        "\nThese speeds are for choosing, with a margin for any hand; xtrack bench --motion "
        "measures "
        "what still\nworks.\n");
    if (chosen) {
        fmt::print("\nauto: {}, {}\n", info(chosen->method).name, chosen->reason);
    } else {
        fmt::print("\nauto: {}\n", chosen.error().message);
    }
}

void print_json(const MethodNeeds& needs, const std::string& colours,
                const Result<MethodVerdict>& chosen) {
    using nlohmann::json;
    json out = {{"colour", needs.colour},           {"frame_hz", needs.frame_hz},
                {"hold_frames", needs.hold_frames}, {"hand_mmps", needs.hand_mmps},
                {"metric", needs.metric},           {"methods", json::array()}};
    out["colour_works"] = needs.colour_works ? json(*needs.colour_works) : json();
    out["colour_self_test"] = colours.empty() ? json() : json(colours);
    for (const MethodInfo& one : methods()) {
        const MethodVerdict verdict = judge(one.method, needs);
        out["methods"].push_back({{"name", one.name},
                                  {"summary", one.summary},
                                  {"colour", one.colour},
                                  {"changes", one.changes},
                                  {"metric", one.metric},
                                  {"images", one.images},
                                  {"hand_mmps", verdict.hand_mmps},
                                  {"possible", verdict.possible},
                                  {"reason", verdict.reason}});
    }
    out["auto"] = chosen ? json(info(chosen->method).name) : json();
    out["reason"] = chosen ? chosen->reason : chosen.error().message;
    fmt::print("{}\n", out.dump(2));
}

}  // namespace

void add_methods(CLI::App& app, int& exit_status) {
    auto* command = app.add_subcommand(
        "methods", "Which ways to project fringes carry which gestures on a camera, and why");
    const auto options = std::make_shared<MethodsOptions>();
    command->add_option("SOURCE", options->source, "sim, sim:ideal-60, sim:webcam-30")
        ->default_str("sim");
    command->add_option("--gestures", options->gestures, "Gestures that must work, as in run");
    command->add_flag("--static-only", options->static_only,
                      "Only patterns that never change, as a kiosk wants them");
    command->add_flag("--relative", options->relative, "Depth without mm will do");
    command->add_flag("--json", options->json, "For programs");
    command->callback([=, &exit_status] {
        GestureSettings gestures;
        if (const auto ok = choose_gestures(options->gestures, gestures); !ok) {
            exit_status = usage(ok.error());
            return;
        }
        const auto settings = preset_of(options->source);
        if (!settings) {
            exit_status = usage(settings.error());
            return;
        }
        MethodNeeds needs = needs_of(*settings, gestures);
        needs.static_only = options->static_only;
        needs.metric = !options->relative;
        const std::string colours = test_colours_of(*settings, needs);
        const auto chosen = choose_method(needs);
        options->json ? print_json(needs, colours, chosen) : print_text(needs, colours, chosen);
        exit_status = chosen ? 0 : 1;
    });
}

}  // namespace xtrack::tools
