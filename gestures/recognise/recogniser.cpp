// SPDX-License-Identifier: Apache-2.0
#include <xtrack/gesture_recogniser.hpp>

#include <algorithm>
#include <array>
#include <utility>

#include "gestures/recognise/hand_slot.hpp"

namespace xtrack {

namespace {

using recognise::Context;
using recognise::from_ms;
using recognise::Gate;
using recognise::HandSlot;
using recognise::Outbox;
using recognise::Presence;
using recognise::TransitionLog;

// Hands that are seen, and as many that were lost a moment ago and may come back.
constexpr std::size_t kSlots = 2 * kMaxHands;

bool usable(const Hand& hand, const GestureSettings& s) {
    return static_cast<double>(hand.confidence) >= s.hand_confidence && hand.palm_mm.allFinite();
}

}  // namespace

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
    explicit Impl(const GestureSettings& s) : settings(s) {}

    GestureSettings settings;
    std::array<HandSlot, kSlots> slots;
    Outbox out{settings};
    TransitionLog log;
    RecogniseStatus status = RecogniseStatus::ok;
    bool started = false;
    bool paused = false;
    Stamp last_stamp;
    int next_gesture_id = 1;

    Context context(const HandSlot& slot, Stamp sensor, Stamp emit, Gate gate = Gate::open) {
        return {settings, slot.history, slot.hand,       sensor, emit,
                gate,     false,        next_gesture_id, out,    log};
    }

    void send_hand(const HandSlot& slot, EventPhase phase, Stamp sensor, Stamp emit) {
        GestureEvent e = event_of(context(slot, sensor, emit), GestureType::hand, phase);
        if (phase == EventPhase::begin) {
            e.progress = 1.0F;
        }
        out.add(e);
    }

    /// What a change of presence means for the gestures of the hand.
    void apply(HandSlot& slot, const Presence::Step& step, Stamp sensor, Stamp emit) {
        if (step.before == step.after && step.possible) {
            return;
        }
        log.write({sensor, slot.hand.id, "hand", Presence::name(step.before),
                   Presence::name(step.event), Presence::name(step.after), "", 0.0, 0.0,
                   !step.possible});
        if (step.event == Presence::Event::settled && step.before == Presence::State::appearing) {
            send_hand(slot, EventPhase::begin, sensor, emit);
        }
        if (step.after == Presence::State::lost) {
            cancel_all(slot, CancelReason::lost, "the hand is lost", sensor, emit);
            slot.history.clear();
        }
        if (step.after == Presence::State::gone) {
            if (slot.presence.announced()) {
                send_hand(slot, EventPhase::end, sensor, emit);
            }
            slot.used = false;
        }
    }

    void cancel_all(HandSlot& slot, CancelReason reason, const char* why, Stamp sensor,
                    Stamp emit) {
        slot.drop(context(slot, sensor, emit), reason, why);
    }

    [[nodiscard]] Presence::Times times() const {
        return {from_ms(settings.hand_valid_ms), from_ms(settings.entry_lockout_ms),
                from_ms(settings.lost_freeze_ms), from_ms(settings.gone_ms)};
    }

    /// A long gap brings several changes at once: frozen, lost, gone.
    void pass_time(HandSlot& slot, Stamp now, Stamp sensor, Stamp emit) {
        while (slot.used) {
            const Presence::Step step = slot.presence.pass(times(), now);
            if (step.before == step.after) {
                return;
            }
            apply(slot, step, sensor, emit);
        }
    }

    HandSlot* slot_of(int id) {
        for (HandSlot& slot : slots) {
            if (slot.used && slot.hand.id == id) {
                return &slot;
            }
        }
        return nullptr;
    }

    HandSlot& new_slot(const Hand& hand, Stamp now, bool in_view) {
        HandSlot* free = slots.data();
        for (HandSlot& slot : slots) {
            if (!slot.used) {
                free = &slot;
                break;
            }
            if (slot.presence.last_seen() < free->presence.last_seen()) {
                free = &slot;
            }
        }
        if (free->used) {
            cancel_all(*free, CancelReason::lost, "the hand is lost", now, now);
            if (free->presence.announced()) {
                send_hand(*free, EventPhase::end, now, now);
            }
        }
        free->begin(hand, now, in_view);
        return *free;
    }

    void run_gestures(HandSlot& slot, Stamp now, Duration span) {
        if (!slot.presence.followed() ||
            !slot.history.add(recognise::sample_of(slot.hand, now, span))) {
            return;
        }
        const Gate gate = paused                     ? Gate::paused
                          : !slot.presence.may_act() ? Gate::entering
                          : slot.hand.touches_border ? Gate::border
                                                     : Gate::open;
        Context c = context(slot, now, now, gate);
        slot.update(c);
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
    Impl& m = *impl_;
    if (auto valid = validate(settings); !valid) {
        return valid.error();
    }
    m.out.clear();
    for (HandSlot& slot : m.slots) {
        if (slot.used) {
            slot.switch_off(m.context(slot, m.last_stamp, m.last_stamp), settings);
        }
    }
    m.settings = settings;
    return m.out.all();
}

const GestureSettings& GestureRecogniser::settings() const noexcept { return impl_->settings; }

std::span<const GestureEvent> GestureRecogniser::pause(bool paused) {
    Impl& m = *impl_;
    m.out.clear();
    if (paused && !m.paused) {
        for (HandSlot& slot : m.slots) {
            if (slot.used) {
                m.cancel_all(slot, CancelReason::disengaged, "paused", m.last_stamp, m.last_stamp);
            }
        }
    }
    m.paused = paused;
    return m.out.all();
}

std::span<const GestureEvent> GestureRecogniser::push(const HandFrame& frame) {
    Impl& m = *impl_;
    m.out.clear();
    m.out.set_metric(frame.metric);
    const Stamp now = frame.stamp;
    m.status = frame.coordinates != CoordinateFrame::interaction ? RecogniseStatus::wrong_frame
               : m.started && now < m.last_stamp                 ? RecogniseStatus::decreasing_stamp
               : m.started && now == m.last_stamp                ? RecogniseStatus::repeated_stamp
                                                                 : RecogniseStatus::ok;
    if (m.status != RecogniseStatus::ok) {
        return {};
    }
    const bool in_view = !m.started;
    m.started = true;
    m.last_stamp = now;

    for (HandSlot& slot : m.slots) {
        slot.seen_now = false;
        m.pass_time(slot, now, now, now);
    }
    for (const Hand& hand : frame.all().first(std::min(frame.count, kMaxHands))) {
        if (!usable(hand, m.settings)) {
            continue;
        }
        HandSlot* slot = m.slot_of(hand.id);
        if (slot != nullptr && slot->seen_now) {
            continue;  // two hands of one id: the first is believed
        }
        if (slot == nullptr) {
            slot = &m.new_slot(hand, now, in_view);
        } else {
            slot->hand = hand;
            m.apply(*slot, slot->presence.see(now), now, now);
        }
        slot->seen_now = true;
    }
    for (HandSlot& slot : m.slots) {
        if (slot.used && !slot.seen_now) {
            m.apply(slot, slot.presence.miss(now), now, now);
        }
        m.pass_time(slot, now, now, now);
        if (slot.used && slot.seen_now) {
            m.run_gestures(slot, now, frame.span);
        }
    }
    return m.out.all();
}

RecogniseStatus GestureRecogniser::status() const noexcept { return impl_->status; }

std::span<const GestureEvent> GestureRecogniser::advance(Stamp now) {
    Impl& m = *impl_;
    m.out.clear();
    if (!m.started || now <= m.last_stamp) {
        return {};
    }
    for (HandSlot& slot : m.slots) {
        m.pass_time(slot, now, m.last_stamp, now);
    }
    return m.out.all();
}

std::span<const GestureEvent> GestureRecogniser::finish() {
    Impl& m = *impl_;
    m.out.clear();
    for (HandSlot& slot : m.slots) {
        if (!slot.used) {
            continue;
        }
        slot.finish(m.context(slot, m.last_stamp, m.last_stamp));
        if (slot.presence.announced()) {
            m.send_hand(slot, EventPhase::end, m.last_stamp, m.last_stamp);
        }
        slot.used = false;
    }
    m.started = false;
    return m.out.all();
}

std::span<const GestureEvent> GestureRecogniser::abandon(CancelReason reason) {
    Impl& m = *impl_;
    m.out.clear();
    for (HandSlot& slot : m.slots) {
        if (!slot.used) {
            continue;
        }
        m.cancel_all(slot, reason, "stopped", m.last_stamp, m.last_stamp);
        if (slot.presence.announced()) {
            m.send_hand(slot, EventPhase::end, m.last_stamp, m.last_stamp);
        }
        slot.used = false;
    }
    m.started = false;
    return m.out.all();
}

void GestureRecogniser::reset() noexcept {
    for (HandSlot& slot : impl_->slots) {
        slot.used = false;
    }
    impl_->out.clear();
    impl_->started = false;
    impl_->status = RecogniseStatus::ok;
}

void GestureRecogniser::set_trace(TraceSink sink) { impl_->log.set_sink(std::move(sink)); }

}  // namespace xtrack
