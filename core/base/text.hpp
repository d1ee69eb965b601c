// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace xtrack::base {

/// Without blanks, tabs and a carriage return at either end.
[[nodiscard]] std::string_view trimmed(std::string_view text) noexcept;

/// The whole text as a number, independent of the locale; nothing if any character is left over,
/// if it is out of range, and, for parse_double, if it is NaN or infinite.
[[nodiscard]] std::optional<std::int64_t> parse_int(std::string_view text) noexcept;
[[nodiscard]] std::optional<double> parse_double(std::string_view text) noexcept;

/// Outside text for a message: quoted, at most 40 characters, control characters as `?`.
[[nodiscard]] std::string quoted(std::string_view text);

/// The shortest decimal text that reads back as the same number.
[[nodiscard]] std::string number_text(double value);

/// With so many digits after a point, whatever the locale has in its place; "-0.0" would be a
/// difference of nothing. @param value finite
void append_fixed(std::string& out, float value, int digits);

}  // namespace xtrack::base
