// SPDX-License-Identifier: Apache-2.0
#include "tools/light_report.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace xtrack::tools {

namespace {

constexpr std::array<const char*, 3> kColours{"red", "green", "blue"};

// Of curves: full lights that are lost where the nearest power is taken instead.
double worst_by_power(const MeasuredResponse& measured) {
    double worst = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
        const std::vector<double>& light = measured.response.light[k];
        for (std::size_t i = 0; i < light.size(); ++i) {
            const double value = static_cast<double>(i) / static_cast<double>(light.size() - 1);
            worst = std::max(worst, std::fabs(light[i] - std::pow(value, measured.gamma[k])));
        }
    }
    return worst;
}

std::string response_text(const MeasuredResponse& measured) {
    const auto& gamma = measured.gamma;
    const auto& light = measured.response.light;
    const bool one = light[0] == light[1] && light[0] == light[2];
    return fmt::format(
        "projector: {}, to {:.1f} % of full light; {} levels, single pixels spread by {:.1f} %, "
        "{} pixels\n",
        one ? fmt::format("gamma {:.2f}", gamma[0])
            : fmt::format("gamma {:.2f} red, {:.2f} green, {:.2f} blue", gamma[0], gamma[1],
                          gamma[2]),
        100.0 * worst_by_power(measured), light[0].size(), 100.0 * measured.spread,
        measured.pixels);
}

std::string colour_text(const ColourSelfTest& test) {
    std::string text =
        fmt::format("colours: {}, {}", test.passed ? "passed" : "failed", test.reason);
    if (test.passed && test.depth_error_mm) {
        text += fmt::format(", depth at a hand's distance to {:.1f} mm", *test.depth_error_mm);
    }
    text += fmt::format(
        "\n         condition {:.1f}, residual {:.1f} % of full light, gain changed by {:.1f} %, "
        "short fringes keep {:.0f} % of their contrast, {} pixels\n",
        test.condition, 100.0 * test.residual, 100.0 * test.gain_change, 100.0 * test.contrast,
        test.pixels);
    for (int row = 0; row < 3; ++row) {
        text += fmt::format(
            "         {:<21}{:7.3f} {:7.3f} {:7.3f}\n",
            fmt::format("camera {} from r g b", kColours[static_cast<std::size_t>(row)]),
            test.camera_from_projector_rgb(row, 0), test.camera_from_projector_rgb(row, 1),
            test.camera_from_projector_rgb(row, 2));
    }
    return text;
}

}  // namespace

std::string light_text(const LightCalibration& light) {
    std::string text;
    text += light.response ? response_text(*light.response)
                           : "projector: no ramp was shown; its response is taken as known\n";
    text += light.colour ? colour_text(*light.colour)
                         : "colours: not measured; that needs a colour camera and colour fringes\n";
    return text;
}

std::string light_json(const LightCalibration& light, const std::vector<std::string>& written) {
    using nlohmann::json;
    json out = {{"response", nullptr}, {"colour", nullptr}, {"written", written}};
    if (light.response) {
        const MeasuredResponse& measured = *light.response;
        out["response"] = {
            {"gamma", measured.gamma}, {"spread", measured.spread}, {"pixels", measured.pixels}};
        for (std::size_t k = 0; k < 3; ++k) {
            out["response"][kColours[k]] = measured.response.light[k];
        }
    }
    if (light.colour) {
        const ColourSelfTest& test = *light.colour;
        json rows = json::array();
        for (int row = 0; row < 3; ++row) {
            const auto& m = test.camera_from_projector_rgb;
            rows.push_back({m(row, 0), m(row, 1), m(row, 2)});
        }
        out["colour"] = {{"passed", test.passed},
                         {"reason", test.reason},
                         {"camera_from_projector_rgb", rows},
                         {"condition", test.condition},
                         {"residual", test.residual},
                         {"gain_change", test.gain_change},
                         {"contrast", test.contrast},
                         {"phase_error_rad", test.phase_error_rad},
                         {"bend_rad", test.bend_rad},
                         {"works_as_shown", works_as_shown(test)},
                         {"depth_error_mm", nullptr},
                         {"pixels", test.pixels}};
        if (test.depth_error_mm) {
            out["colour"]["depth_error_mm"] = *test.depth_error_mm;
        }
    }
    return out.dump(2) + "\n";
}

}  // namespace xtrack::tools
