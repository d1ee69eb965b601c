// SPDX-License-Identifier: Apache-2.0
#include "core/capture/frame_list.hpp"

#include <algorithm>
#include <optional>

#include "core/base/csv.hpp"
#include "core/base/file.hpp"

namespace xtrack::capture {

namespace {

constexpr base::CsvLimits kLimits{1024, 1'000'000, 32};
constexpr const char* kCleanBegin = "clean_begin";
constexpr const char* kCleanEnd = "clean_end";
constexpr std::int64_t kMaxSequence = std::int64_t{1} << 53U;

bool is_image_name(std::string_view file) {
    const std::size_t dot = file.rfind('.');
    if (dot == std::string_view::npos) {
        return false;
    }
    std::string extension(file.substr(dot + 1));
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
    return extension == "png" || extension == "jpg" || extension == "jpeg";
}

struct Columns {
    std::size_t file = 0;
    std::size_t t_us = 0;
    std::size_t sequence = 0;
    std::size_t pattern = 0;
    std::optional<std::size_t> clean_begin;  // both or neither
    std::optional<std::size_t> clean_end;
};

Result<Columns> find_columns(const base::CsvReader& csv, bool with_patterns) {
    Columns columns;
    struct Wanted {
        const char* name;
        std::size_t* column;
    };
    const Wanted wanted[] = {{"file", &columns.file},
                             {"t_us", &columns.t_us},
                             {"sequence", &columns.sequence},
                             {"pattern", &columns.pattern}};
    for (const Wanted& w : wanted) {
        if (w.column == &columns.pattern && !with_patterns) {
            break;
        }
        const auto found = csv.required_column(w.name);
        if (!found) {
            return found.error();
        }
        *w.column = *found;
    }
    columns.clean_begin = csv.column(kCleanBegin);
    columns.clean_end = csv.column(kCleanEnd);
    if (with_patterns && columns.clean_begin.has_value() != columns.clean_end.has_value()) {
        return csv.required_column(columns.clean_begin ? kCleanEnd : kCleanBegin).error();
    }
    return columns;
}

// Rows that saw the pattern and no other; both fields are empty where all did.
Result<void> read_clean_rows(const base::CsvReader& csv, const Columns& columns,
                             RecordingEntry& entry) {
    if (!columns.clean_begin || !columns.clean_end ||
        (csv.field(*columns.clean_begin).empty() && csv.field(*columns.clean_end).empty())) {
        return {};
    }
    const auto begin = csv.int_field(*columns.clean_begin, 0, kMaxImageSide_px - 1);
    if (!begin) {
        return begin.error();
    }
    const auto end = csv.int_field(*columns.clean_end, *begin + 1, kMaxImageSide_px);
    if (!end) {
        return end.error();
    }
    entry.clean_row_begin = static_cast<int>(*begin);
    entry.clean_row_end = static_cast<int>(*end);
    return {};
}

Result<RecordingEntry> read_entry(const base::CsvReader& csv, const Columns& columns,
                                  std::size_t patterns, std::optional<Stamp> last) {
    RecordingEntry entry;
    entry.file = std::string(csv.field(columns.file));
    if (!base::stays_inside(entry.file)) {
        return csv.error_at(columns.file, "name a file inside the recording");
    }
    if (!is_image_name(entry.file)) {
        return csv.error_at(columns.file, "name a png or jpg image");
    }
    const auto stamp = csv.stamp_field(columns.t_us, last);
    if (!stamp) {
        return stamp.error();
    }
    entry.stamp = *stamp;
    const auto sequence = csv.int_field(columns.sequence, 0, kMaxSequence);
    if (!sequence) {
        return sequence.error();
    }
    entry.sequence = static_cast<std::uint64_t>(*sequence);
    if (patterns != 0 && !csv.field(columns.pattern).empty()) {
        const auto pattern =
            csv.int_field(columns.pattern, 0, static_cast<std::int64_t>(patterns) - 1);
        if (!pattern) {
            return pattern.error();
        }
        entry.pattern = static_cast<int>(*pattern);
    }
    if (patterns != 0) {
        if (auto read = read_clean_rows(csv, columns, entry); !read) {
            return read.error();
        }
    }
    return entry;
}

}  // namespace

Result<std::vector<RecordingEntry>> parse_frame_list(std::string_view text, const std::string& name,
                                                     std::size_t patterns) {
    auto csv = base::CsvReader::open(text, name, kLimits);
    if (!csv) {
        return csv.error();
    }
    const auto columns = find_columns(*csv, patterns != 0);
    if (!columns) {
        return columns.error();
    }
    std::vector<RecordingEntry> entries;
    std::optional<Stamp> last;
    while (true) {
        const auto more = csv->next();
        if (!more) {
            return more.error();
        }
        if (!*more) {
            break;
        }
        auto entry = read_entry(*csv, *columns, patterns, last);
        if (!entry) {
            return entry.error();
        }
        last = entry->stamp;
        entries.push_back(std::move(*entry));
    }
    if (entries.empty()) {
        return Error{ErrorCode::malformed, name + ": lists no frame; record at least one"};
    }
    if (patterns != 0 && std::all_of(entries.begin(), entries.end(), [](const RecordingEntry& e) {
            return e.pattern == kUnknownPattern;
        })) {
        return Error{ErrorCode::malformed,
                     name +
                         ": pattern is empty in every row, and nothing could be decoded; give the "
                         "index into pattern.yaml's sequence where it is known"};
    }
    return entries;
}

std::string frame_list_head() {
    return std::string("file,t_us,sequence,pattern,") + kCleanBegin + "," + kCleanEnd + "\n";
}

std::string frame_list_line(const RecordingEntry& e) {
    const bool some = e.clean_row_end > 0;
    return e.file + "," + std::to_string(e.stamp.us()) + "," + std::to_string(e.sequence) + "," +
           (e.pattern == kUnknownPattern ? "" : std::to_string(e.pattern)) + "," +
           (some ? std::to_string(e.clean_row_begin) : "") + "," +
           (some ? std::to_string(e.clean_row_end) : "") + "\n";
}

std::string frame_list_text(const std::vector<RecordingEntry>& entries) {
    std::string text = frame_list_head();
    for (const RecordingEntry& entry : entries) {
        text += frame_list_line(entry);
    }
    return text;
}

}  // namespace xtrack::capture
