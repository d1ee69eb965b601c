// SPDX-License-Identifier: Apache-2.0
#include "tools/settings_option.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "core/base/text.hpp"

namespace xtrack::tools {

namespace {

// The order is the command's business, and nobody would see the maps, of which sigma is one.
bool is_offered(const DecodeField& field) {
    constexpr std::array<std::string_view, 4> kNotOffered{"order", "keep_maps", "read_noise_levels",
                                                          "electrons_per_level"};
    return std::find(kNotOffered.begin(), kNotOffered.end(), field.name) == kNotOffered.end();
}

std::string range_of(const DecodeField& field) {
    if (field.choices.empty()) {
        return fmt::format("{} to {}{}{}", base::number_text(field.least),
                           base::number_text(field.most), *field.unit == '\0' ? "" : " ",
                           field.unit);
    }
    std::string names;
    for (const char* name : field.choices) {
        names += (names.empty() ? "" : ", ") + std::string(name);
    }
    return names;
}

std::string all_settings(const std::function<bool(const DecodeField&)>& uses) {
    std::string text = "Changes a setting of the decoder:";
    for (const DecodeField& field : decode_fields()) {
        if (!is_offered(field) || !uses(field)) {
            continue;
        }
        text += fmt::format("\n{}: {}{} ({}; else {})", field.name,
                            field.use == FieldUse::paper ? "unwrapping in space: " : "",
                            field.summary, range_of(field), text_of(field, DecodeSettings{}));
    }
    return text;
}

}  // namespace

void add_settings_option(CLI::App& command, std::vector<std::string>& changes,
                         const std::function<bool(const DecodeField&)>& uses) {
    command.add_option("--set", changes, all_settings(uses))
        ->type_name("NAME=VALUE")
        ->allow_extra_args(false);
}

namespace {

template <typename Settings>
Result<void> apply(const std::vector<std::string>& changes, const char* example,
                   Settings& settings) {
    for (const std::string& change : changes) {
        const std::size_t equals = change.find('=');
        if (equals == std::string::npos) {
            return Error{ErrorCode::invalid_argument,
                         base::quoted(change) + ": give NAME=VALUE, such as " + example};
        }
        if (auto set = set_field(settings, std::string_view(change).substr(0, equals),
                                 std::string_view(change).substr(equals + 1));
            !set) {
            return set;
        }
    }
    return {};
}

}  // namespace

Result<void> apply_settings(const std::vector<std::string>& changes, DecodeSettings& settings) {
    return apply(changes, "min_modulation=8", settings);
}

bool is_gesture_setting(const std::string& change) {
    const std::string name = change.substr(0, change.find('='));
    return std::ranges::any_of(gesture_fields(),
                               [&](const GestureField& field) { return name == field.name; });
}

void add_gesture_settings_option(CLI::App& command, std::vector<std::string>& changes) {
    std::string text = "Changes a setting of the gestures:";
    for (const GestureField& field : gesture_fields()) {
        if (!field.is_switch) {  // --gestures chooses
            text +=
                fmt::format("\n{} ({} to {}; else {})", field.name, base::number_text(field.least),
                            base::number_text(field.most), base::number_text(field.standard()));
        }
    }
    command.add_option("--set", changes, text)->type_name("NAME=VALUE")->allow_extra_args(false);
}

Result<void> apply_gesture_settings(const std::vector<std::string>& changes,
                                    GestureSettings& settings) {
    if (auto set = apply(changes, "swipe_speed_mmps=350", settings); !set) {
        return set;
    }
    return validate(settings);
}

Result<void> check_settings(const std::vector<std::string>& changes, DecodeMethod method,
                            const std::function<bool(const DecodeField&)>& uses) {
    const auto refuse = [](const std::string& change, const char* why) {
        return Error{ErrorCode::invalid_argument, base::quoted(change) + ": " + why};
    };
    for (const std::string& change : changes) {
        const std::string name = change.substr(0, change.find('='));
        for (const DecodeField& field : decode_fields()) {
            if (name != field.name) {
                continue;
            }
            if (!is_offered(field)) {
                return refuse(change,
                              "means nothing here; the command decides it, or nothing it "
                              "shows depends on it");
            }
            if (method == DecodeMethod::automatic) {
                return refuse(change, "means nothing here, the source has no fringes to decode");
            }
            if (uses(field)) {
                continue;
            }
            return refuse(change, method == DecodeMethod::paper
                                      ? "means nothing where fringes are unwrapped in space, as "
                                        "without a rig, with --mode, or of one pattern that never "
                                        "changes"
                                      : "is for fringes that are unwrapped in space, which run and "
                                        "replay do with --mode default");
        }
    }
    return {};
}

}  // namespace xtrack::tools
