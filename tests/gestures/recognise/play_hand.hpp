// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <xtrack/gesture_recogniser.hpp>

#include "gestures/track/hand_from_joints.hpp"

namespace xtrack::test {

/// How a joint tracker would show the hand; `plain` is what a depth camera gives: no joints.
enum class Held {
    plain,
    palm_left,  ///< flat hand, palm to the user's left
    palm_right,
    palm_down,      ///< as hands rest
    palm_screen,    ///< fingers up, palm toward the screen
    pointing_down,  ///< palm down, only the index straight
};

/// Where the hand is at a moment; between moments it moves smoothly (minimum jerk).
struct At {
    double ms = 0.0;
    Vec3f palm_mm{0.0F, 0.0F, 400.0F};
    double aperture_mm = 70.0;
    bool seen = true;
    bool border = false;
};

/// Gaussian noise that is the same on every machine.
class Noise {
 public:
    explicit Noise(std::uint64_t seed) : state_(seed * 2685821657736338717ULL + 1) {}
    float operator()(double sigma) {
        double sum = -6.0;
        for (int i = 0; i < 12; ++i) {
            state_ ^= state_ >> 12;
            state_ ^= state_ << 25;
            state_ ^= state_ >> 27;
            sum += static_cast<double>((state_ * 2685821657736338717ULL) >> 11) * 0x1.0p-53;
        }
        return static_cast<float>(sigma * sum);
    }

 private:
    std::uint64_t state_;
};

/// A hand that follows a table of moments.
struct Actor {
    std::vector<At> moments;
    Held held = Held::plain;
    int id = 1;
    Chirality chirality = Chirality::right;
    double noise_mm = 0.0;
    float confidence = 1.0F;
    Vec3f forearm = Vec3f::Zero();  ///< toward the elbow; zero: unknown
    float grab = 0.0F;
    float palm_radius_mm = 0.0F;  ///< of a palm that faces the screen; 0: unknown
    std::function<void(double ms, Hand& hand)> change = {};  ///< what its tracker says else

    [[nodiscard]] At where(double ms) const {
        std::size_t i = 0;
        while (i + 1 < moments.size() && moments[i + 1].ms <= ms) {
            ++i;
        }
        At at = moments[i];
        if (i + 1 < moments.size() && ms > at.ms) {
            const At& to = moments[i + 1];
            const double s = (ms - at.ms) / (to.ms - at.ms);
            const double share = s * s * s * (10.0 - 15.0 * s + 6.0 * s * s);
            at.palm_mm += static_cast<float>(share) * (to.palm_mm - at.palm_mm);
            at.aperture_mm += share * (to.aperture_mm - at.aperture_mm);
        }
        at.ms = ms;
        return at;
    }
};

inline void put(Hand& hand, Joint j, const Vec3f& p) {
    hand.joint(j).position_mm = p;
    hand.joint(j).valid = true;
}

/// A right hand's joints around its palm: `along` points from the wrist to the fingers, `front` out
/// of the palm. The thumb is on the side of along x front.
inline void add_joints(Hand& hand, const Vec3f& along, const Vec3f& front, bool only_index) {
    const Vec3f to_thumb = along.cross(front);
    const Vec3f palm = hand.palm_mm;
    put(hand, Joint::palm, palm);
    put(hand, Joint::wrist, palm - 60.0F * along);
    for (int finger = 1; finger <= 4; ++finger) {
        const Vec3f knuckle =
            palm + 30.0F * along + (30.0F - 20.0F * static_cast<float>(finger - 1)) * to_thumb;
        const int first = static_cast<int>(Joint::index_proximal) + 5 * (finger - 1);
        const bool straight = !only_index || finger == 1;
        // A folded finger comes back to its knuckle in a square.
        const Vec3f steps[3] = {straight ? 35.0F * along : 35.0F * front,
                                straight ? 22.0F * along : -22.0F * along,
                                straight ? 18.0F * along : -18.0F * front};
        Vec3f p = knuckle;
        put(hand, static_cast<Joint>(first), p);
        for (int k = 0; k < 3; ++k) {
            p += steps[k];
            put(hand, static_cast<Joint>(first + k + 1), p);
        }
    }
    put(hand, Joint::thumb_proximal, palm + 45.0F * to_thumb);
    put(hand, Joint::thumb_distal, palm + 45.0F * to_thumb + 30.0F * along);
    put(hand, Joint::thumb_tip, palm + 45.0F * to_thumb + 55.0F * along);
}

inline Hand hand_of(const Actor& actor, const At& at, Noise& noise) {
    Hand hand;
    hand.id = actor.id;
    hand.chirality = actor.chirality;
    hand.chirality_confidence = 0.9F;
    hand.confidence = actor.confidence;
    hand.touches_border = at.border;
    hand.forearm = actor.forearm;
    hand.grab_value = actor.grab;
    hand.palm_radius_mm = actor.palm_radius_mm;
    if (actor.palm_radius_mm > 0.0F) {
        hand.palm_normal = {0.0F, 0.0F, -1.0F};
    }
    const Vec3f shake{noise(actor.noise_mm), noise(actor.noise_mm), noise(actor.noise_mm)};
    hand.palm_mm = at.palm_mm + shake;
    const Vec3f x{1.0F, 0.0F, 0.0F};
    const Vec3f y{0.0F, 1.0F, 0.0F};
    const Vec3f z{0.0F, 0.0F, 1.0F};
    switch (actor.held) {
        case Held::palm_left: add_joints(hand, -z, -x, false); break;
        case Held::palm_right: add_joints(hand, -z, x, false); break;
        case Held::palm_down: add_joints(hand, -z, -y, false); break;
        case Held::palm_screen: add_joints(hand, y, -z, false); break;
        case Held::pointing_down: add_joints(hand, -z, -y, true); break;
        case Held::plain: break;
    }
    if (actor.held != Held::plain) {
        complete_from_joints(hand);
        return hand;
    }
    const double shaken_mm =
        std::max(at.aperture_mm + static_cast<double>(noise(1.41 * actor.noise_mm)), 0.0);
    hand.pinch_aperture_mm = static_cast<float>(shaken_mm);
    hand.pinch_value = static_cast<float>(std::clamp((60.0 - shaken_mm) / 45.0, 0.0, 1.0));
    TrackedPoint& thumb = hand.fingertip(Finger::thumb);
    TrackedPoint& index = hand.fingertip(Finger::index);
    thumb.valid = index.valid = true;
    thumb.position_mm = hand.palm_mm + Vec3f{-40.0F, 40.0F, 0.0F};
    index.position_mm = thumb.position_mm + Vec3f{0.0F, static_cast<float>(shaken_mm), 0.0F};
    return hand;
}

/// Plays actors to a recogniser and keeps what happens.
class Stage {
 public:
    explicit Stage(const GestureSettings& settings = {})
        : recogniser(std::move(*GestureRecogniser::create(settings))) {
        recogniser.set_trace([this](const RecogniserTrace& line) {
            trace.push_back(line);
            EXPECT_FALSE(line.impossible) << line.machine << " " << line.from << " " << line.event;
        });
    }

    /// From the first moment of the first actor to the last.
    void play(const std::vector<Actor>& actors, double fps) {
        Noise noise(7);
        const double from_ms = actors.front().moments.front().ms;
        const double to_ms = actors.front().moments.back().ms;
        const auto frames = static_cast<int>((to_ms - from_ms) * 1e-3 * fps + 1e-6);
        for (int i = 0; i <= frames; ++i) {
            const double ms = from_ms + 1000.0 * i / fps;
            HandFrame frame;
            frame.stamp = Stamp{static_cast<std::int64_t>(ms * 1e6)};
            frame.coordinates = CoordinateFrame::interaction;
            for (const Actor& actor : actors) {
                const At at = actor.where(ms);
                if (at.seen) {
                    Hand& hand = frame.hands[frame.count++];
                    hand = hand_of(actor, at, noise);
                    if (actor.change) {
                        actor.change(ms, hand);
                    }
                }
            }
            keep(recogniser.push(frame));
        }
    }
    void play(const Actor& actor, double fps) { play(std::vector<Actor>{actor}, fps); }

    void keep(std::span<const GestureEvent> new_events) {
        events.insert(events.end(), new_events.begin(), new_events.end());
    }

    /// What happened, without hands and updates: `swipe_left`, `pinch begin`, `pinch cancel lost`.
    [[nodiscard]] std::vector<std::string> story() const {
        std::vector<std::string> lines;
        for (const GestureEvent& e : events) {
            const bool one_shot = is_one_shot(e.type);
            if (e.type == GestureType::hand || e.phase == EventPhase::update ||
                (one_shot && e.phase == EventPhase::begin)) {
                continue;
            }
            std::string line = name_of(e);
            if (!one_shot) {
                line += std::string{" "} + to_string(e.phase);
            }
            if (e.phase == EventPhase::cancel) {
                line += std::string{" "} + to_string(e.cancel_reason);
            }
            lines.push_back(line);
        }
        return lines;
    }
    [[nodiscard]] const GestureEvent* first(GestureType type, EventPhase phase) const {
        for (const GestureEvent& e : events) {
            if (e.type == type && e.phase == phase) {
                return &e;
            }
        }
        return nullptr;
    }
    [[nodiscard]] bool explained(const std::string& machine, const std::string& why) const {
        return std::any_of(trace.begin(), trace.end(), [&](const RecogniserTrace& line) {
            return line.machine == machine && line.why == why;
        });
    }

    GestureRecogniser recogniser;
    std::vector<GestureEvent> events;
    std::vector<RecogniserTrace> trace;
};

}  // namespace xtrack::test
