// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <utility>

#include <xtrack/session.hpp>

namespace xtrack::test {

inline constexpr Duration kFrame = std::chrono::microseconds(16667);
inline constexpr float kSwipeSpeed_mmps = 800.0F;
inline constexpr double kRest_s = 0.6;
inline constexpr double kStroke_s = 0.35;

/// A right hand held up, flat side to the left, that rests, strokes to the left and rests again.
class SwipingHand final : public HandSource {
 public:
    explicit SwipingHand(int frames, SourceStatus after = SourceStatus::end,
                         Duration spacing = kFrame)
        : frames_(frames), after_(after), spacing_(spacing) {}

    SourceStatus next(Duration timeout, HandFrame& out, std::string& message) override {
        if (next_ == frames_) {
            message = "the hand is gone";
            if (after_ == SourceStatus::timeout) {
                std::this_thread::sleep_for(timeout);
            }
            return after_;
        }
        const double t = to_seconds(kFrame) * next_;
        const double moved = std::clamp(t - kRest_s, 0.0, kStroke_s);
        out = HandFrame{};
        out.stamp = Stamp{} + spacing_ * next_++;
        out.coordinates = CoordinateFrame::interaction;
        out.count = 1;
        Hand& hand = out.hands[0];
        hand.id = 1;
        hand.chirality = Chirality::right;
        hand.chirality_confidence = 1.0F;
        hand.confidence = 1.0F;
        const Vec3f palm(150.0F - kSwipeSpeed_mmps * static_cast<float>(moved), 0.0F, 500.0F);
        const auto put = [&](Joint j, float x, float y, float z) {
            hand.joint(j) = {palm + Vec3f(x, y, z), true};
        };
        put(Joint::palm, 0, 0, 0);
        put(Joint::wrist, 0, -90, 0);
        const Joint firsts[4] = {Joint::index_proximal, Joint::middle_proximal,
                                 Joint::ring_proximal, Joint::little_proximal};
        for (int f = 0; f < 4; ++f) {
            for (int k = 0; k < 4; ++k) {
                const auto joint = static_cast<Joint>(static_cast<int>(firsts[f]) + k);
                put(joint, 0.0F, 20.0F + 28.0F * static_cast<float>(k),
                    -30.0F + 20.0F * static_cast<float>(f));
            }
        }
        put(Joint::thumb_proximal, 0, 0, -40);
        put(Joint::thumb_distal, 0, 20, -60);
        put(Joint::thumb_tip, 0, 40, -75);
        return SourceStatus::ok;
    }

 private:
    int frames_;
    SourceStatus after_;
    Duration spacing_;
    int next_ = 0;
};

inline Result<Session> swiping_session(Pace pace = Pace::replay, int frames = 100,
                                       SourceStatus after = SourceStatus::end) {
    SessionOptions options;
    options.pace = pace;
    return Session::create(std::unique_ptr<HandSource>(new SwipingHand(frames, after)), options);
}

/// A tracker of the caller's whose next() does what the test says.
class CallersSource final : public HandSource {
 public:
    using Next = std::function<SourceStatus(HandFrame&)>;
    explicit CallersSource(Next next) : next_(std::move(next)) {}
    SourceStatus next(Duration /*timeout*/, HandFrame& out, std::string& /*message*/) override {
        return next_(out);
    }

 private:
    Next next_;
};

inline Result<Session> callers_session(CallersSource::Next next, Pace pace) {
    SessionOptions options;
    options.pace = pace;
    return Session::create(std::unique_ptr<HandSource>(new CallersSource(std::move(next))),
                           options);
}

}  // namespace xtrack::test
