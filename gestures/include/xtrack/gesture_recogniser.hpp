// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <span>

#include <xtrack/gesture_event.hpp>
#include <xtrack/gesture_settings.hpp>
#include <xtrack/hand.hpp>
#include <xtrack/result.hpp>
#include <xtrack/stamp.hpp>

namespace xtrack {

/// What became of the last frame.
/// @since 0.1
enum class RecogniseStatus {
    ok,
    repeated_stamp,    ///< the same stamp again: skipped
    decreasing_stamp,  ///< an error of the caller's: skipped, nothing changed
    wrong_frame,       ///< not in the interaction frame: skipped
};

/// For logs. Static storage. @thread any
/// @since 0.1
[[nodiscard]] const char* to_string(RecogniseStatus s) noexcept;

/// One line of the why-not trace: a transition of one machine, or the death of a candidate. Texts
/// are literals.
/// @since 0.1
struct RecogniserTrace {
    Stamp stamp;
    int hand_id = 0;
    const char* machine = "";  ///< hand, swipe, push, pinch, wave
    const char* from = "";     ///< state
    const char* event = "";
    const char* to = "";    ///< state; the same as `from` when nothing changed
    const char* why = "";   ///< why a candidate died or waits; empty otherwise
    double measured = 0.0;  ///< what `why` is about, in the unit of the limit
    double limit = 0.0;
    bool impossible = false;  ///< an event that this state should never see: a bug of ours
};

/// Hands in, gesture events out. State machines that are told the time; docs/gestures/ draws each.
/// Nothing is allocated after create(); the same frames give the same bits.
/// @thread one thread at a time; objects are independent
/// @since 0.1
class GestureRecogniser {
 public:
    using TraceSink = std::function<void(const RecogniserTrace&)>;

    /// @errors invalid_argument: a setting out of its range
    [[nodiscard]] static Result<GestureRecogniser> create(const GestureSettings& settings = {});

    GestureRecogniser(GestureRecogniser&&) noexcept;
    GestureRecogniser& operator=(GestureRecogniser&&) noexcept;
    ~GestureRecogniser();

    /// Other settings from the next frame on; hands and what is active stay.
    /// @return what was active and is switched off, cancelled; `emit` is the last frame's stamp
    /// @errors invalid_argument: a setting out of its range; nothing changed
    /// @ownership borrowed until the next call of any member
    [[nodiscard]] Result<std::span<const GestureEvent>> set_settings(
        const GestureSettings& settings);
    [[nodiscard]] const GestureSettings& settings() const noexcept;

    /// While paused hands come and go, and no gesture begins.
    /// @return what was active, cancelled with `disengaged`
    /// @ownership borrowed until the next call of any member
    std::span<const GestureEvent> pause(bool paused);

    /// Takes the hands of one moment.
    /// @param frame interaction frame, mm; stamps must not decrease. Hands with positions that are
    ///        not finite count as not seen.
    /// @return what happened, in order; `emit` is the frame's stamp
    /// @ownership borrowed until the next call of any member
    std::span<const GestureEvent> push(const HandFrame& frame);

    /// What became of the frame of the last push().
    [[nodiscard]] RecogniseStatus status() const noexcept;

    /// How far a gesture has come that has not begun: press (the virtual force) and touch; 0..1, 0
    /// for others and for a hand that is not there.
    [[nodiscard]] double progress(int hand_id, GestureType type) const noexcept;

    /// The hand that owns the session (GestureSettings::engage); 0: nobody's. Its id changes
    /// without an event where a tracker has mixed up two hands.
    [[nodiscard]] int session_owner() const noexcept;

    /// Lets time pass without a frame, so that a lost hand is noticed: call it at 50 Hz or more
    /// when no frames come. `now` is on the frames' clock; one before the last frame does nothing.
    /// @return as push(); `sensor` is the last frame's stamp, `emit` is `now`
    std::span<const GestureEvent> advance(Stamp now);

    /// The stream is over: what is open ends, hands go.
    std::span<const GestureEvent> finish();

    /// Stopped from outside: what is open is cancelled with this reason, hands go.
    std::span<const GestureEvent> abandon(CancelReason reason);

    /// Forgets hands and time, for the next stream. Gesture ids go on counting.
    void reset() noexcept;

    /// Hears every transition and every reason not to. Empty turns it off.
    /// @thread called inside push() and its like
    void set_trace(TraceSink sink);

 private:
    struct Impl;
    explicit GestureRecogniser(std::unique_ptr<Impl> impl) noexcept;
    std::unique_ptr<Impl> impl_;
};

}  // namespace xtrack
