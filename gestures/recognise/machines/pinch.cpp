// SPDX-License-Identifier: Apache-2.0
//
//         opened          closed             held (begin)
//   away ───────▶ armed ─────────▶ touching ─────────────▶ pinched ⟲ (update)
//    ▲   ◀───────  ▲  ◀──────────    │                        │
//    │    stale    │    released     │ spoilt                 │ released, finished (end)
//    │             │ opened          ▼                        │ dropped (cancel)
//    │             └───────────── spoilt                      │
//    └────────────────────────────────────────────────────────┘
//
// Armed means that the fingers were seen apart a moment ago; without that approach a hand that is
// merely held closed would pinch. Spoilt is a closing that was something else: a fist, a number,
// a hand that never came to rest.
#include "gestures/recognise/machines/pinch.hpp"

#include <algorithm>
#include <cmath>

namespace xtrack::recognise {

namespace {

// The hand before the fingers close, for comparison with the hand while they touch.
constexpr Duration kPoseWindow = std::chrono::milliseconds{300};
// An aperture that is not known for so long is a finger that is lost. Longer than a hand's 120 ms:
// fingertips that touch are hard to see apart, and the hand itself is in view.
constexpr Duration kApertureLost = std::chrono::milliseconds{300};
// The fingers must be seen on their way: in this share of the samples of pinch_approach_ms. Cameras
// that see a hand well know 0.75 and more, a hand whose tips come and go 0.6 and less.
constexpr double kApproachShare = 0.65;
constexpr double kSmallestWayMm = 1.0;
// A pinch that must open by more than this would not open any more.
constexpr double kMostNoiseMm = 6.0;
constexpr double kCapShare = 1.25;  // of pinch_close_mm: a hand length may be measured badly

class Mean {
 public:
    void add(double value) {
        sum_ += value;
        ++count_;
    }
    /// -1 where nothing was known; everything averaged here is positive.
    [[nodiscard]] double value() const { return count_ > 0 ? sum_ / count_ : -1.0; }

 private:
    double sum_ = 0.0;
    int count_ = 0;
};

/// The hand before the fingers closed.
struct Before {
    std::array<Mean, kFingerCount> extension;
    Mean thumb_to_middle_mm;
    const MotionSample* open = nullptr;  ///< the last moment they were apart
};

Before look_back(const MotionHistory& history, Stamp open_at) {
    Before before;
    for (std::size_t i = 0; i < history.size(); ++i) {
        const MotionSample& past = history.at(i);
        if (past.stamp > open_at) {
            continue;
        }
        if (open_at - past.stamp > kPoseWindow) {
            break;
        }
        if (before.open == nullptr) {
            before.open = &past;
        }
        for (std::size_t f = 0; f < kFingerCount; ++f) {
            if (past.extension[f] >= 0.0F) {
                before.extension[f].add(static_cast<double>(past.extension[f]));
            }
        }
        if (past.thumb_to_middle_mm >= 0.0F) {
            before.thumb_to_middle_mm.add(static_cast<double>(past.thumb_to_middle_mm));
        }
    }
    return before;
}

double blur_mm(const MotionHistory& history, std::size_t back, const GestureSettings& s) {
    return history.smear_mm(from_ms(s.velocity_window_ms), back);
}

/// Share of samples before `closed_at` in which the aperture was known and could be believed.
double approach_seen(const MotionHistory& history, Stamp closed_at, const GestureSettings& s) {
    const Duration window = from_ms(s.pinch_approach_ms);
    int all = 0;
    int seen = 0;
    for (std::size_t i = 0; i < history.size(); ++i) {
        const MotionSample& past = history.at(i);
        if (closed_at - past.stamp > window) {
            break;
        }
        if (past.stamp < closed_at) {
            ++all;
            seen += past.aperture_mm >= 0.0F && blur_mm(history, i, s) <= s.pinch_blur_mm ? 1 : 0;
        }
    }
    return all > 0 ? static_cast<double>(seen) / all : 0.0;
}

/// Three sigma above what closes, by the noise that the hand itself shows. The aperture is a mean.
double release_mm(const Context& c) {
    const GestureSettings& s = c.settings;
    return s.pinch_close_mm + Signal::apart(s.pinch_release_mm - s.pinch_close_mm,
                                            std::min(c.signal.aperture_noise_mm, kMostNoiseMm));
}

double close_mm(const Context& c) {
    const double by_hand_mm =
        c.settings.pinch_close_share * static_cast<double>(c.history.newest().hand_length_mm);
    return std::clamp(by_hand_mm, c.settings.pinch_close_mm, kCapShare * c.settings.pinch_close_mm);
}

}  // namespace

const char* PinchMachine::name(State s) {
    switch (s) {
        case State::away: return "away";
        case State::armed: return "armed";
        case State::touching: return "touching";
        case State::pinched: return "pinched";
        case State::carried: return "carried";
        case State::spoilt: return "spoilt";
    }
    return "?";
}

const char* PinchMachine::name(Event e) {
    switch (e) {
        case Event::opened: return "opened";
        case Event::between: return "between";
        case Event::stale: return "stale";
        case Event::closed: return "closed";
        case Event::held: return "held";
        case Event::spoilt: return "spoilt";
        case Event::released: return "released";
        case Event::superseded: return "superseded";
        case Event::dropped: return "dropped";
        case Event::finished: return "finished";
    }
    return "?";
}

void PinchMachine::update(const Context& c) {
    const Stamp now = c.history.newest().stamp;
    if (c.gate != Gate::open && c.gate != Gate::entering) {
        drop(c, reason_of(c.gate), why(c.gate));
        return;
    }
    if (c.taken && state_ != State::carried) {
        drop(c, CancelReason::superseded, "another gesture has the hand");
        return;
    }
    const double aperture_mm = c.history.recent(&MotionSample::aperture_mm);
    if (aperture_mm < 0.0) {
        if (now - aperture_at_ >= kApertureLost) {
            drop(c, CancelReason::lost, "the fingers are lost");
        }
        return;  // frozen, like a hand that is not seen
    }
    aperture_at_ = now;
    Refusal refusal;
    const Event event = judge(c, aperture_mm, refusal);
    handle(c, event, refusal);
    if (event == Event::closed && state_ == State::touching) {
        refusal = {};
        handle(c, judge(c, aperture_mm, refusal), refusal);  // pinch_hold_ms may be 0
    }
}

void PinchMachine::drop(const Context& c, CancelReason reason, const char* why) {
    if (state_ != State::away) {
        handle(c, Event::dropped, {why, 0.0, 0.0}, reason);
    }
}

void PinchMachine::carry(const Context& c) {
    if (state_ == State::pinched) {
        handle(c, Event::superseded, {}, CancelReason::superseded);
    }
}

void PinchMachine::finish(const Context& c) {
    if (closed()) {
        handle(c, Event::finished);
    }
}

void PinchMachine::handle(const Context& c, Event event, const Refusal& refusal,
                          CancelReason reason) {
    broke_ = event == Event::dropped && closed() ? reason : CancelReason::none;
    reporter_.report(c, step(state_, event, next(c, event, reason)), refusal,
                     [](auto of) { return name(of); });
}

std::optional<PinchMachine::State> PinchMachine::next(const Context& c, Event event,
                                                      CancelReason reason) {
    switch (state_) {
        case State::away: return away(c, event);
        case State::armed: return armed(c, event);
        case State::touching: return touching(c, event);
        case State::pinched: return pinched(c, event, reason);
        case State::carried: return carried(event);
        case State::spoilt: return spoilt(c, event);
    }
    return std::nullopt;
}

std::optional<PinchMachine::State> PinchMachine::away(const Context& c, Event event) {
    switch (event) {
        case Event::opened: open_at_ = c.sensor; return State::armed;
        case Event::between:
        case Event::closed:
        case Event::dropped: return State::away;
        case Event::stale:
        case Event::held:
        case Event::spoilt:
        case Event::released:
        case Event::superseded:
        case Event::finished: break;
    }
    return std::nullopt;
}

std::optional<PinchMachine::State> PinchMachine::armed(const Context& c, Event event) {
    switch (event) {
        case Event::opened: open_at_ = c.sensor; return State::armed;
        case Event::between: return State::armed;
        case Event::stale:
        case Event::dropped: return State::away;
        case Event::closed: closed_at_ = c.sensor; return State::touching;
        case Event::held:
        case Event::spoilt:
        case Event::released:
        case Event::superseded:
        case Event::finished: break;
    }
    return std::nullopt;
}

std::optional<PinchMachine::State> PinchMachine::touching(const Context& c, Event event) {
    switch (event) {
        case Event::closed: return State::touching;
        case Event::held:
            onset_ = open_at_;
            gesture_id_ = c.next_gesture_id++;
            send(c, EventPhase::begin);
            return State::pinched;
        case Event::spoilt: return State::spoilt;
        case Event::released: return State::armed;
        case Event::dropped: return State::away;
        case Event::opened:
        case Event::between:
        case Event::stale:
        case Event::superseded:
        case Event::finished: break;
    }
    return std::nullopt;
}

std::optional<PinchMachine::State> PinchMachine::pinched(const Context& c, Event event,
                                                         CancelReason reason) {
    switch (event) {
        case Event::closed: send(c, EventPhase::update); return State::pinched;
        case Event::released:
        case Event::finished: send(c, EventPhase::end); return State::away;
        case Event::superseded: send(c, EventPhase::cancel, reason); return State::carried;
        case Event::dropped: send(c, EventPhase::cancel, reason); return State::away;
        case Event::opened:
        case Event::between:
        case Event::stale:
        case Event::held:
        case Event::spoilt: break;
    }
    return std::nullopt;
}

std::optional<PinchMachine::State> PinchMachine::carried(Event event) {
    switch (event) {
        case Event::closed: return State::carried;
        case Event::released:
        case Event::finished:
        case Event::dropped: return State::away;
        case Event::opened:
        case Event::between:
        case Event::stale:
        case Event::held:
        case Event::superseded:
        case Event::spoilt: break;
    }
    return std::nullopt;
}

std::optional<PinchMachine::State> PinchMachine::spoilt(const Context& c, Event event) {
    switch (event) {
        case Event::opened: open_at_ = c.sensor; return State::armed;
        case Event::between:
        case Event::closed: return State::spoilt;
        case Event::dropped: return State::away;
        case Event::stale:
        case Event::held:
        case Event::spoilt:
        case Event::released:
        case Event::superseded:
        case Event::finished: break;
    }
    return std::nullopt;
}

PinchMachine::Event PinchMachine::judge(const Context& c, double aperture_mm,
                                        Refusal& refusal) const {
    const GestureSettings& s = c.settings;
    const bool together = state_ == State::touching || closed();
    if (together) {
        if (aperture_mm >= release_mm(c)) {
            return Event::released;
        }
        if (closed()) {
            return Event::closed;
        }
        const double held_ms = to_ms(c.sensor - closed_at_ + c.history.unseen());
        // A graze that opens again is inside the hysteresis, but on its way out.
        const double inner_mm = 0.5 * (s.pinch_close_mm + release_mm(c));
        if (held_ms < s.pinch_hold_ms || aperture_mm > inner_mm) {
            return Event::closed;
        }
        if (c.gate == Gate::entering) {
            refusal = {"the hand enters", 0.0, 0.0};
            return Event::closed;
        }
        const double palm_mmps =
            static_cast<double>(c.history.velocity(from_ms(s.velocity_window_ms)).norm());
        if (palm_mmps > s.pinch_palm_mmps) {
            refusal = {"the palm moves", palm_mmps, s.pinch_palm_mmps};
            return held_ms > s.pinch_settle_ms ? Event::spoilt : Event::closed;
        }
        const double blur_now_mm = blur_mm(c.history, 0, s);
        if (blur_now_mm > s.pinch_blur_mm) {
            refusal = {"the palm moves too fast to see fingers", blur_now_mm, s.pinch_blur_mm};
            return held_ms > s.pinch_settle_ms ? Event::spoilt : Event::closed;
        }
        refusal = spoiler(c);
        return *refusal.why == '\0' ? Event::held : Event::spoilt;
    }
    if (aperture_mm >= std::max(s.pinch_open_mm, release_mm(c))) {
        return Event::opened;
    }
    if (state_ == State::armed && to_ms(c.sensor - open_at_) > s.pinch_approach_ms) {
        refusal = {"no approach", to_ms(c.sensor - open_at_), s.pinch_approach_ms};
        return Event::stale;
    }
    return aperture_mm <= close_mm(c) ? Event::closed : Event::between;
}

Refusal PinchMachine::spoiler(const Context& c) const {
    const GestureSettings& s = c.settings;
    const MotionSample& now = c.history.newest();
    const Before before = look_back(c.history, open_at_);

    const std::size_t closed = c.history.count_within(c.sensor - closed_at_) - 1;
    const double blur_then_mm = blur_mm(c.history, closed, s);
    if (blur_then_mm > s.pinch_blur_mm) {
        return {"the palm moved too fast to see fingers", blur_then_mm, s.pinch_blur_mm};
    }
    const double seen = approach_seen(c.history, closed_at_, s);
    if (seen < kApproachShare) {
        return {"the approach was not seen", seen, kApproachShare};
    }
    // A fist of a camera's hand shows in all three; one that merely merges with its neighbour does
    // not fold.
    const int wanted = now.from_joints ? 1 : 3;
    int folding = 0;
    for (const Finger finger : {Finger::middle, Finger::ring, Finger::little}) {
        const auto f = static_cast<std::size_t>(finger);
        const double was = before.extension[f].value();
        if (was < 0.0 || now.extension[f] < 0.0F) {
            continue;
        }
        const double folded = was - static_cast<double>(now.extension[f]);
        if (folded > s.pinch_others_fold && ++folding == wanted) {
            return {"another finger folds with it", folded, s.pinch_others_fold};
        }
    }
    const double free_mm = before.thumb_to_middle_mm.value();
    if (free_mm >= 0.0 && free_mm < s.pinch_thumb_free_mm) {
        return {"the thumb was not free", free_mm, s.pinch_thumb_free_mm};
    }
    const double bunch_mm = static_cast<double>(now.thumb_to_middle_mm);
    const double outer = static_cast<double>(now.outer_extension());
    if (bunch_mm >= 0.0 && bunch_mm <= s.pinch_bunch_mm && outer > s.pinch_bunch_extension) {
        return {"all fingertips together", outer, s.pinch_bunch_extension};
    }
    if (now.knuckle_known && before.open != nullptr && before.open->knuckle_known) {
        const double thumb_mm = static_cast<double>(
            (now.thumb_from_knuckle_mm - before.open->thumb_from_knuckle_mm).norm());
        const double index_mm = static_cast<double>(
            (now.index_from_knuckle_mm - before.open->index_from_knuckle_mm).norm());
        const double share = index_mm / std::max(thumb_mm + index_mm, kSmallestWayMm);
        if (share < s.pinch_index_share) {
            return {"the index stays", share, s.pinch_index_share};
        }
    }
    return {};
}

void PinchMachine::send(const Context& c, EventPhase phase, CancelReason reason) {
    GestureEvent e = event_of(c, GestureType::pinch, phase);
    e.gesture_id = gesture_id_;
    e.cancel_reason = reason;
    e.onset = onset_;
    const TrackedPoint& thumb = c.hand.fingertip(Finger::thumb);
    const TrackedPoint& index = c.hand.fingertip(Finger::index);
    if (thumb.valid && index.valid && thumb.position_mm.allFinite() &&
        index.position_mm.allFinite()) {
        e.position_mm = 0.5F * (thumb.position_mm + index.position_mm);
    }
    e.value = std::clamp(c.hand.pinch_value, 0.0F, 1.0F);
    e.progress = 1.0F;
    c.out.add(e);
}

}  // namespace xtrack::recognise
