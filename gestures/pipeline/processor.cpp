// SPDX-License-Identifier: Apache-2.0
#include "gestures/pipeline/processor.hpp"

#include <algorithm>
#include <chrono>
#include <string>
#include <utility>

namespace xtrack {

namespace {

using Wall = std::chrono::steady_clock;

/// A camera that faces the user, its origin the interaction frame's: what a rig means that does not
/// say where the user is.
Mat4d facing_the_user() {
    Mat4d m = Mat4d::Identity();
    m(0, 0) = -1.0;
    m(1, 1) = -1.0;
    return m;
}

/// Of a DepthDecoder in a session.
Result<void> check_pattern_settings(const DecodeSettings& settings) {
    if (settings.mode != CaptureMode::sliding) {
        return Error{ErrorCode::invalid_argument,
                     "decode settings: mode is for fringes that are unwrapped in space, "
                     "DecodeMethod::paper"};
    }
    if (settings.order != OrderSource::automatic) {
        return Error{ErrorCode::invalid_argument,
                     "decode settings: order must be automatic, as a session needs depth and has "
                     "no other to begin with"};
    }
    return {};
}

/// Every image is a phase of its own, which no motion tears.
bool never_changes(const PatternSequence& patterns) { return patterns.patterns.size() == 1; }

}  // namespace

Result<Processor> Processor::for_frames(const Rig& rig, const PatternSequence& patterns,
                                        const SessionOptions& options) {
    const bool has_rig = rig.projector.has_value();
    if (has_rig && !options.use_rig) {
        Rig none;
        none.camera.size = rig.camera.size;
        return for_frames(none, patterns, options);
    }
    if (options.method == DecodeMethod::paper ||
        (options.method == DecodeMethod::automatic && !has_rig)) {
        return for_paper(rig, patterns, options);
    }
    if (auto possible = check_pattern_settings(options.decode); !possible) {
        return possible.error();
    }
    auto decoder = DepthDecoder::create(rig, patterns, rig.camera.size, options.decode);
    if (!decoder && options.method == DecodeMethod::automatic && never_changes(patterns)) {
        return for_paper(rig, patterns, options);  // the picture orders what no pattern does
    }
    if (!decoder) {
        return decoder.error();
    }
    auto processor = for_depth(rig, options);
    if (processor) {
        processor->decoder_ = std::move(*decoder);
    }
    return processor;
}

Result<Processor> Processor::for_paper(const Rig& rig, const PatternSequence& patterns,
                                       const SessionOptions& options) {
    const bool metric = rig.projector.has_value();
    auto decoder =
        PaperDecoder::create(patterns, rig.camera.size, options.decode, metric ? &rig : nullptr);
    if (!decoder) {
        return decoder.error();
    }
    SessionOptions adapted = options;
    if (!metric) {
        adapted.gestures = without_millimetres(adapted.gestures);
        adapted.tracker.near_mm = adapted.tracker.far_mm = 0.0;
    }
    auto processor =
        for_depth(metric ? rig : segment::RelativeScene::nominal_rig(rig.camera.size), adapted);
    if (!processor) {
        return processor;
    }
    processor->paper_ = std::move(*decoder);
    if (!metric) {
        processor->relative_.emplace(rig.camera.size, PaperDecoder::kBackground_mm,
                                     PaperDecoder::kMmPerProjectorPx);
    }
    return processor;
}

Result<Processor> Processor::for_depth(const Rig& rig, const SessionOptions& options) {
    auto recogniser = GestureRecogniser::create(options.gestures);
    if (!recogniser) {
        return recogniser.error();
    }
    // Made once here with the rig's own size so that a wrong setting is said before the first
    // image.
    auto tracker = HandTracker::create(rig, rig.camera.size, options.tracker);
    if (!tracker) {
        return tracker.error();
    }
    Processor processor(std::move(*recogniser),
                        rig.interaction_from_camera.value_or(facing_the_user()));
    processor.tracker_ = std::move(*tracker);
    processor.tracker_size_ = rig.camera.size;
    processor.rig_ = rig;
    processor.tracker_settings_ = options.tracker;
    processor.pointer_ahead_ = options.pointer_ahead;
    return processor;
}

Result<Processor> Processor::for_hands(const SessionOptions& options) {
    auto recogniser = GestureRecogniser::create(options.gestures);
    if (!recogniser) {
        return recogniser.error();
    }
    Processor processor(std::move(*recogniser), Mat4d::Identity());
    processor.pointer_ahead_ = options.pointer_ahead;
    return processor;
}

DecodeMethod Processor::method() const noexcept {
    if (paper_) {
        return DecodeMethod::paper;
    }
    return decoder_ ? DecodeMethod::pattern : DecodeMethod::automatic;
}

Result<void> Processor::set_decode_settings(const DecodeSettings& settings) {
    if (paper_) {
        return paper_->set_settings(settings);
    }
    if (!decoder_) {
        return Error{ErrorCode::unsupported,
                     "decode settings: the source has no fringes, nothing is decoded"};
    }
    if (auto possible = check_pattern_settings(settings); !possible) {
        return possible;
    }
    return decoder_->set_settings(settings);
}

DecodeSettings Processor::decode_settings() const noexcept {
    if (paper_) {
        return paper_->settings();
    }
    return decoder_ ? decoder_->settings() : DecodeSettings{};
}

bool Processor::uses(const DecodeField& field) const noexcept {
    return paper_ ? paper_->uses(field) : decoder_.has_value() && DepthDecoder::uses(field);
}

bool Processor::decode(const FramePtr& frame, PipelineView& view) {
    const auto begin = Wall::now();
    const DecodeStatus status = paper_ ? paper_->push(frame) : decoder_->push(frame);
    decode_time_.add(Wall::now() - begin);
    if (status.state == DecodeState::rejected) {
        ++rejected_;
    }
    if (status.state != DecodeState::depth_ready) {
        return false;
    }
    view.decoder = decoder_ ? &*decoder_ : nullptr;
    view.paper = paper();
    view.depth = paper_ ? &paper_->depth() : &decoder_->depth();
    return true;
}

// The components come with the most pixels first. At first all seems to move.
int Processor::surfaces() const noexcept {
    // Shares of the image: one in so many.
    constexpr int kLeast = 250;
    constexpr int kMost = 3;
    const auto components = paper_->components();
    const int pixels = rig_.camera.size.width * rig_.camera.size.height;
    if (paper_->settings().motion == MotionHandling::off ||
        (!components.empty() && components[0].pixels > pixels / kMost)) {
        return -1;
    }
    return static_cast<int>(std::count_if(components.begin(), components.end(), [&](const auto& c) {
        return c.pixels >= pixels / kLeast;
    }));
}

bool Processor::is_followed() const noexcept {
    constexpr float kSure = 0.8F;
    const auto hands = camera_hands_.all();
    return std::any_of(hands.begin(), hands.end(),
                       [](const Hand& hand) { return hand.confidence >= kSure; });
}

Result<void> Processor::track(const DepthFrame& depth, PipelineView& view) {
    ++depth_frames_;
    if (depth.depth.size() != tracker_size_) {
        if (depth_frames_ > 1) {
            ++rejected_;
            return {};
        }
        auto tracker = HandTracker::create(rig_, depth.depth.size(), tracker_settings_);
        if (!tracker) {
            return tracker.error();
        }
        tracker_ = std::move(*tracker);
        tracker_size_ = depth.depth.size();
    }
    const auto begin = Wall::now();
    if (relative_ && relative_->update(depth, paper_->component(), surfaces(), is_followed())) {
        tracker_->reset();  // it is of another size now, and so is all that it knows
    }
    if (relative_ && !relative_->has_scale()) {
        return {};  // a hand that is there when it gets one was there from the start
    }
    camera_hands_ = tracker_->track(relative_ ? relative_->depth() : depth);
    camera_hands_.metric = metric();
    view.camera_hands = &camera_hands_;
    if (tracker_->status() != TrackStatus::ok) {
        ++rejected_;
    }
    interaction_hands_ = to_interaction(*view.camera_hands, interaction_from_camera_);
    track_time_.add(Wall::now() - begin);
    view.tracker = &*tracker_;
    view.interaction_hands = &interaction_hands_;
    return {};
}

Result<Processor::Outcome> Processor::process(const InputItem& item) {
    if (newest_ && item.stamp < *newest_) {
        return Error{ErrorCode::malformed,
                     "time runs backwards: " + std::to_string(item.stamp.us()) + " us after " +
                         std::to_string(newest_->us()) +
                         " us; the source must give stamps in order"};
    }
    newest_ = item.stamp;

    Outcome outcome;
    PipelineView& view = outcome.view;
    if (item.frame) {
        view.frame = &item.frame;
        (void)decode(item.frame, view);
    } else if (tracker_) {
        view.depth = &item.depth;
    } else {
        // A new HandFrame says `camera`: forgetting to say otherwise would mean no events,
        // silently.
        if (item.hands.coordinates != CoordinateFrame::interaction) {
            return Error{ErrorCode::malformed,
                         "hands are in the camera frame; the source must give them in the "
                         "interaction frame (to_interaction()) and say so in `coordinates`"};
        }
        if (item.hands.count > kMaxHands) {
            return Error{ErrorCode::malformed,
                         "count of hands is " + std::to_string(item.hands.count) +
                             "; the source must give at most " + std::to_string(kMaxHands)};
        }
        interaction_hands_ = item.hands;
        hand_from_joints_.complete(interaction_hands_);
        view.interaction_hands = &interaction_hands_;
    }
    if (view.depth != nullptr) {
        if (auto tracked = track(*view.depth, view); !tracked) {
            return tracked.error();
        }
    }

    const auto begin = Wall::now();
    if (view.interaction_hands != nullptr) {
        lag_ = item.stamp - interaction_hands_.stamp;
        pointer_.update(interaction_hands_, *lag_ + pointer_ahead_);
        outcome.events = recogniser_.push(interaction_hands_);
    } else {
        outcome.events = advance(item.stamp);
    }
    recognise_time_.add(Wall::now() - begin);
    return outcome;
}

std::span<const GestureEvent> Processor::advance(Stamp now) {
    if (!lag_) {
        return {};
    }
    return recogniser_.advance(now - *lag_);
}

}  // namespace xtrack
