// SPDX-License-Identifier: Apache-2.0
#include "tools/settings_option.hpp"

#include <string_view>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

namespace xtrack::tools {

namespace {

// What a command decides itself: the order is its business, and nobody would see the maps.
bool is_offered(const DecodeField& field) {
    const std::string_view name = field.name;
    return name != "order" && name != "keep_maps";
}

std::string range_of(const DecodeField& field) {
    if (field.choices.empty()) {
        return fmt::format("{:g} to {:g}{}{}", field.least, field.most,
                           *field.unit == '\0' ? "" : " ", field.unit);
    }
    std::string names;
    for (const char* name : field.choices) {
        names += (names.empty() ? "" : ", ") + std::string(name);
    }
    return names;
}

std::string all_settings() {
    std::string text = "Changes a setting of the decoder:";
    for (const DecodeField& field : decode_fields()) {
        if (!is_offered(field)) {
            continue;
        }
        text += fmt::format("\n{}: {}{} ({}; else {})", field.name,
                            field.use == FieldUse::paper ? "unwrapping in space: " : "",
                            field.summary, range_of(field), text_of(field, DecodeSettings{}));
    }
    return text;
}

}  // namespace

void add_settings_option(CLI::App& command, std::vector<std::string>& changes) {
    command.add_option("--set", changes, all_settings())
        ->type_name("NAME=VALUE")
        ->allow_extra_args(false);
}

Result<void> apply_settings(const std::vector<std::string>& changes, DecodeSettings& settings) {
    for (const std::string& change : changes) {
        const std::size_t equals = change.find('=');
        if (equals == std::string::npos) {
            return Error{ErrorCode::invalid_argument,
                         "--set " + change + ": give NAME=VALUE, such as min_modulation=8"};
        }
        if (auto set = set_field(settings, std::string_view(change).substr(0, equals),
                                 std::string_view(change).substr(equals + 1));
            !set) {
            return Error{set.error().code, "--set: " + set.error().message};
        }
    }
    return {};
}

Result<void> check_settings(const std::vector<std::string>& changes, DecodeMethod method) {
    const auto refuse = [](const std::string& change, const char* why) {
        return Error{ErrorCode::invalid_argument, "--set " + change + ": " + why};
    };
    for (const std::string& change : changes) {
        const std::string name = change.substr(0, change.find('='));
        for (const DecodeField& field : decode_fields()) {
            if (name != field.name) {
                continue;
            }
            if (!is_offered(field)) {
                return refuse(change, "is what the command decides itself; leave it out");
            }
            if (method == DecodeMethod::automatic) {
                return refuse(change, "the source has no fringes to decode; leave it out");
            }
            if (method == DecodeMethod::pattern && field.use == FieldUse::paper) {
                return refuse(change,
                              "is for fringes that are unwrapped in space; leave it out, or let "
                              "run or replay unwrap so with --mode default");
            }
            if (method == DecodeMethod::paper && field.use == FieldUse::pattern) {
                return refuse(change,
                              "means nothing where fringes are unwrapped in space, as without a "
                              "rig or with --mode; leave it out");
            }
        }
    }
    return {};
}

}  // namespace xtrack::tools
