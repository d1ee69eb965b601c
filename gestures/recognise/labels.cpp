// SPDX-License-Identifier: Apache-2.0
#include <xtrack/labels.hpp>

#include <algorithm>
#include <array>
#include <iterator>

#include <xtrack/gesture_event.hpp>

#include "core/base/csv.hpp"
#include "core/base/file.hpp"
#include "core/base/text.hpp"

namespace xtrack {

namespace {

constexpr std::size_t kMaxFileBytes = std::size_t{64} << 20U;
constexpr base::CsvLimits kLimits{4096, 1'000'000, 128};
constexpr std::size_t kMaxNameLength = 64;
constexpr double kMaxPosition_mm = 1e5;
constexpr std::int64_t kMaxFrames = 1'000'000;
constexpr const char* kFingers[kFingerCount] = {"thumb", "index", "middle", "ring", "little"};

/// What a label may say: the name of any event. A bare `swipe` is one in any direction.
std::vector<std::string> known_gestures() {
    std::vector<std::string> names;
    for (std::size_t t = 0; t < kGestureTypeCount; ++t) {
        GestureEvent event;
        event.type = static_cast<GestureType>(t);
        if (event.type == GestureType::hand || event.type == GestureType::engage) {
            continue;
        }
        names.push_back(name_of(event));
        for (const Direction direction : directions_of(event.type)) {
            event.direction = direction;
            names.push_back(name_of(event));
        }
    }
    return names;
}
constexpr std::string_view kNotOurs = "x_";

bool is_word(std::string_view text) {
    return text.size() <= kMaxNameLength && std::all_of(text.begin(), text.end(), [](char c) {
               return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                      c == '_' || c == '-';
           });
}

/// A name that is misspelt would count as a gesture that nobody asked for, and its events as false.
bool is_gesture(std::string_view name) {
    static const std::vector<std::string> kKnown = known_gestures();
    return (name.starts_with(kNotOurs) && name.size() > kNotOurs.size() && is_word(name)) ||
           std::ranges::find(kKnown, name) != kKnown.end();
}

std::string gesture_wanted() {
    std::string names = "give ";
    for (const std::string& name : known_gestures()) {
        names += name + ", ";
    }
    return names + "or x_ and a name of your own";
}

constexpr const char* kHandWanted = "give left, right or unknown";

std::optional<Chirality> hand_of(std::string_view side) {
    for (const Chirality hand : {Chirality::left, Chirality::right, Chirality::unknown}) {
        if (side == to_string(hand)) {
            return hand;
        }
    }
    return std::nullopt;
}

Result<Chirality> read_hand(const base::CsvReader& csv, std::size_t column) {
    if (const auto hand = hand_of(csv.field(column))) {
        return *hand;
    }
    return csv.error_at(column, kHandWanted);
}

// Opens the text, finds `names` in its header, and calls `read` for every row.
template <typename T, std::size_t kCount, typename Read>
Result<std::vector<T>> read_rows(std::string_view text, const std::string& name,
                                 const char* const (&names)[kCount], const Read& read) {
    auto csv = base::CsvReader::open(text, name, kLimits);
    if (!csv) {
        return csv.error();
    }
    std::array<std::size_t, kCount> columns{};
    for (std::size_t i = 0; i < kCount; ++i) {
        const auto found = csv->required_column(names[i]);
        if (!found) {
            return found.error();
        }
        columns[i] = *found;
    }
    std::vector<T> rows;
    while (true) {
        const auto more = csv->next();
        if (!more) {
            return more.error();
        }
        if (!*more) {
            return rows;
        }
        auto row = read(*csv, columns);
        if (!row) {
            return row.error();
        }
        rows.push_back(std::move(*row));
    }
}

template <typename T>
Result<T> read_whole(const std::filesystem::path& file,
                     Result<T> (*parse)(std::string_view, const std::string&)) {
    const auto text = base::read_file(file, kMaxFileBytes);
    if (!text) {
        return text.error();
    }
    return parse(*text, file.string());
}

Result<TrackedPoint> read_point(const base::CsvReader& csv, const std::string& name) {
    TrackedPoint point;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
        const auto column = csv.column(name + "_" + "xyz"[axis]);
        if (!column || csv.field(*column).empty()) {
            return TrackedPoint{};
        }
        const auto value = csv.number_field(*column, -kMaxPosition_mm, kMaxPosition_mm);
        if (!value) {
            return value.error();
        }
        point.position_mm[axis] = static_cast<float>(*value);
    }
    point.valid = true;
    return point;
}

Result<GestureLabel> read_label(const base::CsvReader& csv,
                                const std::array<std::size_t, 4>& columns) {
    GestureLabel label;
    label.gesture = std::string(csv.field(columns[0]));
    if (!is_gesture(label.gesture)) {
        return csv.error_at(columns[0], gesture_wanted());
    }
    const auto hand = read_hand(csv, columns[1]);
    if (!hand) {
        return hand.error();
    }
    const auto start = csv.stamp_field(columns[2], std::nullopt);
    if (!start) {
        return start.error();
    }
    const auto end = csv.stamp_field(columns[3], std::nullopt);
    if (!end) {
        return end.error();
    }
    if (*end < *start) {
        return csv.error_at(columns[3], "it lies before start_us, swap them");
    }
    label.hand = *hand;
    label.start = *start;
    label.end = *end;
    const auto commit_column = csv.column("commit_us");
    if (commit_column && !csv.field(*commit_column).empty()) {
        const auto commit = csv.stamp_field(*commit_column, std::nullopt);
        if (!commit) {
            return commit.error();
        }
        label.commit = *commit;
    }
    return label;
}

Result<PoseLabel> read_pose(const base::CsvReader& csv, const std::array<std::size_t, 4>& columns) {
    PoseLabel label;
    const auto frame = csv.int_field(columns[0], 0, kMaxFrames);
    if (!frame) {
        return frame.error();
    }
    label.frame = static_cast<std::size_t>(*frame);
    label.pose = std::string(csv.field(columns[1]));
    if (!is_word(label.pose)) {
        return csv.error_at(columns[1], "give a name such as open_palm, or nothing");
    }
    if (!csv.field(columns[2]).empty()) {
        const auto fingers = csv.int_field(columns[2], 0, static_cast<int>(kFingerCount));
        if (!fingers) {
            return fingers.error();
        }
        label.extended_fingers = static_cast<int>(*fingers);
    }
    const auto present = csv.int_field(columns[3], 0, 1);
    if (!present) {
        return present.error();
    }
    label.hand_present = *present == 1;
    return label;
}

Result<HandTruth> read_truth_row(const base::CsvReader& csv,
                                 const std::array<std::size_t, 5>& columns,
                                 std::optional<Stamp> before) {
    HandTruth truth;
    const auto stamp = csv.stamp_field(columns[0], before);
    if (!stamp) {
        return stamp.error();
    }
    const auto hand = read_hand(csv, columns[1]);
    if (!hand) {
        return hand.error();
    }
    truth.stamp = *stamp;
    truth.hand = *hand;
    const auto palm = read_point(csv, "palm");
    if (!palm) {
        return palm.error();
    }
    truth.palm = *palm;
    for (std::size_t finger = 0; finger < kFingerCount; ++finger) {
        const std::string name = kFingers[finger];
        const auto tip = read_point(csv, name + "_tip");
        if (!tip) {
            return tip.error();
        }
        const auto pad = read_point(csv, name + "_pad");
        if (!pad) {
            return pad.error();
        }
        truth.tips[finger] = *tip;
        truth.pads[finger] = *pad;
    }
    const auto pinch_column = csv.column("pinch_mm");
    if (pinch_column && !csv.field(*pinch_column).empty()) {
        const auto pinch = csv.number_field(*pinch_column, 0.0, kMaxPosition_mm);
        if (!pinch) {
            return pinch.error();
        }
        truth.pinch_mm = static_cast<float>(*pinch);
    }
    return truth;
}

constexpr int kLengthDigits = 2;

std::string point_text(const TrackedPoint& point) {
    if (!point.valid) {
        return ",,,";
    }
    std::string text;
    for (const float coordinate_mm : point.position_mm) {
        text += ',';
        base::append_fixed(text, coordinate_mm, kLengthDigits);
    }
    return text;
}

}  // namespace

Result<std::vector<GestureLabel>> parse_labels(std::string_view text, const std::string& name) {
    return read_rows<GestureLabel>(text, name, {"gesture", "hand", "start_us", "end_us"},
                                   read_label);
}

Result<std::vector<PoseLabel>> parse_poses(std::string_view text, const std::string& name) {
    return read_rows<PoseLabel>(text, name, {"frame", "pose", "extended_fingers", "hand_present"},
                                read_pose);
}

Result<std::vector<HandTruth>> parse_hand_truth(std::string_view text, const std::string& name) {
    std::optional<Stamp> before;
    return read_rows<HandTruth>(
        text, name, {"t_us", "hand", "palm_x", "palm_y", "palm_z"},
        [&before](const base::CsvReader& csv,
                  const std::array<std::size_t, 5>& columns) -> Result<HandTruth> {
            auto truth = read_truth_row(csv, columns, before);
            if (truth) {
                before = truth->stamp;
            }
            return truth;
        });
}

Result<std::vector<GestureLabel>> read_labels(const std::filesystem::path& file) {
    return read_whole(file, &parse_labels);
}

Result<std::vector<PoseLabel>> read_poses(const std::filesystem::path& file) {
    return read_whole(file, &parse_poses);
}

Result<std::vector<HandTruth>> read_hand_truth(const std::filesystem::path& file) {
    return read_whole(file, &parse_hand_truth);
}

std::string labels_text(std::span<const GestureLabel> labels) {
    const bool commits = std::any_of(labels.begin(), labels.end(),
                                     [](const GestureLabel& l) { return l.commit.has_value(); });
    std::string text =
        std::string("gesture,hand,start_us,end_us") + (commits ? ",commit_us" : "") + "\n";
    for (const GestureLabel& l : labels) {
        text += l.gesture + "," + to_string(l.hand) + "," + std::to_string(l.start.us()) + "," +
                std::to_string(l.end.us());
        if (commits) {
            text += "," + (l.commit ? std::to_string(l.commit->us()) : std::string());
        }
        text += '\n';
    }
    return text;
}

std::string hand_truth_text(std::span<const HandTruth> truth) {
    std::string text = "t_us,hand,palm_x,palm_y,palm_z";
    for (const char* finger : kFingers) {
        for (const char* part : {"_tip", "_pad"}) {
            for (const char axis : {'x', 'y', 'z'}) {
                text += std::string(",") + finger + part + "_" + axis;
            }
        }
    }
    text += ",pinch_mm\n";
    for (const HandTruth& t : truth) {
        text += std::to_string(t.stamp.us()) + "," + to_string(t.hand) + point_text(t.palm);
        for (std::size_t finger = 0; finger < kFingerCount; ++finger) {
            text += point_text(t.tips[finger]) + point_text(t.pads[finger]);
        }
        text += ',';
        if (t.pinch_mm >= 0.0F) {
            base::append_fixed(text, t.pinch_mm, kLengthDigits);
        }
        text += '\n';
    }
    return text;
}

Result<GestureLabel> label_of(std::string_view gesture, std::string_view hand) {
    if (!is_gesture(gesture)) {
        return Error{
            ErrorCode::invalid_argument,
            "the gesture is " + base::quoted(std::string(gesture)) + "; " + gesture_wanted()};
    }
    const auto side = hand_of(hand);
    if (!side) {
        return Error{ErrorCode::invalid_argument,
                     "the hand is " + base::quoted(std::string(hand)) + "; " + kHandWanted};
    }
    GestureLabel label;
    label.gesture = gesture;
    label.hand = *side;
    return label;
}

Result<void> write_labels(const std::filesystem::path& file, std::span<const GestureLabel> labels) {
    for (const GestureLabel& label : labels) {
        if (!is_gesture(label.gesture)) {
            return Error{ErrorCode::invalid_argument, file.string() + ": the gesture is " +
                                                          base::quoted(label.gesture) + "; " +
                                                          gesture_wanted()};
        }
    }
    return base::write_file(file, labels_text(labels));
}

}  // namespace xtrack
