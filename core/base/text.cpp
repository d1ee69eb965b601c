// SPDX-License-Identifier: Apache-2.0
#include "core/base/text.hpp"

#include <array>
#include <charconv>
#include <cmath>

namespace xtrack::base {

namespace {

constexpr std::size_t kMaxQuoted = 40;

// from_chars takes no plus sign, people write one.
std::string_view without_plus(std::string_view text) noexcept {
    const bool plus = text.size() > 1 && text[0] == '+' && text[1] != '-';
    return plus ? text.substr(1) : text;
}

template <typename T>
std::optional<T> parse(std::string_view text) noexcept {
    text = without_plus(text);
    T value{};
    const char* end = text.data() + text.size();
    const auto [stopped, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc{} || stopped != end) {
        return std::nullopt;
    }
    return value;
}

}  // namespace

std::string_view trimmed(std::string_view text) noexcept {
    constexpr std::string_view kBlank = " \t\r";
    const std::size_t first = text.find_first_not_of(kBlank);
    if (first == std::string_view::npos) {
        return {};
    }
    return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

std::optional<std::int64_t> parse_int(std::string_view text) noexcept {
    return parse<std::int64_t>(text);
}

std::optional<double> parse_double(std::string_view text) noexcept {
    const auto value = parse<double>(text);
    return value && std::isfinite(*value) ? value : std::nullopt;
}

std::string quoted(std::string_view text) {
    std::string out = "'";
    for (const char c : text.substr(0, kMaxQuoted)) {
        out += static_cast<unsigned char>(c) < 0x20U || c == 0x7F ? '?' : c;
    }
    out += text.size() > kMaxQuoted ? "...'" : "'";
    return out;
}

std::string number_text(double value) {
    std::array<char, 32> buffer{};
    const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
    return error == std::errc{} ? std::string(buffer.data(), end) : std::string("nan");
}

void append_fixed(std::string& out, float value, int digits) {
    std::array<char, 64> buffer{};
    const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(),
                                   static_cast<double>(value), std::chars_format::fixed, digits);
    std::string_view text{buffer.data(), static_cast<std::size_t>(end.ptr - buffer.data())};
    if (text.front() == '-' && text.find_first_not_of("-0.") == std::string_view::npos) {
        text.remove_prefix(1);
    }
    out += text;
}

}  // namespace xtrack::base
