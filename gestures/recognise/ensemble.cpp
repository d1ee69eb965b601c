// SPDX-License-Identifier: Apache-2.0
#include "gestures/recognise/ensemble.hpp"

#include <algorithm>

namespace xtrack::recognise {

namespace {

bool usable(const Hand& hand, const GestureSettings& s) {
    return static_cast<double>(hand.confidence) >= s.hand_confidence && hand.palm_mm.allFinite();
}

}  // namespace

Context Ensemble::context(const HandSlot& slot, Stamp sensor, Stamp emit, Gate gate) {
    return {settings_,        slot.history, slot.hand, slot.meter.signal(),
            sensor,           emit,         gate,      false,
            next_gesture_id_, out_,         log_};
}

Presence::Times Ensemble::times() const {
    return {from_ms(settings_.hand_valid_ms), from_ms(settings_.entry_lockout_ms),
            from_ms(settings_.lost_freeze_ms), from_ms(settings_.gone_ms)};
}

Gate Ensemble::gate_of(HandSlot& slot) const {
    if (paused_) {
        return Gate::paused;
    }
    // Who may not act does not ask for the session either.
    const bool in = !settings_.engage || engagement_.is_in(slot.hand.id);
    return !slot.presence.may_act()   ? Gate::entering
           : slot.hand.touches_border ? Gate::border
           : slot.silence.is_silent() ? Gate::fist
           : !in                      ? Gate::bystander
                                      : Gate::open;
}

void Ensemble::send_hand(const HandSlot& slot, EventPhase phase, Stamp sensor, Stamp emit) {
    GestureEvent e = event_of(context(slot, sensor, emit), GestureType::hand, phase);
    if (phase == EventPhase::begin) {
        e.progress = 1.0F;
    }
    out_.add(e);
}

/// What a change of presence means for the gestures of the hand.
void Ensemble::apply(HandSlot& slot, const Presence::Step& step, Stamp sensor, Stamp emit) {
    if (step.before == step.after && step.possible) {
        return;
    }
    log_.write({sensor, slot.hand.id, "hand", Presence::name(step.before),
                Presence::name(step.event), Presence::name(step.after), "", 0.0, 0.0,
                !step.possible});
    if (step.event == Presence::Event::settled && step.before == Presence::State::appearing) {
        send_hand(slot, EventPhase::begin, sensor, emit);
    }
    if (step.after == Presence::State::lost) {
        cancel_all(slot, CancelReason::lost, "the hand is lost", sensor, emit);
        slot.forget_motion();
    }
    if (step.after == Presence::State::gone) {
        leave(slot, sensor, emit);
    }
}

void Ensemble::leave(HandSlot& slot, Stamp sensor, Stamp emit) {
    engagement_.lose(context(slot, sensor, emit), slot.hand.id);
    if (slot.presence.announced()) {
        send_hand(slot, EventPhase::end, sensor, emit);
    }
    slot.used = false;
}

bool Ensemble::is_two_handed(const HandSlot& slot) const noexcept {
    return (zoom_.holds() || rotate_.holds()) &&
           (slot.hand.id == pair_[0] || slot.hand.id == pair_[1]);
}

void Ensemble::cancel_all(HandSlot& slot, CancelReason reason, const char* why, Stamp sensor,
                          Stamp emit) {
    const Context c = context(slot, sensor, emit);
    slot.drop(c, reason, why);
    if (slot.hand.id == pair_[0] || slot.hand.id == pair_[1]) {
        zoom_.drop(c, reason, why);
        rotate_.drop(c, reason, why);
        pair_ = {};
    }
}

/// A long gap brings several changes at once: frozen, lost, gone.
void Ensemble::pass_time(HandSlot& slot, Stamp now, Stamp sensor, Stamp emit) {
    while (slot.used) {
        const Presence::Step step = slot.presence.pass(times(), now);
        if (step.before == step.after) {
            return;
        }
        apply(slot, step, sensor, emit);
    }
}

HandSlot* Ensemble::slot_of(int id) {
    const auto slot =
        std::ranges::find_if(slots_, [&](const HandSlot& s) { return s.used && s.hand.id == id; });
    return slot == slots_.end() ? nullptr : &*slot;
}

HandSlot& Ensemble::new_slot(const Hand& hand, Stamp now, bool in_view) {
    HandSlot* free = slots_.data();
    for (HandSlot& slot : slots_) {
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
        leave(*free, now, now);
    }
    free->begin(hand, now, in_view);
    return *free;
}

/// Which hands are there, and since when.
void Ensemble::see(const HandFrame& frame, bool first) {
    const Stamp now = frame.stamp;
    for (HandSlot& slot : slots_) {
        slot.seen_now = false;
        pass_time(slot, now, now, now);
    }
    for (const Hand& hand : frame.all().first(std::min(frame.count, kMaxHands))) {
        if (!usable(hand, settings_)) {
            continue;
        }
        HandSlot* slot = slot_of(hand.id);
        if (slot != nullptr && slot->seen_now) {
            continue;  // two hands of one id: the first is believed
        }
        if (slot == nullptr) {
            slot = &new_slot(hand, now, first);
        } else {
            slot->hand = hand;
            apply(*slot, slot->presence.see(now), now, now);
        }
        slot->seen_now = true;
    }
    for (HandSlot& slot : slots_) {
        if (slot.used && !slot.seen_now) {
            apply(slot, slot.presence.miss(now), now, now);
        }
        pass_time(slot, now, now, now);
        if (slot.used && slot.seen_now) {
            slot.follow(now);
            if (slot.jumped) {
                slot.presence.enter_anew(now);
            }
            slot.seen_now = slot.presence.followed() && slot.add(now, frame.span);
        }
    }
}

/// Whose session it is.
void Ensemble::engage(Stamp now) {
    if (!settings_.engage || paused_) {
        return;
    }
    std::array<HandReport, kSlots> reports{};
    std::size_t count = 0;
    HandSlot* any = nullptr;
    for (HandSlot& slot : slots_) {
        if (!slot.used || !slot.seen_now) {
            continue;
        }
        any = &slot;
        const Vec3f velocity = slot.history.velocity(from_ms(settings_.velocity_window_ms));
        reports[count++] = {.hand = &slot.hand,
                            .length_mm = slot.size.length_mm(),
                            .speed_mmps = static_cast<double>(velocity.norm()),
                            .present = slot.presence.may_act() && !slot.hand.touches_border,
                            .summons = slot.summons,
                            .active = slot.was_active,
                            .jumped = slot.jumped,
                            .expected_mm = slot.expected_mm,
                            .reach_mm = slot.reach_mm};
    }
    if (any == nullptr) {
        return;
    }
    engagement_.update(context(*any, now, now), {reports.data(), count});
    for (HandSlot& slot : slots_) {
        if (slot.used && !engagement_.is_in(slot.hand.id) && slot.holds()) {
            cancel_all(slot, CancelReason::disengaged, "the session is over", now, now);
        }
    }
}

void Ensemble::act(HandSlot& slot, Stamp now) {
    slot.silence.update(context(slot, now, now), slot.was_active);
    Context c = context(slot, now, now, gate_of(slot));
    slot.update(c, is_two_handed(slot));
}

/// Two hands that grip: those of the gesture that is active, else the first two of one body.
TwoGrips Ensemble::two_grips() {
    std::array<HandSlot*, 2> slots{};
    std::size_t count = 0;
    const auto arm = [](const HandSlot& slot) { return arm_of(slot.hand, slot.size.length_mm()); };
    for (HandSlot& slot : slots_) {
        if (!slot.used || count == slots.size()) {
            continue;
        }
        const bool paired = slot.hand.id == pair_[0] || slot.hand.id == pair_[1];
        const bool free = pair_[0] == 0 && slot.fingers().held && gate_of(slot) == Gate::open;
        const bool fits =
            count == 0 || is_possible(same_body(settings_, arm(*slots[0]), arm(slot)));
        if (paired || (free && fits)) {
            slots[count++] = &slot;
        }
    }
    TwoGrips grips;
    if (count < slots.size()) {
        return grips;
    }
    grips.held = true;
    for (HandSlot* slot : slots) {
        const Grip fingers = slot->fingers();
        const Gate gate = gate_of(*slot);
        grips.held = grips.held && fingers.held;
        if (gate != Gate::open) {
            grips.lost = true;
            grips.reason = reason_of(gate);
        } else if (fingers.broke != CancelReason::none) {
            grips.lost = true;
            grips.reason = fingers.broke;
        }
    }
    grips.hand_id = slots[0]->hand.id;
    grips.other_hand_id = slots[1]->hand.id;
    grips.palm_mm = slots[0]->history.newest().pointer_mm;
    grips.other_palm_mm = slots[1]->history.newest().pointer_mm;
    return grips;
}

void Ensemble::act_together(Stamp now) {
    if (!settings_.two_hand_zoom && !settings_.two_hand_rotate) {
        return;
    }
    for (const HandSlot& slot : slots_) {
        const bool paired = slot.hand.id == pair_[0] || slot.hand.id == pair_[1];
        if (slot.used && paired && (!slot.seen_now || slot.history.size() == 0)) {
            return;  // frozen: nothing is known of it just now
        }
    }
    const TwoGrips grips = two_grips();
    HandSlot* const one = slot_of(grips.hand_id);
    HandSlot* const other = slot_of(grips.other_hand_id);
    if (one == nullptr || other == nullptr) {
        return;
    }
    const Context c = context(*one, now, now);
    const Context other_c = context(*other, now, now);
    const auto turn = [&](TwoHandMachine& machine, bool wanted) {
        if (!wanted) {
            return;
        }
        if (machine.begins(c, grips)) {
            for (const Context* hand : {&c, &other_c}) {
                HandSlot& slot = hand == &c ? *one : *other;
                slot.machines.drag.drop(*hand, CancelReason::superseded, "two hands do it");
                slot.machines.carry(*hand);
            }
        }
        machine.update(c, grips);
    };
    turn(zoom_, settings_.two_hand_zoom);
    turn(rotate_, settings_.two_hand_rotate);
    if (grips.held && !grips.lost) {
        pair_ = {grips.hand_id, grips.other_hand_id};
    } else {
        pair_ = {};
    }
}

void Ensemble::push(const HandFrame& frame, bool first) {
    out_.clear();
    out_.set_metric(frame.metric);
    last_ = frame.stamp;
    see(frame, first);
    engage(last_);
    for (HandSlot& slot : slots_) {
        if (slot.used && slot.seen_now) {
            act(slot, last_);
        }
    }
    act_together(last_);
}

void Ensemble::advance(Stamp now) {
    out_.clear();
    for (HandSlot& slot : slots_) {
        pass_time(slot, now, last_, now);
    }
}

void Ensemble::finish() {
    out_.clear();
    for (HandSlot& slot : slots_) {
        if (!slot.used) {
            continue;
        }
        const Context c = context(slot, last_, last_);
        if (slot.hand.id == pair_[0]) {
            zoom_.finish(c);
            rotate_.finish(c);
        }
        slot.finish(c);
        if (slot.hand.id == engagement_.owner()) {
            engagement_.finish(c);
        }
        leave(slot, last_, last_);
    }
    reset();
}

void Ensemble::abandon(CancelReason reason) {
    out_.clear();
    for (HandSlot& slot : slots_) {
        if (!slot.used) {
            continue;
        }
        cancel_all(slot, reason, "stopped", last_, last_);
        if (slot.hand.id == engagement_.owner()) {
            engagement_.drop(context(slot, last_, last_), reason, "stopped");
        }
        leave(slot, last_, last_);
    }
    reset();
}

void Ensemble::reset() {
    for (HandSlot& slot : slots_) {
        slot.used = false;
    }
    zoom_ = TwoHandMachine{GestureType::two_hand_zoom};
    rotate_ = TwoHandMachine{GestureType::two_hand_rotate};
    pair_ = {};
    engagement_ = {};
}

void Ensemble::set_settings(const GestureSettings& settings) {
    out_.clear();
    for (HandSlot& slot : slots_) {
        if (!slot.used) {
            continue;
        }
        const Context c = context(slot, last_, last_);
        slot.switch_off(c, settings);
        if (slot.hand.id == pair_[0]) {
            if (!settings.two_hand_zoom) {
                zoom_.drop(c, CancelReason::disengaged, "switched off");
            }
            if (!settings.two_hand_rotate) {
                rotate_.drop(c, CancelReason::disengaged, "switched off");
            }
        }
        if (!settings.engage && slot.hand.id == engagement_.owner()) {
            engagement_.drop(c, CancelReason::disengaged, "switched off");
        }
    }
    settings_ = settings;
}

void Ensemble::pause(bool paused) {
    out_.clear();
    if (paused && !paused_) {
        for (HandSlot& slot : slots_) {
            if (slot.used) {
                cancel_all(slot, CancelReason::disengaged, "paused", last_, last_);
                if (slot.hand.id == engagement_.owner()) {
                    engagement_.drop(context(slot, last_, last_), CancelReason::disengaged,
                                     "paused");
                }
            }
        }
    }
    paused_ = paused;
}

double Ensemble::progress(int hand_id, GestureType type) const noexcept {
    for (const HandSlot& slot : slots_) {
        if (slot.used && slot.hand.id == hand_id) {
            return type == GestureType::press   ? slot.machines.press.force()
                   : type == GestureType::touch ? slot.machines.touch.progress(settings_)
                                                : 0.0;
        }
    }
    return 0.0;
}

}  // namespace xtrack::recognise
