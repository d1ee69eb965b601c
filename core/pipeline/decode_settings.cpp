// SPDX-License-Identifier: Apache-2.0
#include <xtrack/decode_settings.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <type_traits>

#include <xtrack/image.hpp>

#include "core/base/text.hpp"

namespace xtrack {
namespace {

constexpr std::array<const char*, 2> kSwitch{"off", "on"};
constexpr std::array<const char*, 5> kTaps{"automatic", "least_squares", "three_plus_one",
                                           "three_plus_two", "four_plus_one"};
constexpr std::array<const char*, 3> kOrders{"automatic", "depth_image", "none"};
constexpr std::array<const char*, 3> kMotions{"off", "mask", "follow"};
constexpr std::array<const char*, 3> kModes{"default", "burst", "hold"};

// One way to read and write every type of field.
template <auto kMember>
double get(const DecodeSettings& settings) {
    return static_cast<double>(settings.*kMember);
}
template <auto kMember>
void set(DecodeSettings& settings, double value) {
    using Value = std::remove_reference_t<decltype(settings.*kMember)>;
    if constexpr (std::is_same_v<Value, double>) {
        settings.*kMember = value;
    } else {
        settings.*kMember = static_cast<Value>(static_cast<int>(value));
    }
}

template <auto kMember>
constexpr DecodeField number(FieldUse use, const char* name, const char* unit, double least,
                             double most, const char* summary) {
    return {name, unit, summary, least, most, false, {}, get<kMember>, set<kMember>, use};
}
template <auto kMember>
constexpr DecodeField whole(FieldUse use, const char* name, const char* unit, double least,
                            double most, const char* summary) {
    return {name, unit, summary, least, most, true, {}, get<kMember>, set<kMember>, use};
}
template <auto kMember>
constexpr DecodeField choice(FieldUse use, const char* name, std::span<const char* const> choices,
                             const char* summary) {
    const auto most = static_cast<double>(choices.size() - 1);
    return {name, "", summary, 0.0, most, true, choices, get<kMember>, set<kMember>, use};
}

using S = DecodeSettings;
constexpr auto kBoth = FieldUse::both;
constexpr auto kPattern = FieldUse::pattern;
constexpr auto kPaper = FieldUse::paper;
constexpr auto kPhases = FieldUse::phases;
constexpr std::array<DecodeField, 17> kFields{{
    number<&S::min_modulation>(kBoth, "min_modulation", "grey levels", 0.0, 127.0,
                               "pixels of less fringe amplitude are masked"),
    choice<&S::mask_saturated>(kBoth, "mask_saturated", kSwitch, "mask pixels that reach 255"),
    choice<&S::taps>(kPattern, "taps", kTaps, "how images of one period become a phase"),
    choice<&S::order>(kPattern, "order", kOrders, "where the fringe order comes from"),
    number<&S::order_tolerance>(kPattern, "order_tolerance", "periods", 0.05, 0.5,
                                "pixels whose order is less sure are masked"),
    number<&S::gray_edge_guard>(kPattern, "gray_edge_guard", "of white - black", 0.0, 0.45,
                                "Gray code bits nearer to their threshold are masked"),
    choice<&S::motion>(kBoth, "motion", kMotions, "what is done about things that move"),
    number<&S::motion_tolerance>(kPhases, "motion_tolerance", "amplitudes", 0.05, 10.0,
                                 "pixels that change by more between two cycles are masked"),
    whole<&S::max_motion_px>(kPhases, "max_motion_px", "px", 8.0, 400.0,
                             "largest move within a cycle"),
    number<&S::read_noise_levels>(kPattern, "read_noise_levels", "grey levels", 0.0, 20.0,
                                  "the camera's noise in the dark, rms"),
    number<&S::electrons_per_level>(kPattern, "electrons_per_level", "electrons", 1.0, 1e5,
                                    "light that makes one grey level"),
    choice<&S::keep_maps>(kBoth, "keep_maps", kSwitch, "keep phase, modulation and the like"),
    whole<&S::threads>(kPhases, "threads", "", 1.0, 16.0,
                       "threads that share the rows of an image"),
    choice<&S::mode>(kPaper, "mode", kModes, "which images a decode is made of"),
    number<&S::step_limit_rad>(kPaper, "step_limit_rad", "rad", 0.1, 3.1,
                               "steeper steps between neighbours part surfaces"),
    number<&S::min_support>(kPaper, "min_support", "of their contact", 0.0, 1.0,
                            "surfaces that agree along less are not joined"),
    whole<&S::min_component_px>(kPaper, "min_component_px", "px", 1.0,
                                static_cast<double>(kMaxImagePixels),
                                "surfaces of fewer pixels are masked"),
}};

std::string what_it_takes(const DecodeField& field) {
    if (field.choices.empty()) {
        return std::string(field.whole ? "a whole number" : "a number") + " from " +
               base::number_text(field.least) + " to " + base::number_text(field.most) +
               (*field.unit == '\0' ? "" : std::string(", ") + field.unit);
    }
    std::string names;
    for (const char* name : field.choices) {
        names += (names.empty() ? "" : ", ") + std::string(name);
    }
    return "one of " + names;
}

bool allowed(const DecodeField& field, double value) {
    // False for NaN.
    return value >= field.least && value <= field.most &&
           (!field.whole || value == std::floor(value));
}

Error refusal(const DecodeField& field, std::string_view value) {
    return Error{ErrorCode::invalid_argument, "decode settings: " + std::string(field.name) +
                                                  " is " + std::string(value) + ", must be " +
                                                  what_it_takes(field)};
}

}  // namespace

std::span<const DecodeField> decode_fields() noexcept { return kFields; }

std::string text_of(const DecodeField& field, const DecodeSettings& settings) {
    const double value = field.get(settings);
    if (field.choices.empty() || !allowed(field, value)) {
        return base::number_text(value);
    }
    return field.choices[static_cast<std::size_t>(value)];
}

Result<void> set_field(DecodeSettings& settings, std::string_view name, std::string_view text) {
    const auto* field = std::find_if(kFields.begin(), kFields.end(),
                                     [&](const DecodeField& one) { return name == one.name; });
    if (field == kFields.end()) {
        std::string names;
        for (const DecodeField& one : kFields) {
            names += (names.empty() ? "" : ", ") + std::string(one.name);
        }
        return Error{ErrorCode::invalid_argument, "decode settings: " + base::quoted(name) +
                                                      " is none of them; they are " + names};
    }
    double value = 0.0;
    bool read = false;
    for (std::size_t n = 0; n < field->choices.size(); ++n) {
        if (text == field->choices[n]) {
            value = static_cast<double>(n);
            read = true;
        }
    }
    if (field->choices.empty()) {
        const std::optional<double> number = base::parse_double(text);
        read = number.has_value();
        value = number.value_or(0.0);
    }
    if (!read || !allowed(*field, value)) {
        return refusal(*field, base::quoted(text));
    }
    field->set(settings, value);
    return {};
}

Result<void> validate(const DecodeSettings& settings) {
    for (const DecodeField& field : kFields) {
        if (!allowed(field, field.get(settings))) {
            return refusal(field, base::number_text(field.get(settings)));
        }
    }
    return {};
}

}  // namespace xtrack
