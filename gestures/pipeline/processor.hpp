// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include <xtrack/gesture_recogniser.hpp>
#include <xtrack/session.hpp>

#include "core/base/time_histogram.hpp"
#include "gestures/pipeline/input.hpp"
#include "gestures/segment/relative_scene.hpp"
#include "gestures/track/hand_from_joints.hpp"
#include "gestures/track/pointer.hpp"

namespace xtrack {

/// One item through decode, track and recognise, in the calling thread. Where an item enters
/// depends on its kind: fringe images at decode, depth at track, joints at recognise.
class Processor {
 public:
    static Result<Processor> for_frames(const Rig& rig, const PatternSequence& patterns,
                                        const SessionOptions& options);
    static Result<Processor> for_depth(const Rig& rig, const SessionOptions& options);
    static Result<Processor> for_hands(const SessionOptions& options);

    struct Outcome {
        PipelineView view;  ///< borrowed until the next call
        std::span<const GestureEvent> events;
    };
    /// @errors malformed: the item's stamp is before the last one's, hands are too many or not in
    ///         the interaction frame
    [[nodiscard]] Result<Outcome> process(const InputItem& item);

    /// Tells the state machines that time went on without an item; `now` is on the items' clock.
    std::span<const GestureEvent> advance(Stamp now);
    [[nodiscard]] PaperDecoder* paper() noexcept { return paper_ ? &*paper_ : nullptr; }
    [[nodiscard]] DecodeMethod method() const noexcept;
    Result<void> set_decode_settings(const DecodeSettings& settings);
    [[nodiscard]] DecodeSettings decode_settings() const noexcept;
    [[nodiscard]] bool uses(const DecodeField& field) const noexcept;
    [[nodiscard]] bool metric() const noexcept { return !relative_; }
    [[nodiscard]] GestureRecogniser& recogniser() noexcept { return recogniser_; }

    [[nodiscard]] const TimeHistogram& decode_time() const noexcept { return decode_time_; }
    [[nodiscard]] const TimeHistogram& track_time() const noexcept { return track_time_; }
    [[nodiscard]] const TimeHistogram& recognise_time() const noexcept { return recognise_time_; }
    [[nodiscard]] std::uint64_t depth_frames() const noexcept { return depth_frames_; }
    [[nodiscard]] std::uint64_t rejected() const noexcept { return rejected_; }

 private:
    Processor(GestureRecogniser recogniser, const Mat4d& interaction_from_camera)
        : recogniser_(std::move(recogniser)), interaction_from_camera_(interaction_from_camera) {}

    static Result<Processor> for_paper(const Rig& rig, const PatternSequence& patterns,
                                       const SessionOptions& options);
    [[nodiscard]] bool decode(const FramePtr& frame, PipelineView& view);
    /// Depth images of any size go to a tracker of that size, made when the first one comes.
    [[nodiscard]] Result<void> track(const DepthFrame& depth, PipelineView& view);
    /// How many of the PaperDecoder's components move and are more than scraps; negative: unknown.
    [[nodiscard]] int surfaces() const noexcept;
    [[nodiscard]] bool is_followed() const noexcept;  ///< a hand, in the last depth

    std::optional<DepthDecoder> decoder_;
    std::optional<PaperDecoder> paper_;
    std::optional<segment::RelativeScene> relative_;  ///< set where depth is
    std::optional<HandTracker> tracker_;
    Size tracker_size_;
    Rig rig_;
    TrackerSettings tracker_settings_;
    HandFromJoints hand_from_joints_;
    Pointer pointer_;
    Duration pointer_ahead_ = Duration::zero();
    GestureRecogniser recogniser_;
    Mat4d interaction_from_camera_;
    HandFrame camera_hands_;  ///< with what the tracker does not know
    HandFrame interaction_hands_;
    std::optional<Stamp> newest_;
    /// A depth image is as old as the middle of its window: the hands' time is behind the frames'.
    std::optional<Duration> lag_;

    TimeHistogram decode_time_;
    TimeHistogram track_time_;
    TimeHistogram recognise_time_;
    std::uint64_t depth_frames_ = 0;
    std::uint64_t rejected_ = 0;
};

}  // namespace xtrack
