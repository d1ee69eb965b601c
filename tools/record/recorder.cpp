// SPDX-License-Identifier: Apache-2.0
#include "tools/record/recorder.hpp"

#include <utility>

#include <fmt/format.h>
#include <xtrack/joint_recording.hpp>

namespace xtrack::tools {

namespace {

constexpr const char* kJointsFile = "joints.csv";

/// What a tracker of depth has measured of a hand, as joints; what follows from it is left out, or
/// whoever reads them would take it for measured.
void fill_joints(Hand& hand) {
    hand.joints = {};
    constexpr Joint kTips[kFingerCount] = {Joint::thumb_tip, Joint::index_tip, Joint::middle_tip,
                                           Joint::ring_tip, Joint::little_tip};
    hand.joint(Joint::palm) = {hand.palm_mm, true};
    for (std::size_t f = 0; f < kFingerCount; ++f) {
        hand.joint(kTips[f]) = hand.fingertips[f];
    }
}

Result<void> check_source(RecordWhat what, const OpenedSource& source) {
    if (what == RecordWhat::images && source.kind != RecordingKind::fringe) {
        return Error{ErrorCode::invalid_argument,
                     "--what images: the source has no images of fringes; choose depth or joints"};
    }
    if (what == RecordWhat::depth && source.kind == RecordingKind::joints) {
        return Error{ErrorCode::invalid_argument,
                     "--what depth: the source has no depth; choose joints"};
    }
    if (what != RecordWhat::images && !source.session.metric()) {
        return Error{ErrorCode::unsupported,
                     fmt::format("--what {}: is kept in mm, and without a calibration there are "
                                 "none; record images",
                                 to_string(what))};
    }
    return {};
}

}  // namespace

const char* to_string(RecordWhat what) noexcept {
    switch (what) {
        case RecordWhat::images: return "images";
        case RecordWhat::depth: return "depth";
        case RecordWhat::joints: return "joints";
    }
    return "unknown";
}

Result<Recorder> Recorder::create(const RecorderSetup& setup, const OpenedSource& source) {
    if (auto possible = check_source(setup.what, source); !possible) {
        return possible.error();
    }
    Recorder recorder(setup);
    if (setup.what == RecordWhat::joints) {
        auto folder = base::NewFolder::create(setup.out);
        if (!folder) {
            return folder.error();
        }
        recorder.joints_ = std::move(*folder);
        return recorder;
    }
    RecordingWriter::Setup format{source.rig, std::nullopt, kDepthUnitMm};
    if (setup.what == RecordWhat::images) {
        format.patterns = source.patterns;
    } else if (source.kind == RecordingKind::depth) {
        format.depth_unit_mm = source.depth_unit_mm;
    }
    auto writer = RecordingWriter::create(setup.out, format);
    if (!writer) {
        return writer.error();
    }
    recorder.writer_ = std::move(*writer);
    return recorder;
}

const DepthFrame& Recorder::masked(const PipelineView& view) {
    const DepthFrame& depth = *view.depth;
    const int width = depth.depth.width();
    masked_.stamp = depth.stamp;
    masked_.sequence = depth.sequence;
    masked_.metric = depth.metric;
    masked_.depth_unit_mm = depth.depth_unit_mm;
    masked_.depth.resize(width, depth.depth.height());
    masked_.depth.fill(0);
    if (view.tracker == nullptr || view.tracker->status() != TrackStatus::ok) {
        return masked_;
    }
    const HandSegmentation hands = view.tracker->segmentation();
    for (int y = 0; y < depth.depth.height() && !hands.labels.empty(); ++y) {
        const int row = y / hands.scale;
        for (int x = 0; x < width && row < hands.labels.height; ++x) {
            const int column = x / hands.scale;
            if (column < hands.labels.width && hands.labels.at(column, row) != 0) {
                masked_.depth.at(x, y) = depth.depth.at(x, y);
            }
        }
    }
    return masked_;
}

Result<void> Recorder::add_joints(const HandFrame& hands) {
    if (count_ == kMaxJointMoments) {
        return Error{ErrorCode::unsupported,
                     fmt::format("{}: holds {} moments, and more are not read; record in parts",
                                 (setup_.out / kJointsFile).string(), kMaxJointMoments)};
    }
    HandFrame frame = hands;
    for (Hand& hand : frame.all()) {
        if (!hand.articulated) {
            fill_joints(hand);
        }
    }
    return joints_->append(kJointsFile, (count_ == 0 ? joint_recording_head() : std::string()) +
                                            joint_recording_lines(frame));
}

Result<void> Recorder::add(const PipelineView& view) {
    std::optional<Stamp> stamp;
    Result<void> added;
    switch (setup_.what) {
        case RecordWhat::images:
            // A damaged one has no pixels that mean anything, and the format no place to say so.
            if (view.frame != nullptr && (*view.frame)->status == FrameStatus::ok) {
                stamp = (*view.frame)->stamp;
                added = writer_->add(**view.frame);
            }
            break;
        case RecordWhat::depth:
            if (view.depth != nullptr) {
                stamp = view.depth->stamp;
                added = writer_->add(setup_.hand_only ? masked(view) : *view.depth);
            }
            break;
        case RecordWhat::joints:
            // Equal stamps are one moment in joints.csv, and to trackers: they skip the second.
            if (view.interaction_hands != nullptr &&
                (count_ == 0 || view.interaction_hands->stamp != last_)) {
                stamp = view.interaction_hands->stamp;
                added = add_joints(*view.interaction_hands);
            }
            break;
    }
    if (!stamp || !added) {
        return added;
    }
    first_ = count_ == 0 ? *stamp : first_;
    last_ = *stamp;
    ++count_;
    return {};
}

Result<void> Recorder::set_labels(std::span<const GestureLabel> labels) {
    const std::string text = labels_text(labels);
    return writer_ ? writer_->add_text("labels.csv", text) : joints_->write("labels.csv", text);
}

Result<void> Recorder::close() {
    if (writer_ && count_ > 0) {
        return writer_->close();
    }
    if (joints_ && count_ > 0) {
        return joints_->commit();
    }
    writer_.reset();
    joints_.reset();
    return Error{ErrorCode::io, setup_.out.string() +
                                    ": nothing came that could be recorded; let the source run "
                                    "longer, or look at it with xtrack run"};
}

const std::filesystem::path& Recorder::folder() const noexcept {
    return writer_ ? writer_->folder() : joints_->path();
}

}  // namespace xtrack::tools
