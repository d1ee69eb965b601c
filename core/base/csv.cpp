// SPDX-License-Identifier: Apache-2.0
#include "core/base/csv.hpp"

#include <algorithm>

#include "core/base/text.hpp"

namespace xtrack::base {

namespace {

constexpr std::int64_t kMaxTime_us = std::int64_t{100} * 366 * 24 * 3600 * 1'000'000;
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

}  // namespace

Result<CsvReader> CsvReader::open(std::string_view text, std::string name,
                                  const CsvLimits& limits) {
    CsvReader csv;
    csv.name_ = std::move(name);
    csv.limits_ = limits;
    if (text.substr(0, kByteOrderMark.size()) == kByteOrderMark) {
        text.remove_prefix(kByteOrderMark.size());
    }
    csv.rest_ = text;
    std::string_view line;
    if (!csv.take_line(line)) {
        return Error{ErrorCode::malformed, csv.name_ + " is empty; its first line names columns"};
    }
    if (line.size() > limits.line_bytes) {
        return csv.error("header is over " + std::to_string(limits.line_bytes) +
                         " bytes long; give one line of column names");
    }
    csv.split(line, csv.header_);
    if (csv.header_.size() > limits.columns) {
        return csv.error("header has over " + std::to_string(limits.columns) +
                         " columns; remove the unknown ones");
    }
    for (std::size_t i = 0; i < csv.header_.size(); ++i) {
        const auto first = std::find(csv.header_.begin(), csv.header_.end(), csv.header_[i]);
        if (static_cast<std::size_t>(first - csv.header_.begin()) != i) {
            return csv.error("column " + quoted(csv.header_[i]) + " comes twice; remove one");
        }
    }
    return csv;
}

std::optional<std::size_t> CsvReader::column(std::string_view name) const noexcept {
    const auto found = std::find(header_.begin(), header_.end(), name);
    if (found == header_.end()) {
        return std::nullopt;
    }
    return static_cast<std::size_t>(found - header_.begin());
}

Result<std::size_t> CsvReader::required_column(std::string_view name) const {
    if (const auto index = column(name)) {
        return *index;
    }
    return Error{ErrorCode::malformed, name_ + " line 1: column " + quoted(name) +
                                           " is missing; add it to the header and every row"};
}

Result<bool> CsvReader::next() {
    std::string_view line;
    do {
        if (!take_line(line)) {
            return false;
        }
    } while (trimmed(line).empty());
    if (line.size() > limits_.line_bytes) {
        return error("is over " + std::to_string(limits_.line_bytes) + " bytes long; break it");
    }
    if (++rows_ > limits_.rows) {
        return error("comes after " + std::to_string(limits_.rows) + " rows; split the recording");
    }
    split(line, fields_);
    if (fields_.size() != header_.size()) {
        return error("has " + std::to_string(fields_.size()) + " fields, the header has " +
                     std::to_string(header_.size()) + "; make them agree");
    }
    return true;
}

std::string_view CsvReader::field(std::size_t column) const noexcept {
    return column < fields_.size() ? fields_[column] : std::string_view{};
}

Result<std::int64_t> CsvReader::int_field(std::size_t column, std::int64_t low,
                                          std::int64_t high) const {
    const auto value = parse_int(field(column));
    if (!value || *value < low || *value > high) {
        return error_at(column, "give a whole number from " + std::to_string(low) + " to " +
                                    std::to_string(high));
    }
    return *value;
}

Result<double> CsvReader::number_field(std::size_t column, double low, double high) const {
    const auto value = parse_double(field(column));
    if (!value || *value < low || *value > high) {
        return error_at(column,
                        "give a number from " + number_text(low) + " to " + number_text(high));
    }
    return *value;
}

Result<Stamp> CsvReader::stamp_field(std::size_t column, std::optional<Stamp> last) const {
    const auto us = int_field(column, -kMaxTime_us, kMaxTime_us);
    if (!us) {
        return us.error();
    }
    const Stamp stamp = Stamp::from_us(*us);
    if (last && stamp < *last) {
        return error_at(column,
                        "time goes backwards, sort the rows by " + std::string(header_[column]));
    }
    return stamp;
}

Error CsvReader::error_at(std::size_t column, std::string_view mend) const {
    const std::string_view text = field(column);
    return error(std::string(column < header_.size() ? header_[column] : "a field") + " is " +
                 (text.empty() ? "empty" : quoted(text)) + "; " + std::string(mend));
}

Error CsvReader::error(std::string_view what) const {
    return {ErrorCode::malformed,
            name_ + " line " + std::to_string(line_) + ": " + std::string(what)};
}

bool CsvReader::take_line(std::string_view& line) noexcept {
    if (rest_.empty()) {
        return false;
    }
    const std::size_t end = rest_.find('\n');
    line = rest_.substr(0, end);
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    ++line_;
    return true;
}

void CsvReader::split(std::string_view line, std::vector<std::string_view>& fields) const {
    fields.clear();
    // One more than allowed is enough to be refused: a line of commas must not cost memory.
    while (fields.size() <= limits_.columns) {
        const std::size_t comma = line.find(',');
        fields.push_back(trimmed(line.substr(0, comma)));
        if (comma == std::string_view::npos) {
            return;
        }
        line.remove_prefix(comma + 1);
    }
}

}  // namespace xtrack::base
