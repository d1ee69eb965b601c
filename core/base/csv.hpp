// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <xtrack/result.hpp>
#include <xtrack/stamp.hpp>

namespace xtrack::base {

/// What a CSV text may grow to. Lines past the bounds are an Error, never read in part.
struct CsvLimits {
    std::size_t line_bytes = 8192;
    std::size_t rows = 1'000'000;
    std::size_t columns = 256;
};

/// Walks a CSV text that has a header line: columns are found by name, in any order, and unknown
/// ones are passed over. Fields hold no quotes and no commas; blank lines are skipped. Every
/// message names file, line, field and mend.
/// @ownership borrows the text; views that it hands out point into it
class CsvReader {
 public:
    /// @param name of the file, for messages
    /// @return an Error if there is no header, a column comes twice, or the header is too long
    [[nodiscard]] static Result<CsvReader> open(std::string_view text, std::string name,
                                                const CsvLimits& limits = {});

    /// The index of a column, or nothing.
    [[nodiscard]] std::optional<std::size_t> column(std::string_view name) const noexcept;
    /// The same, or an Error that says which column is missing.
    [[nodiscard]] Result<std::size_t> required_column(std::string_view name) const;

    /// Goes to the next row. @return false at the end of the text; an Error where its fields are
    /// not
    ///         as many as the header's: a torn row must not pass for one with empty fields
    [[nodiscard]] Result<bool> next();

    /// A field of the present row without blanks around it; empty before the first row.
    [[nodiscard]] std::string_view field(std::size_t column) const noexcept;
    [[nodiscard]] Result<std::int64_t> int_field(std::size_t column, std::int64_t low,
                                                 std::int64_t high) const;
    [[nodiscard]] Result<double> number_field(std::size_t column, double low, double high) const;
    /// Microseconds, at most a century from zero: far below what overflows once it is counted in
    /// nanoseconds. @return an Error also where it is before `last`
    [[nodiscard]] Result<Stamp> stamp_field(std::size_t column, std::optional<Stamp> last) const;

    /// "frames.csv line 7: pattern is '9'; <mend>"
    [[nodiscard]] Error error_at(std::size_t column, std::string_view mend) const;
    /// "frames.csv line 7: <what>"
    [[nodiscard]] Error error(std::string_view what) const;

    [[nodiscard]] std::size_t line() const noexcept { return line_; }
    [[nodiscard]] const std::vector<std::string_view>& header() const noexcept { return header_; }

 private:
    [[nodiscard]] bool take_line(std::string_view& line) noexcept;
    void split(std::string_view line, std::vector<std::string_view>& fields) const;

    std::string name_;
    std::string_view rest_;
    CsvLimits limits_;
    std::vector<std::string_view> header_;
    std::vector<std::string_view> fields_;
    std::size_t line_ = 0;
    std::size_t rows_ = 0;
};

}  // namespace xtrack::base
