// SPDX-License-Identifier: Apache-2.0
//
//         summoned (begin)
//   idle ──────────────────▶ engaged ⟲ owned
//    ▲                          │
//    │  left, finished (end)    │
//    │  idle, lost, dropped     │
//    │  (cancel)                │
//    └──────────────────────────┘
#include "gestures/recognise/engagement.hpp"

#include <algorithm>
#include <cmath>

namespace xtrack::recognise {

namespace {

// Palms this near can be mixed up by a tracker, which then takes so long to see that sides and
// sizes do not fit any more.
constexpr float kMeetMm = 150.0F;
constexpr double kMixedUpMs = 5000.0;

bool in_zone(const GestureSettings& s, const Vec3f& p_mm, double margin_mm) {
    const auto within = [&](float value, double low, double high) {
        const auto v = static_cast<double>(value);
        return v >= low - margin_mm && v <= high + margin_mm;
    };
    return within(p_mm.x(), s.zone_left_mm, s.zone_right_mm) &&
           within(p_mm.y(), s.zone_bottom_mm, s.zone_top_mm) &&
           within(p_mm.z(), s.zone_near_mm, s.zone_far_mm);
}

const HandReport* find(std::span<const HandReport> hands, int hand_id) {
    const auto found =
        std::ranges::find_if(hands, [&](const HandReport& r) { return r.hand->id == hand_id; });
    return found == hands.end() ? nullptr : &*found;
}

}  // namespace

const char* Engagement::name(State s) {
    switch (s) {
        case State::idle: return "idle";
        case State::engaged: return "engaged";
    }
    return "?";
}

const char* Engagement::name(Event e) {
    switch (e) {
        case Event::waiting: return "waiting";
        case Event::summoned: return "summoned";
        case Event::owned: return "owned";
        case Event::left: return "left";
        case Event::idle: return "idle";
        case Event::lost: return "lost";
        case Event::dropped: return "dropped";
        case Event::finished: return "finished";
    }
    return "?";
}

bool Engagement::is_slow(const Context& c, const HandReport& r) const {
    return r.speed_mmps < c.signal.still_mmps(c.settings.engage_still_mmps,
                                              from_ms(c.settings.velocity_window_ms));
}

const HandReport* Engagement::returned(const Context& c, std::span<const HandReport> hands) {
    const GestureSettings& s = c.settings;
    const auto is_owner = [&](const HandReport& r) {
        const Acquaintance& one = company_.of(r.hand->id);
        const Acquaintance* before = company_.before(s, one);
        return in_zone(s, one.arm.palm_mm, 0.0) &&
               (r.hand->id == owner_ || (before != nullptr && before->hand_id == owner_));
    };
    const auto back = std::ranges::find_if(hands, is_owner);
    // Who is back in time but may not act yet is waited for.
    const double lockout_ms = s.hand_valid_ms + s.entry_lockout_ms;
    kept_ = c.sensor <= kept_until_ + from_ms(back == hands.end() ? 0.0 : lockout_ms);
    return kept_ && back != hands.end() && back->present ? &*back : nullptr;
}

/// The hand that takes an idle session: one that has just signalled, else the one that has been
/// still in the zone for longest.
const HandReport* Engagement::summons(const Context& c, std::span<const HandReport> hands) {
    const GestureSettings& s = c.settings;
    const HandReport* signalled = nullptr;
    const HandReport* first = nullptr;
    Stamp since;
    for (const HandReport& r : hands) {
        Acquaintance& one = company_.of(r.hand->id);
        const bool inside = in_zone(s, r.hand->palm_mm, 0.0);
        const bool slow = is_slow(c, r);
        one.tired = one.tired && inside && slow;
        const bool still = r.present && inside && slow && !one.tired;
        if (still && !one.still) {
            one.still_since = c.sensor;
        }
        one.still = still;
        if (r.present && inside && r.summons && signalled == nullptr) {
            signalled = &r;
        }
        const bool long_enough =
            s.engage_by_stillness && still && to_ms(c.sensor - one.still_since) >= s.engage_ms;
        if (long_enough && (first == nullptr || one.still_since < since)) {
            first = &r;
            since = one.still_since;
        }
    }
    if (kept_) {
        if (const HandReport* back = returned(c, hands)) {
            return back;
        }
    }
    if (kept_) {
        return nullptr;
    }
    const HandReport* taker = signalled != nullptr ? signalled : first;
    if (taker != nullptr) {
        company_.forget_trust();  // it was of another body
    }
    return taker;
}

const HandReport* Engagement::mixed_up(const Context& c, std::span<const HandReport> hands,
                                       const HandReport& owner, double ms) {
    const Arm& now = company_.of(owner_).arm;
    // Two ids change places from one frame to the next, or the hand that was the owner's is a new
    // one.
    const auto in_its_place = [&](const HandReport& r) {
        const bool comes = r.jumped || company_.of(r.hand->id).first_seen == c.sensor;
        return r.hand->id != owner_ && comes &&
               (r.hand->palm_mm - owner.expected_mm).norm() <= owner.reach_mm;
    };
    if (owner.jumped) {
        const auto other = std::ranges::find_if(hands, in_its_place);
        return other == hands.end() ? nullptr : &*other;
    }
    // Or they do it where the hands meet, and are seen to be the other ones after it.
    bool met = false;
    const HandReport* likely = nullptr;
    for (const HandReport& r : hands) {
        if (r.hand->id == owner_) {
            continue;
        }
        Acquaintance& one = company_.of(r.hand->id);
        if ((one.arm.palm_mm - now.palm_mm).norm() <= kMeetMm) {
            one.met = c.sensor;
        }
        if (one.met != Stamp{} && to_ms(c.sensor - one.met) <= kMixedUpMs) {
            met = true;
            likely = same_build(owner_arm_, one.arm) ? &r : likely;
        }
    }
    if (!met) {
        owner_arm_ = now;
    }
    other_ms_ = likely != nullptr && !same_build(owner_arm_, now) ? other_ms_ + ms : 0.0;
    return other_ms_ >= c.settings.engage_ms ? likely : nullptr;
}

void Engagement::hand_over(const Context& c, const HandReport& to) {
    Acquaintance& other = company_.of(owner_);
    Acquaintance& owner = company_.of(to.hand->id);
    // What is known of each goes with the hand; where they are has been noted under the new ids.
    other.trade_trust(owner);
    other.met = owner.met = Stamp{};
    other.arm.side = Chirality::unknown;
    other.arm.length_mm = 0.0F;
    owner.arm.side = owner_arm_.side;
    owner.arm.length_mm = owner_arm_.length_mm;
    second_ = second_ == to.hand->id ? owner_ : second_;
    owner_ = to.hand->id;
    other_ms_ = 0.0;
    handle(c, Event::owned, {"its hand has another id now", static_cast<double>(owner_), 0.0});
}

void Engagement::watch_owner(const Context& c, const HandReport* owner) {
    const GestureSettings& s = c.settings;
    if (owner == nullptr) {
        return;  // frozen; lose() comes when it is gone
    }
    owner_hand_ = *owner->hand;
    if (in_zone(s, owner->hand->palm_mm, s.zone_margin_mm)) {
        inside_at_ = c.sensor;
    }
    const auto moved_mm = static_cast<double>((owner->hand->palm_mm - rest_mm_).norm());
    if (owner->active || moved_mm > s.engage_idle_mm) {
        busy_at_ = c.sensor;
        rest_mm_ = owner->hand->palm_mm;
    }
    if (to_ms(c.sensor - inside_at_) >= s.engage_leave_ms) {
        handle(c, Event::left);
    } else if (to_ms(c.sensor - busy_at_) >= s.engage_idle_ms) {
        company_.of(owner_).tired = true;
        reason_ = CancelReason::timeout;
        handle(c, Event::idle, {"it did nothing", to_ms(c.sensor - busy_at_), s.engage_idle_ms});
    } else {
        handle(c, Event::owned);
    }
}

/// Who is the owner's second hand; only while the owner is seen.
void Engagement::watch_others(const Context& c, std::span<const HandReport> hands, double ms) {
    const GestureSettings& s = c.settings;
    const Arm owner = company_.of(owner_).arm;
    for (const HandReport& r : hands) {
        const int id = r.hand->id;
        Acquaintance& one = company_.of(id);
        const bool in = id == second_;
        if (id == owner_ || one.ruled_out || r.hand->touches_border ||
            to_ms(c.sensor - one.first_seen) < s.hand_valid_ms) {
            continue;
        }
        if (r.present && !one.asked) {
            one.asked = true;
            if (const Acquaintance* before = company_.before(s, one);
                before != nullptr && before->hand_id != owner_) {
                one.trust = before->trust;
                one.ruled_out = before->ruled_out;
            }
        }
        const bool inside = in_zone(s, r.hand->palm_mm, s.zone_margin_mm);
        one.outside_ms = inside ? 0.0 : one.outside_ms + ms;
        const SameBody verdict = same_body(s, owner, one.arm, in);
        if (inside || !is_possible(verdict)) {
            one.weigh(s, verdict, r.present && inside && is_slow(c, r), in, ms);
        }
        if (in && (one.trust <= 0.0 || one.ruled_out || one.outside_ms >= s.engage_leave_ms)) {
            second_ = 0;
            one.against_ms = one.same_side_ms = 0.0;
        }
        if (second_ == 0 && r.present && inside && one.trust >= 1.0 && !one.ruled_out) {
            second_ = id;
        }
        if (one.ruled_out) {
            handle(c, Event::owned, {"another body's hand", static_cast<double>(id), 0.0});
        }
    }
}

void Engagement::update(const Context& c, std::span<const HandReport> hands) {
    const double ms = company_.note(c.settings, hands, c.sensor);
    if (state() == State::idle) {
        if (const HandReport* hand = summons(c, hands)) {
            owner_hand_ = *hand->hand;
            handle(c, Event::summoned);
        } else {
            handle(c, Event::waiting);
        }
        return;
    }
    const HandReport* owner = find(hands, owner_);
    if (owner != nullptr) {
        if (const HandReport* real = mixed_up(c, hands, *owner, ms)) {
            hand_over(c, *real);
            owner = real;
        }
    }
    watch_owner(c, owner);
    if (is_engaged() && owner != nullptr) {
        watch_others(c, hands, ms);
    }
}

void Engagement::lose(const Context& c, int hand_id) {
    if (is_engaged() && hand_id == owner_) {
        // It may be back at once, and nobody takes its place meanwhile.
        kept_ = true;
        kept_until_ = c.sensor + from_ms(c.settings.engage_return_ms);
        reason_ = CancelReason::lost;
        handle(c, Event::lost);
    }
    second_ = hand_id == second_ ? 0 : second_;
}

void Engagement::drop(const Context& c, CancelReason reason, const char* why) {
    if (is_engaged()) {
        reason_ = reason;
        handle(c, Event::dropped, {why, 0.0, 0.0});
    }
}

void Engagement::finish(const Context& c) {
    if (is_engaged()) {
        handle(c, Event::finished);
    }
}

std::optional<EngageState> Engagement::next(const Context& c, Event event) {
    switch (state()) {
        case State::idle: return idle(c, event);
        case State::engaged: return engaged(c, event);
    }
    return std::nullopt;
}

std::optional<EngageState> Engagement::idle(const Context& c, Event event) {
    switch (event) {
        case Event::waiting: return State::idle;
        case Event::summoned:
            owner_ = owner_hand_.id;
            owner_arm_ = company_.of(owner_).arm;
            second_ = 0;
            other_ms_ = 0.0;
            kept_ = false;
            onset_ = company_.of(owner_).still ? company_.of(owner_).still_since : c.sensor;
            company_.forget_stillness();  // nobody looks at it while there is a session
            inside_at_ = busy_at_ = c.sensor;
            rest_mm_ = owner_hand_.palm_mm;
            gesture_id_ = c.next_gesture_id++;
            send(c, EventPhase::begin);
            return State::engaged;
        case Event::owned:
        case Event::left:
        case Event::idle:
        case Event::lost:
        case Event::dropped:
        case Event::finished: break;
    }
    return std::nullopt;
}

std::optional<EngageState> Engagement::engaged(const Context& c, Event event) {
    switch (event) {
        case Event::owned: return State::engaged;
        case Event::left:
        case Event::finished: send(c, EventPhase::end); return State::idle;
        case Event::idle:
        case Event::lost:
        case Event::dropped: send(c, EventPhase::cancel, reason_); return State::idle;
        case Event::waiting:
        case Event::summoned: break;
    }
    return std::nullopt;
}

void Engagement::send(const Context& c, EventPhase phase, CancelReason reason) const {
    GestureEvent e = event_of(c, GestureType::engage, phase);
    e.gesture_id = gesture_id_;
    e.cancel_reason = reason;
    e.hand_id = owner_hand_.id;
    e.hand = owner_hand_.chirality;
    e.hand_confidence = owner_hand_.chirality_confidence;
    e.confidence = owner_hand_.confidence;
    e.onset = onset_;
    e.position_mm = owner_hand_.palm_mm;
    e.velocity_mmps = owner_hand_.palm_velocity_mmps;
    e.progress = 1.0F;
    c.out.add(e);
}

}  // namespace xtrack::recognise
