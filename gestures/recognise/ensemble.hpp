// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include <xtrack/gesture_recogniser.hpp>

#include "gestures/recognise/context.hpp"
#include "gestures/recognise/engagement.hpp"
#include "gestures/recognise/hand_slot.hpp"
#include "gestures/recognise/machines/two_hands.hpp"

namespace xtrack::recognise {

/// All hands and what they do alone, together, and for the session.
class Ensemble {
 public:
    explicit Ensemble(const GestureSettings& settings) : settings_(settings) {}

    /// The hands of one moment. @param first of the stream: they are in view and do not enter
    void push(const HandFrame& frame, bool first);
    /// Time goes on without a frame.
    void advance(Stamp now);
    void finish();
    void abandon(CancelReason reason);
    void reset();
    void set_settings(const GestureSettings& settings);
    void pause(bool paused);

    [[nodiscard]] const GestureSettings& settings() const noexcept { return settings_; }
    [[nodiscard]] Outbox& out() noexcept { return out_; }
    [[nodiscard]] TransitionLog& log() noexcept { return log_; }
    [[nodiscard]] Stamp last_stamp() const noexcept { return last_; }
    [[nodiscard]] double progress(int hand_id, GestureType type) const noexcept;
    [[nodiscard]] int session_owner() const noexcept { return engagement_.owner(); }

 private:
    // Hands that are seen, and as many that were lost a moment ago and may come back.
    static constexpr std::size_t kSlots = 2 * kMaxHands;

    [[nodiscard]] Context context(const HandSlot& slot, Stamp sensor, Stamp emit,
                                  Gate gate = Gate::open);
    [[nodiscard]] Presence::Times times() const;
    [[nodiscard]] Gate gate_of(HandSlot& slot) const;
    void send_hand(const HandSlot& slot, EventPhase phase, Stamp sensor, Stamp emit);
    void apply(HandSlot& slot, const Presence::Step& step, Stamp sensor, Stamp emit);
    void pass_time(HandSlot& slot, Stamp now, Stamp sensor, Stamp emit);
    void cancel_all(HandSlot& slot, CancelReason reason, const char* why, Stamp sensor, Stamp emit);
    void leave(HandSlot& slot, Stamp sensor, Stamp emit);
    HandSlot* slot_of(int id);
    HandSlot& new_slot(const Hand& hand, Stamp now, bool in_view);
    void see(const HandFrame& frame, bool first);
    void engage(Stamp now);
    void act(HandSlot& slot, Stamp now);
    void act_together(Stamp now);
    [[nodiscard]] TwoGrips two_grips();
    [[nodiscard]] bool is_two_handed(const HandSlot& slot) const noexcept;

    GestureSettings settings_;
    std::array<HandSlot, kSlots> slots_;
    TwoHandMachine zoom_{GestureType::two_hand_zoom};
    TwoHandMachine rotate_{GestureType::two_hand_rotate};
    std::array<int, 2> pair_{};  ///< hands of zoom_ and rotate_; 0: none
    Engagement engagement_;
    Outbox out_{settings_};
    TransitionLog log_;
    bool paused_ = false;
    Stamp last_;
    int next_gesture_id_ = 1;
};

}  // namespace xtrack::recognise
