// SPDX-License-Identifier: Apache-2.0
//
//                settled              admitted
//   appearing ─────────▶ entering ─────────────▶ present      (settled: hand begin)
//      │   (in view when the stream began: settled goes to present)
//      │                    │ unseen               │ unseen
//      │                    ▼                      ▼
//      │                  frozen ◀─────────────────┘   seen: back to where it was
//      │ unseen             │ expired: everything is cancelled
//      ▼                    ▼          seen              settled
//    gone ◀────────────── lost ─────────────▶ returning ─────────▶ present
//         forgotten:        ▲                     │ unseen
//         hand end          └─────────────────────┘
#include "gestures/recognise/presence.hpp"

namespace xtrack::recognise {

const char* Presence::name(State s) {
    switch (s) {
        case State::appearing: return "appearing";
        case State::entering: return "entering";
        case State::present: return "present";
        case State::frozen: return "frozen";
        case State::lost: return "lost";
        case State::returning: return "returning";
        case State::gone: return "gone";
    }
    return "?";
}

const char* Presence::name(Event e) {
    switch (e) {
        case Event::seen: return "seen";
        case Event::unseen: return "unseen";
        case Event::settled: return "settled";
        case Event::admitted: return "admitted";
        case Event::expired: return "expired";
        case Event::forgotten: return "forgotten";
    }
    return "?";
}

void Presence::appear(Stamp now, bool in_view) {
    state_ = State::appearing;
    in_view_ = in_view;
    announced_ = false;
    first_seen_ = now;
    seen_again_ = now;
    last_seen_ = now;
}

Presence::Step Presence::pass(const Times& times, Stamp now) {
    const Duration unseen = now - last_seen_;
    switch (state_) {
        case State::appearing:
        case State::returning:
            // Only what was seen counts, so the newest sight is the clock here.
            if (last_seen_ - seen_again_ >= times.valid) {
                return handle(Event::settled);
            }
            break;
        case State::entering:
            if (last_seen_ - first_seen_ >= times.lockout) {
                return handle(Event::admitted);
            }
            break;
        case State::frozen:
            if (unseen >= times.freeze) {
                return handle(Event::expired);
            }
            break;
        case State::lost:
            if (unseen >= times.gone) {
                return handle(Event::forgotten);
            }
            break;
        case State::present:
        case State::gone: break;
    }
    // No frame said that the hand is away, but none showed it either.
    if (followed() && unseen >= times.freeze) {
        return handle(Event::unseen);
    }
    return {state_, state_, Event::seen, true};
}

Presence::Step Presence::see(Stamp now) {
    if (state_ == State::lost) {
        seen_again_ = now;
    }
    last_seen_ = now;
    return handle(Event::seen);
}

Presence::Step Presence::miss(Stamp /*now*/) { return handle(Event::unseen); }

Presence::Step Presence::handle(Event event) { return recognise::step(state_, event, next(event)); }

std::optional<Presence::State> Presence::next(Event event) {
    switch (state_) {
        case State::appearing: return appearing(event);
        case State::entering: return entering(event);
        case State::present: return present(event);
        case State::frozen: return frozen(event);
        case State::lost: return lost(event);
        case State::returning: return returning(event);
        case State::gone: return gone(event);
    }
    return std::nullopt;
}

std::optional<Presence::State> Presence::appearing(Event event) {
    switch (event) {
        case Event::seen: return State::appearing;
        case Event::unseen: return State::gone;
        case Event::settled: announced_ = true; return in_view_ ? State::present : State::entering;
        case Event::admitted:
        case Event::expired:
        case Event::forgotten: break;
    }
    return std::nullopt;
}

std::optional<Presence::State> Presence::entering(Event event) {
    switch (event) {
        case Event::seen: return State::entering;
        case Event::unseen: thawed_ = State::entering; return State::frozen;
        case Event::admitted: return State::present;
        case Event::settled:
        case Event::expired:
        case Event::forgotten: break;
    }
    return std::nullopt;
}

std::optional<Presence::State> Presence::present(Event event) {
    switch (event) {
        case Event::seen: return State::present;
        case Event::unseen: thawed_ = State::present; return State::frozen;
        case Event::settled:
        case Event::admitted:
        case Event::expired:
        case Event::forgotten: break;
    }
    return std::nullopt;
}

std::optional<Presence::State> Presence::frozen(Event event) {
    switch (event) {
        case Event::seen: return thawed_;
        case Event::unseen: return State::frozen;
        case Event::expired: return State::lost;
        case Event::settled:
        case Event::admitted:
        case Event::forgotten: break;
    }
    return std::nullopt;
}

std::optional<Presence::State> Presence::lost(Event event) {
    switch (event) {
        case Event::seen: return State::returning;
        case Event::unseen: return State::lost;
        case Event::forgotten: return State::gone;
        case Event::settled:
        case Event::admitted:
        case Event::expired: break;
    }
    return std::nullopt;
}

std::optional<Presence::State> Presence::returning(Event event) {
    switch (event) {
        case Event::seen: return State::returning;
        case Event::unseen: return State::lost;
        case Event::settled: return thawed_;
        case Event::admitted:
        case Event::expired:
        case Event::forgotten: break;
    }
    return std::nullopt;
}

std::optional<Presence::State> Presence::gone(Event event) {
    switch (event) {
        case Event::unseen: return State::gone;
        case Event::seen:
        case Event::settled:
        case Event::admitted:
        case Event::expired:
        case Event::forgotten: break;
    }
    return std::nullopt;
}

}  // namespace xtrack::recognise
