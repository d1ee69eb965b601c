// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "tests/gestures/recognise/play_hand.hpp"

namespace xtrack::test {

/// A right hand's fingers at a moment: how far index, middle, ring and little finger bend in all
/// joints, degrees, and the thumb: 0 on the middle finger, 1 off to its side.
struct Bent {
    double ms = 0.0;
    std::array<double, 4> deg{};
    double thumb = 1.0;
    Vec3f palm_mm{0.0F, 0.0F, 400.0F};
};

inline Bent open_hand(double ms) { return {ms, {20, 20, 20, 20}, 1.0}; }
inline Bent fist(double ms) { return {ms, {200, 200, 200, 200}, 0.0}; }
inline Bent pointing(double ms, double index_deg = 10) {
    return {ms, {index_deg, 190, 190, 190}, 0.0};
}

/// How the hand is held: `along` from wrist to fingers, `front` out of the palm.
struct Posture {
    Vec3f along{0.0F, 0.0F, -1.0F};
    Vec3f front{0.0F, -1.0F, 0.0F};
    float size = 1.0F;  ///< 1: 174 mm from wrist to fingertip
};

inline Bent between(const std::vector<Bent>& moments, double ms) {
    std::size_t i = 0;
    while (i + 1 < moments.size() && moments[i + 1].ms <= ms) {
        ++i;
    }
    Bent bent = moments[i];
    if (i + 1 < moments.size() && ms > bent.ms) {
        const Bent& to = moments[i + 1];
        const double s = (ms - bent.ms) / (to.ms - bent.ms);
        const double share = s * s * s * (10.0 - 15.0 * s + 6.0 * s * s);
        for (std::size_t f = 0; f < 4; ++f) {
            bent.deg[f] += share * (to.deg[f] - bent.deg[f]);
        }
        bent.thumb += share * (to.thumb - bent.thumb);
        bent.palm_mm += static_cast<float>(share) * (to.palm_mm - bent.palm_mm);
    }
    bent.ms = ms;
    return bent;
}

inline Hand hand_of(const Bent& bent, const Posture& posture, Noise& noise, double noise_mm = 0.0) {
    Hand hand;
    hand.id = 1;
    hand.chirality = Chirality::right;
    hand.chirality_confidence = hand.confidence = 1.0F;
    hand.palm_mm = bent.palm_mm;
    const Vec3f to_thumb = posture.along.cross(posture.front);
    const float size = posture.size;
    const auto shake = [&] { return Vec3f{noise(noise_mm), noise(noise_mm), noise(noise_mm)}; };
    put(hand, Joint::palm, bent.palm_mm + shake());
    put(hand, Joint::wrist, bent.palm_mm - 60.0F * size * posture.along + shake());
    constexpr float kBonesMm[3] = {35.0F, 22.0F, 18.0F};
    constexpr double kShares[3] = {0.42, 0.42, 0.16};
    for (int finger = 0; finger < 4; ++finger) {
        const int first = static_cast<int>(Joint::index_proximal) + 5 * finger;
        Vec3f p = bent.palm_mm + size * (30.0F * posture.along +
                                         (30.0F - 20.0F * static_cast<float>(finger)) * to_thumb);
        put(hand, static_cast<Joint>(first), p + shake());
        double deg = 0.0;
        for (int bone = 0; bone < 3; ++bone) {
            deg += kShares[bone] * bent.deg[static_cast<std::size_t>(finger)];
            const auto rad = static_cast<float>(deg / 57.29578);
            p += size * kBonesMm[bone] *
                 (std::cos(rad) * posture.along + std::sin(rad) * posture.front);
            put(hand, static_cast<Joint>(first + bone + 1), p + shake());
        }
    }
    const auto out = static_cast<float>(bent.thumb);
    const Vec3f off = bent.palm_mm + size * (90.0F * to_thumb + 20.0F * posture.along);
    const Vec3f on = hand.joint(Joint::middle_intermediate).position_mm +
                     size * 12.0F * posture.front + size * 8.0F * to_thumb;
    const Vec3f root = bent.palm_mm + size * 45.0F * to_thumb;
    const Vec3f tip = on + out * (off - on);
    put(hand, Joint::thumb_proximal, root + shake());
    put(hand, Joint::thumb_distal, 0.5F * (root + tip) + shake());
    put(hand, Joint::thumb_tip, tip + shake());
    complete_from_joints(hand);
    return hand;
}

/// Shows `hand_at` to a recogniser until `to_ms`.
inline void play(Stage& stage, double to_ms, double fps,
                 const std::function<Hand(double ms)>& hand_at) {
    for (int i = 0; i * 1000.0 / fps <= to_ms; ++i) {
        const double ms = i * 1000.0 / fps;
        HandFrame frame;
        frame.stamp = Stamp{static_cast<std::int64_t>(ms * 1e6)};
        frame.coordinates = CoordinateFrame::interaction;
        frame.hands[0] = hand_at(ms);
        frame.count = 1;
        stage.keep(stage.recogniser.push(frame));
    }
}

inline void play(Stage& stage, const std::vector<Bent>& moments, double fps,
                 const Posture& posture = {}, double noise_mm = 0.0) {
    Noise noise(11);
    play(stage, moments.back().ms, fps,
         [&](double ms) { return hand_of(between(moments, ms), posture, noise, noise_mm); });
}

}  // namespace xtrack::test
