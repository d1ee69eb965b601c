// SPDX-License-Identifier: Apache-2.0
#include "tools/corpus/movement.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace xtrack::tools::corpus {

namespace {

std::array<float, 3> to_array(const Vec3f& v) { return {v.x(), v.y(), v.z()}; }
Vec3f to_vector(const std::array<float, 3>& a) { return {a[0], a[1], a[2]}; }

// A finger that stays bent: a contracture; one that is not there: folded out of sight.
constexpr std::array<float, 3> kBentRad{0.9F, 1.2F, 0.4F};
constexpr std::array<float, 3> kMissingRad{1.5F, 1.75F, 1.2F};
constexpr double kShortestS = 0.08;

}  // namespace

const Pinhole& corpus_camera() {
    static const Pinhole camera = SimSettings::preset("ideal-60").value().rig.camera;
    return camera;
}

Movement::Movement(const Person& person, SimHand hand)
    : person_(person),
      hand_(hand),
      random_(sim::mix(person.seed, 21U + static_cast<std::uint64_t>(hand))),
      sway_(person.seed, hand),
      place_({}),
      turn_({}),
      fingers_(sim::relaxed_open()) {
    place_ = sim::Track<3>(to_array(away()));
}

Vec3f Movement::away() const noexcept {
    const Pinhole& camera = corpus_camera();
    const Vec3f home = person_.home_of(hand_);
    const double z = home.z() + 60.0;
    const double edge = (camera.size.height - camera.matrix(1, 2)) / camera.matrix(1, 1) * z;
    const auto middle = static_cast<float>(person_.to_side_mm);
    return {middle + (home.x() - middle) * 1.4F, static_cast<float>(edge + person_.hand_length_mm),
            static_cast<float>(z)};
}

Vec3f Movement::place() const { return to_vector(place_.target()); }

void Movement::go(const Vec3f& target, double seconds) {
    const double end = now_ + std::max(seconds, kShortestS);
    place_.move(now_, end, to_array(target));
    now_ = end;
}

void Movement::go_at(const Vec3f& target, double mean_mmps) {
    go(target, (target - place()).norm() / mean_mmps);
}

void Movement::go_evenly(const Vec3f& target, double seconds) {
    place_.move_evenly(now_, now_ + seconds, to_array(target));
    now_ += seconds;
}

void Movement::turn(const Vec3f& turn_rad, double seconds) {
    const double start = std::max(now_, turned_s_);
    turned_s_ = start + seconds;
    turn_.move(start, turned_s_, to_array(turn_rad));
}

void Movement::shape(const sim::FingerAngles& fingers, double seconds) {
    const double start = std::max(now_, shaped_s_);
    shaped_s_ = start + seconds;
    fingers_.move(start, shaped_s_, fingers);
}

const char* Movement::doing_at(double t_s) const {
    const auto after = std::upper_bound(doings_.begin(), doings_.end(), t_s,
                                        [](double t, const Doing& d) { return t < d.start_s; });
    return after == doings_.begin() ? "nothing" : std::prev(after)->what;
}

sim::HandPose Movement::planned(double t_s) const {
    sim::HandPose pose;
    pose.palm_mm = to_vector(place_.at(t_s));
    pose.turn_rad = to_vector(turn_.at(t_s));
    pose.fingers = fingers_.at(t_s);
    fit_body(pose);
    return pose;
}

sim::HandPose Movement::at(double t_s) const {
    sim::HandPose pose = planned(t_s);
    sway_.add(t_s, pose);
    if (person_.tremor_mm > 0.0) {
        // Round an ellipse, as hands with a tremor do; up and down most.
        const double phase = 2.0 * std::numbers::pi * person_.tremor_hz * t_s;
        const double half = 0.5 * person_.tremor_mm;
        const Vec3f shake(static_cast<float>(0.7 * std::sin(phase)),
                          static_cast<float>(std::sin(phase + 0.9)),
                          static_cast<float>(0.4 * std::sin(phase + 2.0)));
        pose.palm_mm += static_cast<float>(half) * shake;
    }
    return pose;
}

/// What the body does to a plan: a shoulder that is somewhere, a wrist that lies still, fingers
/// that do not do as the others do.
void Movement::fit_body(sim::HandPose& pose) const {
    constexpr float kShoulderHalfMm = 185.0F;
    constexpr float kShoulderBehindChestMm = 75.0F;
    const float scale = person_.scale();
    pose.shoulder_mm = {
        static_cast<float>(person_.to_side_mm) + Person::outward(hand_) * kShoulderHalfMm * scale,
        -35.0F - static_cast<float>(person_.tall_mm),
        static_cast<float>(person_.chest_mm) + kShoulderBehindChestMm};
    if (person_.manner == Manner::wrist_at_rest) {
        // The way that was meant, made by the hand about its wrist as far as that goes.
        constexpr float kReachMm = 110.0F;  // wrist to fingertips, nearly
        constexpr float kMostRad = 0.7F;
        constexpr float kWristToPalmMm = 48.0F;
        const Vec3f home = person_.home_of(hand_);
        const Vec3f meant = pose.palm_mm - home;
        if (meant.norm() < 400.0F) {  // not on the way in and out
            const auto bend = [&](float mm) {
                return std::clamp(mm / (kReachMm * scale), -kMostRad, kMostRad);
            };
            const float roll = bend(meant.x());
            const float pitch = bend(meant.z() - meant.y());
            pose.palm_mm = home + kWristToPalmMm * scale *
                                      Vec3f(std::sin(roll), 1.0F - std::cos(roll), std::sin(pitch));
            pose.turn_rad.z() += hand_ == SimHand::right ? roll : -roll;
            pose.turn_rad.x() += pitch;
        }
    }
    for (std::size_t f = 1; f < kFingerCount; ++f) {
        const auto hold = [&](const std::array<float, 3>& bend) {
            float* a = &pose.fingers[f * sim::kAnglesPerFinger];
            a[0] = bend[0];
            a[2] = bend[1];
            a[3] = bend[2];
        };
        if (person_.missing[f]) {
            hold(kMissingRad);
        } else if (person_.bent[f]) {
            hold(kBentRad);
        }
    }
}

}  // namespace xtrack::tools::corpus
