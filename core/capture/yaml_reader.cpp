// SPDX-License-Identifier: Apache-2.0
#include "core/capture/yaml_reader.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include "core/capture/yaml_file.hpp"

namespace xtrack::capture {

namespace {

// The format nests three deep: a matrix inside a map inside the file.
constexpr int kMaxNesting = 16;
constexpr std::size_t kMaxIndent = 64;

Error bad_text(const std::string& name, int line, const std::string& what) {
    return {ErrorCode::malformed, name + " line " + std::to_string(line) + ": " + what};
}

// Blank up to its end, or a comment.
bool trimmed_line_is_empty(std::string_view rest) {
    const std::size_t first = rest.find_first_not_of(" \t\r");
    return first == std::string_view::npos || rest[first] == '\n' || rest[first] == '#';
}

// OpenCV 4.6 never comes back from some texts with a second document or with lists at the first
// column, so what a line may begin with is fixed: a key, a blank, a comment, the end of a bracket,
// or
// `---` before all of them.
bool may_begin_line(std::string_view rest, bool seen_content, int depth) {
    const char c = rest[0];
    if (rest.substr(0, 3) == "---") {
        return !seen_content;
    }
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == '#' || c == '\r' ||
           (c == ' ' && (seen_content || trimmed_line_is_empty(rest))) ||
           (depth > 0 && (c == ']' || c == '}'));
}

}  // namespace

Result<void> check_yaml_text(const std::string& text, const std::string& name) {
    if (text.size() > kMaxYamlBytes) {
        return Error{ErrorCode::malformed, name + ": is over " + std::to_string(kMaxYamlBytes) +
                                               " bytes long; keep the fields of the format"};
    }
    if (text.compare(0, 5, "%YAML") != 0) {
        return bad_text(name, 1, "does not begin with %YAML:1.0; add that line");
    }
    int line = 1;
    int depth = 0;
    std::size_t column = 0;
    std::size_t indent = 0;
    bool indenting = true;
    bool seen_content = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (column == 0 && line > 1 && c != '\n') {
            const std::string_view rest = std::string_view(text).substr(i);
            if (!may_begin_line(rest, seen_content, depth)) {
                return bad_text(name, line, "begins with no key; write one document of key: value");
            }
            seen_content = seen_content || (c != '-' && !trimmed_line_is_empty(rest));
        }
        if (c == '\n') {
            ++line;
            column = indent = 0;
            indenting = true;
            continue;
        }
        if (c == '\0') {
            return bad_text(name, line, "holds a NUL byte; save it as text");
        }
        // A list dash opens a level as a blank does, "- - - x" as well as by indentation.
        indenting = indenting && (c == ' ' || c == '-');
        indent += indenting ? 1U : 0U;
        depth += c == '[' || c == '{' ? 1 : 0;
        depth -= depth > 0 && (c == ']' || c == '}') ? 1 : 0;
        if (depth > kMaxNesting || (indent > kMaxIndent && column == indent - 1 && c == '-')) {
            return bad_text(name, line, "is nested too deep; keep the fields of the format");
        }
        if (indent > kMaxIndent) {
            return bad_text(name, line, "is indented too far; indent by three blanks");
        }
        ++column;
    }
    return {};
}

YamlMap::YamlMap(const cv::FileNode& node, std::string name, std::string prefix)
    : node_(node), name_(std::move(name)), prefix_(std::move(prefix)) {}

Error YamlMap::error(const char* key, const std::string& what) const {
    return {ErrorCode::malformed, name_ + ": " + prefix_ + key + " " + what};
}

bool YamlMap::has(const char* key) const { return !node_[key].empty(); }

Result<cv::FileNode> YamlMap::find(const char* key) const {
    const cv::FileNode found = node_[key];
    if (found.empty()) {
        return error(key, "is missing; add it");
    }
    return found;
}

Result<double> YamlMap::number(const char* key) const {
    auto found = find(key);
    if (!found) {
        return found.error();
    }
    if (!found->isInt() && !found->isReal()) {
        return error(key, "is not a number; give one");
    }
    const double value = found->real();
    if (!std::isfinite(value)) {
        return error(key, "is NaN or infinite; give a finite number");
    }
    return value;
}

Result<int> YamlMap::integer(const char* key) const {
    const auto value = number(key);
    if (!value) {
        return value.error();
    }
    if (*value != std::floor(*value) || std::abs(*value) > std::numeric_limits<int>::max()) {
        return error(key, "is not a whole number; give one");
    }
    return static_cast<int>(*value);
}

Result<bool> YamlMap::flag(const char* key) const {
    auto found = find(key);
    if (!found) {
        return found.error();
    }
    if (found->isString()) {
        const std::string text = found->string();
        if (text == "true" || text == "false") {
            return text == "true";
        }
    } else if (found->isInt() && (found->real() == 0.0 || found->real() == 1.0)) {
        return found->real() == 1.0;
    }
    return error(key, "is no truth value; give 0 or 1");
}

Result<std::string> YamlMap::word(const char* key) const {
    auto found = find(key);
    if (!found) {
        return found.error();
    }
    if (!found->isString()) {
        return error(key, "is not a word; give one");
    }
    return found->string();
}

Result<Size> YamlMap::size(const char* key) const {
    const auto sides = numbers(key, 2, 2);
    if (!sides) {
        return sides.error();
    }
    for (const double side : *sides) {
        if (side != std::floor(side) || side < 1.0 || side > kMaxImageSide_px) {
            return error(key, "is out of range; give [width, height], each from 1 to " +
                                  std::to_string(kMaxImageSide_px));
        }
    }
    return Size{static_cast<int>((*sides)[0]), static_cast<int>((*sides)[1])};
}

// Rows and columns are compared with what is there, never reserved for.
Result<void> YamlMap::check_matrix_head(const char* key, const cv::FileNode& matrix) const {
    for (const char* side : {"rows", "cols"}) {
        if (!matrix[side].isInt()) {
            return error(key, std::string("has no ") + side + "; save it as a matrix or a list");
        }
    }
    const double count = matrix["rows"].real() * matrix["cols"].real();
    if (matrix["rows"].real() < 0.0 || count != static_cast<double>(matrix["data"].size())) {
        return error(key, "has rows and cols that are not those of its data; make them agree");
    }
    const std::string dt = matrix["dt"].isString() ? matrix["dt"].string() : std::string();
    if (dt.size() != 1 || std::string_view("ucwsifdh").find(dt[0]) == std::string_view::npos) {
        return error(key, "has a dt that is not one channel of numbers; write dt: d");
    }
    return {};
}

Result<std::vector<double>> YamlMap::matrix(const char* key, int rows, int cols) const {
    const auto count = static_cast<std::size_t>(rows) * static_cast<std::size_t>(cols);
    auto values = numbers(key, count, count);
    const cv::FileNode node = node_[key];
    if (!values || !node.isMap()) {
        return values;
    }
    const int found = static_cast<int>(node["rows"].real());
    if (found != rows && !(cols == 1 && found == 1)) {
        return error(key, "has " + std::to_string(found) + " rows; give " + std::to_string(rows) +
                              " of " + std::to_string(cols));
    }
    return values;
}

Result<std::vector<double>> YamlMap::numbers(const char* key, std::size_t least,
                                             std::size_t most) const {
    auto found = find(key);
    if (!found) {
        return found.error();
    }
    const cv::FileNode list = found->isMap() ? (*found)["data"] : *found;
    if (found->isMap()) {
        if (auto ok = check_matrix_head(key, *found); !ok) {
            return ok.error();
        }
    }
    const std::string count = least == most ? std::to_string(most)
                                            : std::to_string(least) + " to " + std::to_string(most);
    if (!list.isSeq() || list.size() < least || list.size() > most) {
        return error(key, "does not hold " + count + " numbers; give them row by row");
    }
    std::vector<double> values;
    values.reserve(list.size());
    for (const cv::FileNode& entry : list) {
        if (!entry.isInt() && !entry.isReal()) {
            return error(key, "holds something that is not a number; give " + count + " numbers");
        }
        if (!std::isfinite(entry.real())) {
            return error(key, "holds NaN or infinity; give finite numbers");
        }
        values.push_back(entry.real());
    }
    return values;
}

Result<std::vector<YamlMap>> YamlMap::maps(const char* key, std::size_t most) const {
    auto found = find(key);
    if (!found) {
        return found.error();
    }
    if (!found->isSeq() || found->size() == 0 || found->size() > most) {
        return error(key, "is not a list of 1 to " + std::to_string(most) + " entries; give one");
    }
    std::vector<YamlMap> entries;
    entries.reserve(found->size());
    for (const cv::FileNode& entry : *found) {
        const std::string field = prefix_ + key + "[" + std::to_string(entries.size()) + "]";
        if (!entry.isMap()) {
            return Error{ErrorCode::malformed,
                         name_ + ": " + field + " is not { kind: ..., ... }; write it so"};
        }
        entries.emplace_back(entry, name_, field + ".");
    }
    return entries;
}

}  // namespace xtrack::capture
