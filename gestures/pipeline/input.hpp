// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <exception>
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
    Stamp stamp;                                ///< of whichever of the three is set
    std::chrono::steady_clock::time_point due;  ///< when it could be had, by the stream's clock
};

/// The three kinds of source as one.
class Input {
 public:
    explicit Input(std::unique_ptr<FrameSource> source) : frames_(std::move(source)) {}
    explicit Input(std::unique_ptr<DepthSource> source) : depths_(std::move(source)) {}
    explicit Input(std::unique_ptr<HandSource> source) : hands_(std::move(source)) {}

    /// As FrameSource's; other sources do not know it.
    [[nodiscard]] Duration delivery_delay() const {
        return frames_ ? frames_->delivery_delay() : Duration::zero();
    }

    /// Sources may be a caller's own: one that throws or breaks its promise has failed.
    void read(Duration timeout, InputItem& item) noexcept {
        try {
            ask(timeout, item);
        } catch (const std::exception& e) {
            item.status = SourceStatus::failed;
            item.message = std::string("the source threw: ") + e.what();
        } catch (...) {
            item.status = SourceStatus::failed;
            item.message = "the source threw something unknown";
        }
    }

 private:
    void ask(Duration timeout, InputItem& item) {
        if (frames_) {
            FrameSource::Item got = frames_->next(timeout);
            item.status = got.status;
            item.message = std::move(got.message);
            item.frame = std::move(got.frame);
            if (item.frame) {
                item.stamp = item.frame->stamp;
            } else if (item.status == SourceStatus::ok) {
                item.status = SourceStatus::failed;
                item.message = "the source says ok and gives no frame; say timeout or end instead";
            }
        } else if (depths_) {
            item.status = depths_->next(timeout, item.depth, item.message);
            item.stamp = item.depth.stamp;
        } else {
            item.status = hands_->next(timeout, item.hands, item.message);
            item.stamp = item.hands.stamp;
        }
    }

    std::unique_ptr<FrameSource> frames_;
    std::unique_ptr<DepthSource> depths_;
    std::unique_ptr<HandSource> hands_;
};

}  // namespace xtrack
