// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <utility>

#include <xtrack/depth.hpp>
#include <xtrack/frame.hpp>
#include <xtrack/hand_source.hpp>
#include <xtrack/source.hpp>

namespace xtrack {

/// One item of any of the three kinds of source. Buffers travel with it: swapping two items never
/// allocates.
struct InputItem {
    SourceStatus status = SourceStatus::end;
    std::string message;
    FramePtr frame;
    DepthFrame depth;
    HandFrame hands;
    Stamp stamp;  ///< of whichever of the three is set
};

/// The three kinds of source as one.
class Input {
 public:
    explicit Input(std::unique_ptr<FrameSource> source) : frames_(std::move(source)) {}
    explicit Input(std::unique_ptr<DepthSource> source) : depths_(std::move(source)) {}
    explicit Input(std::unique_ptr<HandSource> source) : hands_(std::move(source)) {}

    void read(Duration timeout, InputItem& item) {
        if (frames_) {
            FrameSource::Item got = frames_->next(timeout);
            item.status = got.status;
            item.message = std::move(got.message);
            item.frame = std::move(got.frame);
            if (item.frame) {
                item.stamp = item.frame->stamp;
            }
        } else if (depths_) {
            item.status = depths_->next(timeout, item.depth, item.message);
            item.stamp = item.depth.stamp;
        } else {
            item.status = hands_->next(timeout, item.hands, item.message);
            item.stamp = item.hands.stamp;
        }
    }

 private:
    std::unique_ptr<FrameSource> frames_;
    std::unique_ptr<DepthSource> depths_;
    std::unique_ptr<HandSource> hands_;
};

}  // namespace xtrack
