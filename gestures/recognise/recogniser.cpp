// SPDX-License-Identifier: Apache-2.0
#include <xtrack/gesture_recogniser.hpp>

#include <utility>

#include "gestures/recognise/ensemble.hpp"

namespace xtrack {

const char* to_string(RecogniseStatus s) noexcept {
    switch (s) {
        case RecogniseStatus::ok: return "ok";
        case RecogniseStatus::repeated_stamp: return "repeated stamp";
        case RecogniseStatus::decreasing_stamp: return "decreasing stamp";
        case RecogniseStatus::wrong_frame: return "not in the interaction frame";
    }
    return "unknown";
}

struct GestureRecogniser::Impl {
    explicit Impl(const GestureSettings& settings) : hands(settings) {}

    recognise::Ensemble hands;
    RecogniseStatus status = RecogniseStatus::ok;
    bool started = false;

    [[nodiscard]] RecogniseStatus judge(const HandFrame& frame) const {
        if (frame.coordinates != CoordinateFrame::interaction) {
            return RecogniseStatus::wrong_frame;
        }
        if (!started || frame.stamp > hands.last_stamp()) {
            return RecogniseStatus::ok;
        }
        return frame.stamp < hands.last_stamp() ? RecogniseStatus::decreasing_stamp
                                                : RecogniseStatus::repeated_stamp;
    }
};

GestureRecogniser::GestureRecogniser(std::unique_ptr<Impl> impl) noexcept
    : impl_(std::move(impl)) {}
GestureRecogniser::GestureRecogniser(GestureRecogniser&&) noexcept = default;
GestureRecogniser& GestureRecogniser::operator=(GestureRecogniser&&) noexcept = default;
GestureRecogniser::~GestureRecogniser() = default;

Result<GestureRecogniser> GestureRecogniser::create(const GestureSettings& settings) {
    const Result<void> valid = validate(settings);
    if (!valid) {
        return valid.error();
    }
    return GestureRecogniser{std::make_unique<Impl>(settings)};
}

Result<std::span<const GestureEvent>> GestureRecogniser::set_settings(
    const GestureSettings& settings) {
    if (auto valid = validate(settings); !valid) {
        return valid.error();
    }
    impl_->hands.set_settings(settings);
    return impl_->hands.out().all();
}

const GestureSettings& GestureRecogniser::settings() const noexcept {
    return impl_->hands.settings();
}

std::span<const GestureEvent> GestureRecogniser::pause(bool paused) {
    impl_->hands.pause(paused);
    return impl_->hands.out().all();
}

std::span<const GestureEvent> GestureRecogniser::push(const HandFrame& frame) {
    Impl& m = *impl_;
    m.status = m.judge(frame);
    if (m.status != RecogniseStatus::ok) {
        m.hands.out().clear();
        return {};
    }
    m.hands.push(frame, !std::exchange(m.started, true));
    return m.hands.out().all();
}

RecogniseStatus GestureRecogniser::status() const noexcept { return impl_->status; }

double GestureRecogniser::progress(int hand_id, GestureType type) const noexcept {
    return impl_->hands.progress(hand_id, type);
}

int GestureRecogniser::session_owner() const noexcept { return impl_->hands.session_owner(); }

std::span<const GestureEvent> GestureRecogniser::advance(Stamp now) {
    Impl& m = *impl_;
    if (!m.started || now <= m.hands.last_stamp()) {
        m.hands.out().clear();
        return {};
    }
    m.hands.advance(now);
    return m.hands.out().all();
}

std::span<const GestureEvent> GestureRecogniser::finish() {
    impl_->hands.finish();
    impl_->started = false;
    return impl_->hands.out().all();
}

std::span<const GestureEvent> GestureRecogniser::abandon(CancelReason reason) {
    impl_->hands.abandon(reason);
    impl_->started = false;
    return impl_->hands.out().all();
}

void GestureRecogniser::reset() noexcept {
    impl_->hands.reset();
    impl_->hands.out().clear();
    impl_->started = false;
    impl_->status = RecogniseStatus::ok;
}

void GestureRecogniser::set_trace(TraceSink sink) { impl_->hands.log().set_sink(std::move(sink)); }

}  // namespace xtrack
