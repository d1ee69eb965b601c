// SPDX-License-Identifier: Apache-2.0
#include "tools/eval/stills.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include <fmt/format.h>
#include <xtrack/hand_tracker.hpp>
#include <xtrack/labels.hpp>
#include <xtrack/recording.hpp>

#include "tools/eval/evaluation.hpp"

namespace xtrack::tools {

namespace {

std::filesystem::path poses_file(const std::string& folder) {
    return std::filesystem::path(folder) / "poses.csv";
}

}  // namespace

void EvaluatedStills::add(const EvaluatedStills& o) {
    with_hand += o.with_hand;
    found += o.found;
    without_hand += o.without_hand;
    none_found += o.none_found;
    counted += o.counted;
    count_right += o.count_right;
    count_near += o.count_near;
}

bool has_stills(const std::string& folder) {
    return std::filesystem::exists(std::filesystem::symlink_status(poses_file(folder)));
}

Result<EvaluatedStills> evaluate_stills(const std::string& folder,
                                        const TrackerSettings& settings) {
    const auto poses = read_poses(poses_file(folder));
    if (!poses) {
        return poses.error();
    }
    const auto reader = RecordingReader::open(folder);
    if (!reader) {
        return reader.error();
    }
    if (reader->kind() != RecordingKind::depth || !reader->has_rig()) {
        return Error{ErrorCode::unsupported,
                     poses_file(folder).string() +
                         ": describes single images, which must be of depth and have a rig.yaml; "
                         "remove it, or add what is missing"};
    }
    auto tracker = HandTracker::create(reader->rig(), reader->image_size(), settings);
    if (!tracker) {
        return tracker.error();
    }
    EvaluatedStills stills;
    stills.name = name_of_folder(folder);
    DepthFrame depth;
    for (const PoseLabel& pose : *poses) {
        if (pose.frame >= reader->entries().size()) {
            return Error{ErrorCode::malformed,
                         fmt::format("{}: frame is {}, and frames.csv lists {}; give 0 to {}",
                                     poses_file(folder).string(), pose.frame,
                                     reader->entries().size(), reader->entries().size() - 1)};
        }
        if (auto read = reader->read_depth(pose.frame, depth); !read) {
            return read.error();
        }
        tracker->reset();
        const auto hands = tracker->track(depth).all();
        if (!pose.hand_present) {
            ++stills.without_hand;
            stills.none_found += hands.empty() ? 1 : 0;
            continue;
        }
        ++stills.with_hand;
        stills.found += hands.empty() ? 0 : 1;
        if (!pose.extended_fingers) {
            continue;
        }
        ++stills.counted;
        const auto best = std::max_element(
            hands.begin(), hands.end(),
            [](const Hand& a, const Hand& b) { return a.confidence < b.confidence; });
        if (best == hands.end() || best->extended_fingers < 0) {
            continue;  // nothing was counted, which is not right
        }
        const int off = std::abs(best->extended_fingers - *pose.extended_fingers);
        stills.count_right += off == 0 ? 1 : 0;
        stills.count_near += off <= 1 ? 1 : 0;
    }
    return stills;
}

}  // namespace xtrack::tools
