// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <xtrack/gesture_settings.hpp>
#include <xtrack/hand.hpp>

namespace xtrack::recognise {

/// How long a hand is, told slowly: from bones where a tracker measures joints, else from palms
/// that face the camera.
class HandSize {
 public:
    void add(const Hand& hand, Stamp now) noexcept;
    void forget() noexcept { *this = {}; }
    /// Wrist to the middle finger's tip, mm; 0: not known.
    [[nodiscard]] float length_mm() const noexcept;

 private:
    double mean_mm_ = 0.0;
    double seconds_ = 0.0;
    Stamp last_;
};

/// A hand and its arm, as far as they tell whose they are.
struct Arm {
    Vec3f palm_mm = Vec3f::Zero();
    Vec3f forearm = Vec3f::Zero();         ///< unit, toward the elbow; zero: not seen
    Chirality side = Chirality::unknown;   ///< only where the tracker is sure
    Chirality guess = Chirality::unknown;  ///< whatever the tracker says
    float length_mm = 0.0F;                ///< of the hand; 0: not known
    bool bones = false;                    ///< and it is that of measured bones
};
[[nodiscard]] Arm arm_of(const Hand& hand, float length_mm) noexcept;

/// Whether two hands are of one body.
enum class SameBody {
    no,         ///< arms or sizes forbid it
    same_side,  ///< two left or two right hands
    far,        ///< arms are not seen, and the palms are where those of one body seldom are
    unsure,
    yes,
};
/// @param together they count as one body's already: wide gestures do not part them
[[nodiscard]] SameBody same_body(const GestureSettings& s, const Arm& a, const Arm& b,
                                 bool together = false) noexcept;
[[nodiscard]] constexpr bool is_possible(SameBody verdict) noexcept {
    return verdict != SameBody::no && verdict != SameBody::same_side;
}

/// Whether two sights can be of one hand by side and size, wherever it is.
[[nodiscard]] bool same_build(const Arm& was, const Arm& is) noexcept;
/// ... and by its place and its arm, a short while later.
[[nodiscard]] bool same_hand(const GestureSettings& s, const Arm& was, const Arm& is) noexcept;

}  // namespace xtrack::recognise
