// SPDX-License-Identifier: Apache-2.0
#include <xtrack/joint_recording.hpp>

#include <algorithm>
#include <array>
#include <limits>
#include <optional>

#include "core/base/csv.hpp"
#include "core/base/file.hpp"
#include "core/base/setting_up.hpp"
#include "core/base/text.hpp"

namespace xtrack {

namespace {

constexpr std::size_t kMaxFileBytes = std::size_t{256} << 20U;
constexpr base::CsvLimits kLimits{8192, kMaxHands* kMaxJointMoments, 256};
constexpr double kMaxPosition_mm = 1e5;

struct Columns {
    std::size_t t_us = 0;
    std::size_t hand = 0;
    std::size_t hand_id = 0;
    std::size_t confidence = 0;
    std::array<std::optional<std::array<std::size_t, 3>>, kJointCount> joints;
};

Result<Columns> find_columns(const base::CsvReader& csv) {
    Columns columns;
    struct Wanted {
        const char* name;
        std::size_t* column;
    };
    const Wanted wanted[] = {{"t_us", &columns.t_us},
                             {"hand", &columns.hand},
                             {"hand_id", &columns.hand_id},
                             {"confidence", &columns.confidence}};
    for (const Wanted& w : wanted) {
        const auto found = csv.required_column(w.name);
        if (!found) {
            return found.error();
        }
        *w.column = *found;
    }
    for (std::size_t j = 0; j < kJointCount; ++j) {
        const std::string name = to_string(static_cast<Joint>(j));
        if (!csv.column(name + "_x") && !csv.column(name + "_y") && !csv.column(name + "_z")) {
            continue;
        }
        auto& joint = columns.joints[j].emplace();
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto found = csv.required_column(name + "_" + "xyz"[axis]);
            if (!found) {
                return found.error();
            }
            joint[axis] = *found;
        }
    }
    return columns;
}

Result<TrackedPoint> read_joint(const base::CsvReader& csv,
                                const std::array<std::size_t, 3>& columns) {
    TrackedPoint point;
    if (csv.field(columns[0]).empty() && csv.field(columns[1]).empty() &&
        csv.field(columns[2]).empty()) {
        return point;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto value = csv.number_field(columns[axis], -kMaxPosition_mm, kMaxPosition_mm);
        if (!value) {
            return value.error();
        }
        point.position_mm[static_cast<Eigen::Index>(axis)] = static_cast<float>(*value);
    }
    point.valid = true;
    return point;
}

Result<Hand> read_hand(const base::CsvReader& csv, const Columns& columns) {
    Hand hand;
    const std::string_view side = csv.field(columns.hand);
    if (side == "left" || side == "right") {
        hand.chirality = side == "left" ? Chirality::left : Chirality::right;
    } else if (side != "unknown") {
        return csv.error_at(columns.hand, "give left, right, unknown, or nothing for no hand");
    }
    const auto id = csv.int_field(columns.hand_id, std::numeric_limits<int>::min(),
                                  std::numeric_limits<int>::max());
    if (!id) {
        return id.error();
    }
    hand.id = static_cast<int>(*id);
    const auto confidence = csv.number_field(columns.confidence, 0.0, 1.0);
    if (!confidence) {
        return confidence.error();
    }
    hand.confidence = static_cast<float>(*confidence);
    hand.chirality_confidence =
        hand.chirality == Chirality::unknown ? 0.0F : static_cast<float>(*confidence);
    for (std::size_t j = 0; j < kJointCount; ++j) {
        if (columns.joints[j]) {
            const auto point = read_joint(csv, *columns.joints[j]);
            if (!point) {
                return point.error();
            }
            hand.joints[j] = *point;
        }
    }
    return hand;
}

Result<void> add_hand(const base::CsvReader& csv, const Columns& columns, HandFrame& frame) {
    if (csv.field(columns.hand).empty()) {
        return {};
    }
    const auto hand = read_hand(csv, columns);
    if (!hand) {
        return hand.error();
    }
    if (frame.count == kMaxHands) {
        return csv.error_at(
            columns.t_us, "it has over " + std::to_string(kMaxHands) + " hands, remove the others");
    }
    for (const Hand& other : frame.all()) {
        if (other.id == hand->id) {
            return csv.error_at(columns.hand_id,
                                "another hand of this t_us has the same, give "
                                "each its own");
        }
    }
    frame.hands[frame.count++] = *hand;
    return {};
}

}  // namespace

Result<std::vector<HandFrame>> parse_joint_recording(std::string_view text,
                                                     const std::string& name) {
    auto csv = base::CsvReader::open(text, name, kLimits);
    if (!csv) {
        return csv.error();
    }
    const auto columns = find_columns(*csv);
    if (!columns) {
        return columns.error();
    }
    std::vector<HandFrame> frames;
    // Doubling would take twice the memory of a long recording.
    frames.reserve(std::min(kMaxJointMoments,
                            static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'))));
    while (true) {
        const auto more = csv->next();
        if (!more) {
            return more.error();
        }
        if (!*more) {
            break;
        }
        const auto stamp = csv->stamp_field(
            columns->t_us,
            frames.empty() ? std::nullopt : std::optional<Stamp>(frames.back().stamp));
        if (!stamp) {
            return stamp.error();
        }
        if (frames.empty() || *stamp != frames.back().stamp) {
            if (frames.size() == kMaxJointMoments) {
                return csv->error("comes after " + std::to_string(kMaxJointMoments) +
                                  " frames; split the recording");
            }
            HandFrame frame;
            frame.stamp = *stamp;
            frame.coordinates = CoordinateFrame::interaction;
            frames.push_back(frame);
        }
        if (auto ok = add_hand(*csv, *columns, frames.back()); !ok) {
            return ok.error();
        }
    }
    if (frames.empty()) {
        return Error{ErrorCode::malformed, name + ": lists no frame; record at least one"};
    }
    return frames;
}

Result<std::vector<HandFrame>> read_joint_recording(const std::filesystem::path& file) {
    return base::setting_up("read_joint_recording", [&]() -> Result<std::vector<HandFrame>> {
        const auto text = base::read_file(file, kMaxFileBytes);
        if (!text) {
            return text.error();
        }
        return parse_joint_recording(*text, file.string());
    });
}

namespace {

void append(std::string& text, float value, int digits) {
    text += ',';
    base::append_fixed(text, value, digits);
}

}  // namespace

std::string joint_recording_head() {
    std::string text = "t_us,hand,hand_id,confidence";
    for (std::size_t j = 0; j < kJointCount; ++j) {
        for (const char axis : {'x', 'y', 'z'}) {
            text += std::string(",") + to_string(static_cast<Joint>(j)) + "_" + axis;
        }
    }
    return text + '\n';
}

std::string joint_recording_lines(const HandFrame& frame) {
    const std::string t = std::to_string(frame.stamp.us());
    if (frame.count == 0) {
        return t + ",,," + std::string(3 * kJointCount, ',') + "\n";
    }
    std::string text;
    for (const Hand& hand : frame.all()) {
        text += t + "," + to_string(hand.chirality) + "," + std::to_string(hand.id);
        append(text, hand.confidence, 3);
        for (const TrackedPoint& joint : hand.joints) {
            if (!joint.valid) {
                text += ",,,";
                continue;
            }
            for (Eigen::Index axis = 0; axis < 3; ++axis) {
                append(text, joint.position_mm[axis], 2);
            }
        }
        text += '\n';
    }
    return text;
}

std::string joint_recording_text(std::span<const HandFrame> frames) {
    std::string text = joint_recording_head();
    for (const HandFrame& frame : frames) {
        text += joint_recording_lines(frame);
    }
    return text;
}

Result<void> write_joint_recording(const std::filesystem::path& file,
                                   std::span<const HandFrame> frames) {
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const std::string which = "frame " + std::to_string(i);
        if (i > 0 && frames[i].stamp < frames[i - 1].stamp) {
            return Error{ErrorCode::invalid_argument,
                         "stamp of " + which + " goes backwards; give frames in order of time"};
        }
        for (const Hand& hand : frames[i].all()) {
            for (const TrackedPoint& joint : hand.joints) {
                if (joint.valid && !joint.position_mm.allFinite()) {
                    return Error{ErrorCode::invalid_argument,
                                 "a joint of " + which + " is not finite; mark it not valid"};
                }
            }
        }
    }
    return base::write_file(file, joint_recording_text(frames));
}

}  // namespace xtrack
