// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <utility>

#include <xtrack/gesture_event.hpp>
#include <xtrack/gesture_recogniser.hpp>
#include <xtrack/gesture_settings.hpp>

#include "gestures/recognise/motion_history.hpp"
#include "gestures/recognise/signal.hpp"

namespace xtrack::recognise {

/// Events of one call. More than all hands can cause in one frame, so that it cannot overflow.
/// What is not wanted does not get in: a machine may run for the sake of another.
class Outbox {
 public:
    static constexpr std::size_t kCapacity = 160;

    explicit Outbox(const GestureSettings& settings) : settings_(&settings) {}

    void clear() noexcept { count_ = muted_count_ = 0; }
    /// Of the hands that the next events are made from: HandFrame::metric.
    void set_metric(bool metric) noexcept { metric_ = metric; }
    /// Of a hand that is only watched: its events are counted, and do not go out. @{
    void mute(bool muted) noexcept { muted_ = muted; }
    [[nodiscard]] std::size_t muted_count() const noexcept { return muted_count_; }
    /// @}
    void add(const GestureEvent& event) noexcept {
        muted_count_ += muted_ ? 1 : 0;
        if (count_ < kCapacity && !muted_ && is_wanted(*settings_, event.type)) {
            events_[count_] = event;
            events_[count_++].metric = metric_;
        }
    }
    [[nodiscard]] std::span<const GestureEvent> all() const noexcept {
        return {events_.data(), count_};
    }

 private:
    std::array<GestureEvent, kCapacity> events_{};
    std::size_t count_ = 0;
    bool metric_ = true;
    bool muted_ = false;
    std::size_t muted_count_ = 0;
    const GestureSettings* settings_;
};

/// The one place that every transition and every refusal of every machine goes through.
class TransitionLog {
 public:
    void set_sink(GestureRecogniser::TraceSink sink) { sink_ = std::move(sink); }
    void write(const RecogniserTrace& line) const {
        if (sink_) {
            sink_(line);
        }
    }

 private:
    GestureRecogniser::TraceSink sink_;
};

/// Why the gestures of a hand are silent just now.
enum class Gate {
    open,
    entering,   ///< the lock-out after it came
    border,     ///< cut by the image's border
    fist,       ///< it says nothing
    bystander,  ///< the session is another's, or nobody's
    paused,
};

/// For the trace. Static storage.
[[nodiscard]] const char* why(Gate gate) noexcept;

/// Of what is active while a gate shuts.
[[nodiscard]] CancelReason reason_of(Gate gate) noexcept;

/// Which gesture wins a hand: the strongest first. What holds the hand silences all weaker ones and
/// its equals.
enum class Rank {
    two_hands,
    press,   ///< press, touch, drag
    grip,    ///< pinch, grab
    stroke,  ///< swipe, push, pull, tap, raise
    rhythm,  ///< circle, wave
    dwell,
    pose,
    none,
};

/// Why a candidate waits or dies; `why` is a literal, empty for no objection.
struct Refusal {
    const char* why = "";
    double measured = 0.0;
    double limit = 0.0;
};

/// What a machine is handed with every event. Borrowed for the call.
struct Context {
    const GestureSettings& settings;
    const MotionHistory& history;
    const Hand& hand;  ///< as last seen
    const Signal& signal;
    Stamp sensor;  ///< newest frame of the decision
    Stamp emit;
    Gate gate = Gate::open;
    bool taken = false;  ///< another, stronger gesture owns the hand
    int& next_gesture_id;
    Outbox& out;
    const TransitionLog& log;
};

/// An event with everything filled in that comes from the hand.
[[nodiscard]] GestureEvent event_of(const Context& c, GestureType type, EventPhase phase) noexcept;

}  // namespace xtrack::recognise
