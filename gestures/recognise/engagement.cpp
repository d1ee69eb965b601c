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

// Palm to elbow of an adult; a child's is shorter, but so are the distances that it is used for.
constexpr float kPalmToElbowMm = 330.0F;
constexpr float kSureOfSide = 0.8F;

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

bool is_sure(const Hand& hand) {
    return hand.chirality != Chirality::unknown && hand.chirality_confidence >= kSureOfSide;
}

}  // namespace

SameBody same_body(const GestureSettings& s, const Hand& a, const Hand& b) noexcept {
    const bool sides = is_sure(a) && is_sure(b);
    if (sides && a.chirality == b.chirality) {
        return SameBody::no;
    }
    if (a.forearm.isZero() || b.forearm.isZero()) {
        return sides ? SameBody::yes : SameBody::unknown;
    }
    const Vec3f elbows =
        (b.palm_mm + kPalmToElbowMm * b.forearm) - (a.palm_mm + kPalmToElbowMm * a.forearm);
    const bool near = std::abs(static_cast<double>(elbows.x())) <= s.body_width_mm &&
                      std::abs(static_cast<double>(elbows.y())) <= s.body_height_mm &&
                      std::abs(static_cast<double>(elbows.z())) <= s.body_depth_mm;
    // Arms may cross, elbows do not.
    const bool crossed = sides && (a.chirality == Chirality::left) != (elbows.x() > 0.0F);
    return near && !crossed ? SameBody::yes : SameBody::no;
}

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

Engagement::Waiting& Engagement::waiting_of(int hand_id) {
    Waiting* oldest = waiting_.data();
    for (Waiting& w : waiting_) {
        if (w.hand_id == hand_id) {
            return w;
        }
        oldest = w.since < oldest->since ? &w : oldest;
    }
    *oldest = {};
    oldest->hand_id = hand_id;
    return *oldest;
}

bool Engagement::comes_back(const Context& c, const HandReport& r) {
    const auto off_mm = static_cast<double>((r.hand->palm_mm - owner_hand_.palm_mm).norm());
    return kept_ && !waiting_of(r.hand->id).other && off_mm <= c.settings.engage_return_mm &&
           in_zone(c.settings, r.hand->palm_mm, 0.0);
}

/// The hand that takes an idle session: one that has just signalled, else the one that has been
/// still in the zone for longest.
const HandReport* Engagement::summons(const Context& c, std::span<const HandReport> hands) {
    const GestureSettings& s = c.settings;
    const HandReport* first = nullptr;
    Stamp since;
    kept_ = kept_ && c.sensor <= kept_until_;
    for (const HandReport& r : hands) {
        Waiting& w = waiting_of(r.hand->id);
        const bool inside = in_zone(s, r.hand->palm_mm, 0.0);
        const double still_mmps =
            c.signal.still_mmps(s.engage_still_mmps, from_ms(s.velocity_window_ms));
        const bool moves = r.speed_mmps >= still_mmps;
        w.tired = w.tired && inside && !moves;
        const bool still = r.present && inside && !moves && !w.tired;
        if (still && !w.still) {
            w.since = c.sensor;
        }
        w.still = still;
        if (r.present && comes_back(c, r)) {
            return &r;
        }
        if (kept_) {
            continue;
        }
        if (r.present && inside && r.summons) {
            return &r;
        }
        const bool long_enough =
            s.engage_by_stillness && still && to_ms(c.sensor - w.since) >= s.engage_ms;
        if (long_enough && (first == nullptr || w.since < since)) {
            first = &r;
            since = w.since;
        }
    }
    return first;
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
        waiting_of(owner_).tired = true;
        reason_ = CancelReason::timeout;
        handle(c, Event::idle, {"it did nothing", to_ms(c.sensor - busy_at_), s.engage_idle_ms});
    } else {
        handle(c, Event::owned);
    }
}

void Engagement::watch_second(const Context& c, std::span<const HandReport> hands,
                              const HandReport* owner) {
    const GestureSettings& s = c.settings;
    const auto fits = [&](const HandReport& r) {
        return owner != nullptr && r.hand->id != owner_ && r.present &&
               in_zone(s, r.hand->palm_mm, s.zone_margin_mm) &&
               same_body(s, *owner->hand, *r.hand) == SameBody::yes;
    };
    if (second_ != 0) {
        // It stays while the owner is not seen for a moment; a wrong one goes at once.
        const HandReport* second = find(hands, second_);
        if (owner != nullptr && (second == nullptr || !fits(*second))) {
            second_ = 0;
        }
        return;
    }
    const HandReport* wants = find(hands, joining_);
    if (wants == nullptr || !fits(*wants)) {
        const auto other = std::ranges::find_if(hands, fits);
        joining_ = other == hands.end() ? 0 : other->hand->id;
        joining_since_ = c.sensor;
        return;
    }
    if (to_ms(c.sensor - joining_since_) >= s.engage_ms) {
        second_ = joining_;
        joining_ = 0;
    }
}

void Engagement::update(const Context& c, std::span<const HandReport> hands) {
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
    watch_owner(c, owner);
    if (is_engaged()) {
        watch_second(c, hands, owner);
    }
}

void Engagement::lose(const Context& c, int hand_id) {
    if (is_engaged() && hand_id == owner_) {
        // It may be back at once, and nobody takes its place meanwhile.
        kept_ = true;
        kept_until_ = c.sensor + from_ms(c.settings.engage_return_ms);
        for (Waiting& w : waiting_) {
            w.other = w.hand_id != owner_;
        }
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
            second_ = joining_ = 0;
            kept_ = false;
            onset_ = waiting_of(owner_).still ? waiting_of(owner_).since : c.sensor;
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
