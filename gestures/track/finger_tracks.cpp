// SPDX-License-Identifier: Apache-2.0
#include "gestures/track/finger_tracks.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace xtrack::track {

namespace {

constexpr auto kThumb = static_cast<std::size_t>(Finger::thumb);
constexpr auto kIndex = static_cast<std::size_t>(Finger::index);

/// A finger that is not seen keeps its place for so long, s: four frames at 30 Hz.
constexpr double kForgetS = 0.15;
/// An aperture that cannot be measured is told for so long, s ...
constexpr double kHoldS = 0.07;
/// ... and for so long its course says whether the fingers may have met meanwhile, s.
constexpr double kCourseS = 0.15;
/// The course is smoothed over this, s: noise of 3 mm a frame is 250 mm/s from frame to frame.
constexpr float kCourseSmoothS = 0.05F;
/// Fingers of one hand do not open or close faster, mm/s, and a frame may be off by the step, mm.
constexpr float kApertureMmps = 1200.0F;
constexpr float kApertureStepMm = 12.0F;
/// When a frame's own names contradict those of time for so long, time was wrong, s.
constexpr double kContradictedS = 0.2;

// Matching of tips with fingers: the cheapest one-to-one matching that keeps the order round the
// palm. Costs are mm of distance from where the finger was.
constexpr float kTipGateMm = 45.0F;
constexpr float kUnnamedTip = 34.0F;     // a tip that is no finger
constexpr float kMissedFinger = 12.0F;   // a finger that was there a moment ago and has no tip
constexpr float kNewFinger = 16.0F;      // a finger that was not there
constexpr float kOtherThanGuess = 8.0F;  // it gets another name than this frame alone would give

/// From an aperture under this, fingers that are lost to sight may have met, mm.
constexpr float kMeetingFromMm = 36.0F;
/// Where they meet: from where either tip was, mm, and mm/s since it was there.
constexpr float kMeetingReachMm = 22.0F;
constexpr float kMeetingMmps = 350.0F;
/// How fast an aperture that is out of sight may have closed, mm/s. People close at 150..500.
constexpr float kClosingMmps = 450.0F;
/// An aperture that grew by more, mm/s, before it went out of sight did not close there.
constexpr float kOpeningMmps = 150.0F;
/// Fingers that have met are still there while the hand reaches so far of the way to them.
constexpr float kStillThereShare = 0.85F;
/// A ring is as large as two fingers; its far end is this near to where the tips were, mm.
constexpr float kRingReachMm = 40.0F;
/// The place of a touch, seen from the palm, moves no farther than this, mm, while it lasts ...
constexpr float kTouchDriftMm = 18.0F;
/// ... follows by this share a frame ...
constexpr float kTouchFollow = 0.02F;
/// ... and is believed for so long without a tip or a ring to see, s.
constexpr double kTouchUnseenS = 0.35;
/// Pads of two touching fingers, skin to skin in the image, mm: half a pixel each and noise.
constexpr float kTouchMm = 6.0F;
/// Apart again from here on, mm.
constexpr float kApartMm = 14.0F;

}  // namespace

void FingerTracks::forget(Stamp stamp) {
    for (FingerState& f : fingers_) {
        f.known = f.known && to_seconds(stamp - f.seen) <= kForgetS;
        f.fresh = false;
        f.tip = -1;
    }
}

bool FingerTracks::names_agree(const FingerReading& reading) const {
    for (std::size_t k = 0; k < reading.count; ++k) {
        const auto f = static_cast<std::size_t>(reading.tips[k].finger);
        if (fingers_[f].tip != static_cast<int>(k)) {
            return false;
        }
    }
    return true;
}

void FingerTracks::update(Stamp stamp, const HandRegion& region, int side, FingerReading& reading) {
    forget(stamp);
    const auto known = std::count_if(fingers_.begin(), fingers_.end(),
                                     [](const FingerState& f) { return f.known; });
    followed_ = known >= 2 && side != 0;
    const bool whole =
        reading.count == kFingerCount && reading.thumb >= 0 && reading.thumb_side == side;
    if (!followed_) {
        adopt(stamp, region, reading);
        agreed_ = stamp;
    } else {
        FingerReading timed = reading;
        follow(stamp, region, side, timed);
        // A hand with all five fingers is named by its own look; time may have been wrong, also
        // about a touch: fingers that have met are one tip.
        if (!whole || names_agree(reading)) {
            agreed_ = stamp;
        }
        if (to_seconds(stamp - agreed_) > kContradictedS) {
            for (FingerState& f : fingers_) {
                f.known = false;
            }
            touching_ = false;
            aperture_known_ = course_known_ = false;
            adopt(stamp, region, reading);
            agreed_ = stamp;
        } else {
            reading = timed;
        }
    }
    measure_aperture(stamp, region, side, reading);
}

void FingerTracks::adopt(Stamp stamp, const HandRegion& region, const FingerReading& reading) {
    for (FingerState& f : fingers_) {
        f.fresh = false;
        f.tip = -1;
    }
    for (std::size_t k = 0; k < reading.count; ++k) {
        FingerState& f = fingers_[static_cast<std::size_t>(reading.tips[k].finger)];
        f = {reading.tips[k].position_mm - region.palm_mm, stamp, true, true, static_cast<int>(k)};
    }
}

void FingerTracks::follow(Stamp stamp, const HandRegion& region, int side, FingerReading& reading) {
    // best[t][f]: cost of the first t tips and f fingers, both counted from the thumb's side.
    constexpr std::size_t kF = kFingerCount;
    const std::size_t n = std::min(reading.count, kTipsMax);
    std::array<std::array<float, kF + 1>, kTipsMax + 1> best{};
    std::array<std::array<std::uint8_t, kF + 1>, kTipsMax + 1> way{};
    const auto tip_at = [&](std::size_t t) { return side > 0 ? n - 1 - t : t; };
    const auto missed = [&](std::size_t f) { return fingers_[f].known ? kMissedFinger : 0.0F; };
    constexpr std::uint8_t kSkipTip = 1;
    constexpr std::uint8_t kSkipFinger = 2;
    constexpr std::uint8_t kMatch = 3;
    for (std::size_t t = 0; t <= n; ++t) {
        for (std::size_t f = 0; f <= kF; ++f) {
            if (t == 0 && f == 0) {
                continue;
            }
            float least = std::numeric_limits<float>::max();
            std::uint8_t from = 0;
            const auto offer = [&](float cost, std::uint8_t step) {
                if (cost < least) {
                    least = cost;
                    from = step;
                }
            };
            if (t > 0) {
                offer(best[t - 1][f] + kUnnamedTip, kSkipTip);
            }
            if (f > 0) {
                offer(best[t][f - 1] + missed(f - 1), kSkipFinger);
            }
            if (t > 0 && f > 0) {
                const Tip& tip = reading.tips[tip_at(t - 1)];
                const FingerState& finger = fingers_[f - 1];
                float cost = kNewFinger;
                if (finger.known) {
                    cost = (tip.position_mm - region.palm_mm - finger.tip_mm).norm();
                    cost = cost > kTipGateMm ? 2.0F * kUnnamedTip + cost : cost;
                } else {
                    cost += static_cast<std::size_t>(tip.finger) == f - 1 ? 0.0F : kOtherThanGuess;
                }
                offer(best[t - 1][f - 1] + cost, kMatch);
            }
            best[t][f] = least;
            way[t][f] = from;
        }
    }
    std::array<int, kTipsMax> name{};
    name.fill(-1);
    std::size_t t = n;
    std::size_t f = kF;
    while (t > 0 || f > 0) {
        const std::uint8_t step = way[t][f];
        if (step == kMatch) {
            name[tip_at(t - 1)] = static_cast<int>(f - 1);
        }
        t -= step == kSkipFinger ? 0 : 1;
        f -= step == kSkipTip ? 0 : 1;
    }
    // Tips without a name leave; the others keep their order.
    std::size_t kept = 0;
    reading.thumb = -1;
    for (std::size_t k = 0; k < n; ++k) {
        if (name[k] < 0) {
            continue;
        }
        const auto finger = static_cast<std::size_t>(name[k]);
        reading.tips[kept] = reading.tips[k];
        reading.tips[kept].finger = static_cast<Finger>(finger);
        reading.thumb = finger == kThumb ? static_cast<int>(kept) : reading.thumb;
        fingers_[finger] = {reading.tips[kept].position_mm - region.palm_mm, stamp, true, true,
                            static_cast<int>(kept)};
        ++kept;
    }
    reading.count = kept;
}

bool FingerTracks::met(Stamp stamp, const HandRegion& region, const FingerReading& reading,
                       Vec3f& where_mm) const {
    const FingerState& thumb = fingers_[kThumb];
    const FingerState& index = fingers_[kIndex];
    if (thumb.fresh && index.fresh && !reading.ring) {
        return false;
    }
    if (!thumb.known || !index.known) {
        return false;
    }
    const Vec3f middle = 0.5F * (thumb.tip_mm + index.tip_mm);
    const auto blind = static_cast<float>(to_seconds(stamp - aperture_at_));
    const bool were_near = touching_ || (course_known_ && course_mmps_ < kOpeningMmps &&
                                         aperture_mm_ - kClosingMmps * blind < kMeetingFromMm);
    if (reading.ring) {
        where_mm = reading.ring_tip_mm - region.palm_mm;
        // Without a glimpse of the two running into each other, a hole must lie where they are.
        return (where_mm - middle).norm() < kRingReachMm &&
               (were_near || (thumb.tip_mm - index.tip_mm).norm() < 2.0F * kMeetingFromMm);
    }
    if (!were_near) {
        return false;
    }
    const auto near = [&](const Vec3f& p, const FingerState& f) {
        const auto age = static_cast<float>(to_seconds(stamp - f.seen));
        return (p - f.tip_mm).norm() < kMeetingReachMm + kMeetingMmps * age;
    };
    // A finger that leaves the place of the touch takes nothing with it.
    const auto at_touch = [&](const Vec3f& p) {
        return !touching_ || (p - touch_mm_).norm() < kTouchDriftMm;
    };
    // One of the two is seen, near to where both were; or a tip too wide for one finger.
    if (thumb.fresh || index.fresh) {
        where_mm = thumb.fresh ? thumb.tip_mm : index.tip_mm;
        return at_touch(where_mm) && near(where_mm, thumb.fresh ? index : thumb);
    }
    for (std::size_t k = 0; k < reading.wide_count; ++k) {
        where_mm = reading.wide_mm[k] - region.palm_mm;
        if (at_touch(where_mm) && near(where_mm, thumb) && near(where_mm, index)) {
            return true;
        }
    }
    // Or no tip stands out, yet the hand still reaches to where they met.
    where_mm = touch_mm_;
    return touching_ && to_seconds(stamp - touch_seen_) < kTouchUnseenS &&
           reading.reach_toward(touch_mm_) > kStillThereShare * touch_mm_.norm();
}

void FingerTracks::measure_aperture(Stamp stamp, const HandRegion& region, int side,
                                    const FingerReading& reading) {
    FingerState& thumb = fingers_[kThumb];
    FingerState& index = fingers_[kIndex];
    Vec3f where = Vec3f::Zero();
    // A hand that shows a ring when it is first seen is pinching: it has no past to ask.
    const bool at_first = reading.ring && !(thumb.fresh && index.fresh) &&
                          (!followed_ || (!thumb.known && !index.known));
    if (at_first) {
        where = reading.ring_tip_mm - region.palm_mm;
    }
    if (at_first || met(stamp, region, reading, where)) {
        const bool seen = reading.ring || thumb.fresh || index.fresh || reading.wide_count > 0;
        touch_mm_ = touching_ ? Vec3f(touch_mm_ + kTouchFollow * (where - touch_mm_)) : where;
        touch_seen_ = seen || !touching_ ? stamp : touch_seen_;
        touching_ = true;
        thumb = {where, stamp, true, true, thumb.tip};
        index = {where, stamp, true, true, index.tip};
        accept(stamp, kTouchMm);
        course_mmps_ = 0.0F;  // it ends where they meet
        return;
    }
    if (thumb.fresh && index.fresh) {
        const Tip& t = reading.tips[static_cast<std::size_t>(thumb.tip)];
        const Tip& i = reading.tips[static_cast<std::size_t>(index.tip)];
        // The outline runs clockwise: the gap is after the one and before the other.
        const bool thumb_first = side < 0 || (side == 0 && t.angle_rad < i.angle_rad);
        const Vec3f& thumb_pad = thumb_first ? t.pad_after_mm : t.pad_before_mm;
        const Vec3f& index_pad = thumb_first ? i.pad_before_mm : i.pad_after_mm;
        accept(stamp, (thumb_pad - index_pad).norm());
        touching_ = touching_ && aperture_mm_ < kApartMm;
        return;
    }
    const double unseen_s = to_seconds(stamp - aperture_at_);
    if (aperture_known_ && unseen_s > kHoldS) {
        aperture_known_ = false;
        touching_ = false;
    }
    course_known_ = course_known_ && unseen_s <= kCourseS;
}

void FingerTracks::accept(Stamp stamp, float aperture_mm) {
    const auto t = static_cast<float>(to_seconds(stamp - aperture_at_));
    if (aperture_known_) {
        // A jump is held back, and let through when it lasts longer than a bad frame or two.
        const bool jump =
            std::abs(aperture_mm - aperture_mm_) > kApertureStepMm + kApertureMmps * t;
        if (jump && static_cast<double>(t) <= kHoldS) {
            return;
        }
    }
    if (!course_known_) {
        course_mmps_ = 0.0F;
    } else if (t > 0.0F) {
        const float share = 1.0F - std::exp(-t / kCourseSmoothS);
        course_mmps_ += share * ((aperture_mm - aperture_mm_) / t - course_mmps_);
    }
    aperture_mm_ = aperture_mm;
    aperture_at_ = stamp;
    aperture_known_ = course_known_ = true;
}

}  // namespace xtrack::track
