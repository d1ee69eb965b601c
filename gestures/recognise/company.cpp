// SPDX-License-Identifier: Apache-2.0
#include "gestures/recognise/company.hpp"

#include <algorithm>
#include <utility>

#include "gestures/recognise/motion_history.hpp"

namespace xtrack::recognise {

namespace {

// Doubt grows as trust does, and no farther than this: whoever has stood beside for minutes has to
// fit seven times as long as one who has just come.
constexpr double kMostDoubt = 6.0;
// A gap in the frames is no evidence.
constexpr double kLongestStepMs = 100.0;

/// An owner is kept its session from when it is gone.
double remembered_ms(const GestureSettings& s) { return s.gone_ms + s.engage_return_ms; }

}  // namespace

void Acquaintance::forget_trust() noexcept {
    trust = against_ms = same_side_ms = 0.0;
    ruled_out = false;
}

void Acquaintance::trade_trust(Acquaintance& other) noexcept {
    std::swap(trust, other.trust);
    std::swap(against_ms, other.against_ms);
    std::swap(same_side_ms, other.same_side_ms);
    std::swap(ruled_out, other.ruled_out);
    std::swap(asked, other.asked);
    std::swap(outside_ms, other.outside_ms);
}

void Acquaintance::weigh(const GestureSettings& s, SameBody verdict, bool settled, bool in,
                         double ms) noexcept {
    const auto doubt = [&](double full_ms) {
        trust = std::max(std::min(trust, 0.0) - ms / full_ms, -kMostDoubt);
    };
    // What does not go on is forgotten as fast as it was learnt.
    const auto count = [&](double& sum_ms, bool goes_on) {
        sum_ms = std::max(sum_ms + (goes_on ? ms : -ms), 0.0);
    };
    count(against_ms, verdict == SameBody::no);
    count(same_side_ms, verdict == SameBody::same_side && in);
    switch (verdict) {
        case SameBody::no:
            ruled_out = against_ms >= (in ? s.engage_leave_ms : s.hand_valid_ms);
            trust = in && !ruled_out ? trust : std::min(trust, 0.0);
            break;
        case SameBody::same_side:
            // A tracker may change its mind.
            trust = in && same_side_ms < s.engage_leave_ms ? trust : std::min(trust, 0.0);
            break;
        case SameBody::far:
            if (!in) {
                doubt(s.hand_valid_ms);
            }
            break;
        case SameBody::unsure:
            if (!in) {
                doubt(s.engage_ms);
            }
            break;
        case SameBody::yes:
            if (settled) {
                trust = std::min(trust + ms / s.engage_ms, 1.0);
            } else if (!in) {
                trust = std::min(trust, 0.0);
            }
            break;
    }
}

double Company::note(const GestureSettings& s, std::span<const HandReport> hands, Stamp now) {
    for (const HandReport& r : hands) {
        Acquaintance& one = of(r.hand->id);
        const Arm arm = arm_of(*r.hand, r.length_mm);
        if (one.hand_id == 0 || to_ms(now - one.seen) > remembered_ms(s)) {
            one = {};
            one.hand_id = r.hand->id;
            one.first_seen = now;
            one.first = one.arm = arm;
        }
        // What was known once is not forgotten while it is not seen.
        const Arm was = one.arm;
        one.arm = arm;
        one.arm.side = arm.side != Chirality::unknown ? arm.side : was.side;
        one.arm.length_mm = arm.length_mm > 0.0F ? arm.length_mm : was.length_mm;
        one.seen = now;
    }
    const double ms = std::clamp(to_ms(now - last_), 0.0, kLongestStepMs);
    last_ = now;
    return ms;
}

Acquaintance& Company::of(int hand_id) {
    // Its own place, else a free one, else that of the hand that was not seen for longest.
    Acquaintance* place = all_.data();
    for (Acquaintance& one : all_) {
        if (one.hand_id == hand_id) {
            return one;
        }
        const bool better =
            one.hand_id == 0 ? place->hand_id != 0 : place->hand_id != 0 && one.seen < place->seen;
        place = better ? &one : place;
    }
    *place = {};
    return *place;
}

const Acquaintance* Company::before(const GestureSettings& s, const Acquaintance& one) const {
    const Acquaintance* nearest = nullptr;
    float nearest_mm = 0.0F;
    // Where it was then, with what is known of it by now.
    Arm then = one.arm;
    then.palm_mm = one.first.palm_mm;
    then.forearm = one.first.forearm;
    for (const Acquaintance& gone : all_) {
        const bool may_be = gone.hand_id != 0 && gone.hand_id != one.hand_id &&
                            gone.seen < one.first_seen &&
                            to_ms(one.first_seen - gone.seen) <= remembered_ms(s);
        if (!may_be || !same_hand(s, gone.arm, then)) {
            continue;
        }
        const float off_mm = (then.palm_mm - gone.arm.palm_mm).norm();
        if (nearest == nullptr || off_mm < nearest_mm) {
            nearest = &gone;
            nearest_mm = off_mm;
        }
    }
    return nearest;
}

void Company::forget_stillness() noexcept {
    for (Acquaintance& one : all_) {
        one.still = false;
    }
}

void Company::forget_trust() noexcept {
    for (Acquaintance& one : all_) {
        one.forget_trust();
    }
}

}  // namespace xtrack::recognise
