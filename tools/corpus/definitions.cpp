// SPDX-License-Identifier: Apache-2.0
#include "tools/corpus/definitions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "tools/corpus/shapes.hpp"

namespace xtrack::tools::corpus::definitions {

namespace {

constexpr double kStepS = 0.002;
constexpr float kDegree = std::numbers::pi_v<float> / 180.0F;

Vec3f palm(const Movement& m, double t) { return m.planned(t).palm_mm; }

double speed(const Movement& m, double t) {
    return (palm(m, t) - palm(m, t - kStepS)).norm() / kStepS;
}

/// The first moment of the first `hold_s` in which `holds(t)` is never false.
Moment held(double start_s, double end_s, double hold_s, const auto& holds) {
    double since = start_s;
    for (double t = start_s; t <= end_s; t += kStepS) {
        if (!holds(t)) {
            since = t + kStepS;
        } else if (t - since >= hold_s) {
            return t;
        }
    }
    return {};
}

/// From the line of the hand to that from the index knuckle to its tip.
float index_bend(const Movement& m, double t) {
    const sim::PosedBones bones = sim::pose_bones(m.planned(t), m.hand(), m.person().scale());
    const auto joint = [&](Joint j) { return bones.joints_mm[static_cast<std::size_t>(j)]; };
    const Vec3f hand = (joint(Joint::index_proximal) - joint(Joint::index_metacarpal)).normalized();
    const Vec3f finger = (joint(Joint::index_tip) - joint(Joint::index_proximal)).normalized();
    return std::acos(std::clamp(hand.dot(finger), -1.0F, 1.0F));
}

}  // namespace

Moment stroke(const Movement& m, const Vec3f& along, double start_s, double end_s) {
    constexpr double kCandidateMmps = 200.0;
    constexpr double kMeanMmps = 300.0;
    constexpr double kLengthMm = 100.0;
    constexpr double kAsideMm = 30.0;
    constexpr double kAsideShare = 0.2;
    std::optional<double> begun;
    Vec3f from = Vec3f::Zero();
    for (double t = start_s; t <= end_s; t += kStepS) {
        const Vec3f here = palm(m, t);
        if ((here - palm(m, t - kStepS)).dot(along) < kCandidateMmps * kStepS) {
            begun.reset();
            continue;
        }
        if (!begun) {
            begun = t;
            from = here;
        }
        const Vec3f way = here - from;
        const double length = way.dot(along);
        Vec3f aside = way - along * static_cast<float>(length);
        aside.z() = 0.0F;  // directions are of the x-y plane
        if (aside.norm() > kAsideMm + kAsideShare * length) {
            begun.reset();
        } else if (length >= kLengthMm && length >= kMeanMmps * (t - *begun)) {
            return t;
        }
    }
    return {};
}

Moment thrust(const Movement& m, const Vec3f& along, double start_s, double end_s) {
    constexpr double kWindowS = 0.240;
    constexpr double kMmps = 330.0;
    constexpr float kConeRad = 30.0F * kDegree;
    for (double t = start_s; t <= end_s; t += kStepS) {
        const Vec3f way = palm(m, t) - palm(m, t - kWindowS);
        if (way.norm() >= kMmps * kWindowS && way.normalized().dot(along) >= std::cos(kConeRad)) {
            return t;
        }
    }
    return {};
}

Moment pinch(const Movement& m, double start_s, double end_s) {
    constexpr double kMm = 20.0;
    constexpr double kShare = 0.11;
    constexpr double kHoldS = 0.050;
    const double near = std::max(kMm, kShare * m.person().hand_length_mm);
    return held(start_s, end_s, kHoldS, [&](double t) {
        return sim::aperture_mm(sim::hand_model(), sim::pose_bones(m.planned(t), m.hand(),
                                                                   m.person().scale())) <= near;
    });
}

Moment grab(const Movement& m, double start_s, double end_s) {
    constexpr float kStrength = 0.80F;
    const auto strength = [](const sim::FingerAngles& fingers) {
        const auto bend = [](const sim::FingerAngles& a) {
            float sum = 0.0F;
            for (std::size_t f = 1; f < kFingerCount; ++f) {
                sum += a[f * sim::kAnglesPerFinger] + a[f * sim::kAnglesPerFinger + 2];
            }
            return sum;
        };
        return (bend(fingers) - bend(sim::relaxed_open())) /
               (bend(fist()) - bend(sim::relaxed_open()));
    };
    return held(start_s, end_s, 0.0,
                [&](double t) { return strength(m.planned(t).fingers) >= kStrength; });
}

Moment tap(const Movement& m, double start_s, double end_s) {
    constexpr float kBendRad = 30.0F * kDegree;
    constexpr double kWithinS = 30.0 / 180.0;
    for (double t = start_s; t <= end_s; t += kStepS) {
        if (index_bend(m, t) - index_bend(m, std::max(start_s, t - kWithinS)) >= kBendRad) {
            return t;
        }
    }
    return {};
}

Moment circle(const Movement& m, const Vec3f& centre, double start_s, double end_s) {
    constexpr double kArcRad = 1.5 * std::numbers::pi;
    constexpr double kLeastRadiusMm = 40.0;
    double arc = 0.0;
    std::optional<double> before;
    for (double t = start_s; t <= end_s; t += kStepS) {
        const Vec3f off = palm(m, t) - centre;
        if (std::hypot(off.x(), off.y()) < kLeastRadiusMm) {
            continue;
        }
        const double angle = std::atan2(off.y(), off.x());
        if (before) {
            arc += std::remainder(angle - *before, 2.0 * std::numbers::pi);
        }
        before = angle;
        if (std::abs(arc) >= kArcRad) {
            return t;
        }
    }
    return {};
}

Moment raise(const Movement& m, double start_s, double end_s) {
    constexpr float kUpMm = 150.0F;
    constexpr double kStillS = 0.200;
    constexpr double kStillMmps = 50.0;
    const float from = palm(m, start_s).y();
    return held(start_s, end_s, kStillS, [&](double t) {
        return from - palm(m, t).y() >= kUpMm && speed(m, t) < kStillMmps;
    });
}

Moment dwell(const Movement& m, double start_s, double end_s) {
    constexpr float kMm = 5.0F;
    constexpr double kHoldS = 0.500;
    for (double t = start_s + kHoldS; t <= end_s; t += kStepS) {
        const Vec3f here = palm(m, t);
        bool still = true;
        for (double back = 0.0; back <= kHoldS && still; back += 0.02) {
            still = (palm(m, t - back) - here).norm() <= kMm;
        }
        if (still) {
            return t;
        }
    }
    return {};
}

Moment press(const Movement& m, double start_s, double end_s) {
    constexpr double kSlowMmps = 150.0;
    constexpr double kFastMmps = 500.0;
    constexpr double kSlowMm = 42.0;
    constexpr double kFastMm = 8.0;
    double force = 0.0;
    for (double t = start_s; t <= end_s; t += kStepS) {
        const double way = palm(m, t - kStepS).z() - palm(m, t).z();
        const double share =
            std::clamp((way / kStepS - kSlowMmps) / (kFastMmps - kSlowMmps), 0.0, 1.0);
        force = std::max(0.0, force + way / (kSlowMm + (kFastMm - kSlowMm) * share * share));
        if (force >= 1.0) {
            return t;
        }
    }
    return {};
}

Moment touch(const Movement& m, double plane_mm, double start_s, double end_s) {
    constexpr double kNearMm = 50.0;
    return held(start_s, end_s, 0.0, [&](double t) { return palm(m, t).z() - plane_mm < kNearMm; });
}

Moment drag(const Movement& m, bool grabbed, double start_s, double end_s) {
    const float way = grabbed ? 10.0F : 30.0F;
    const Vec3f from = palm(m, start_s);
    return held(start_s, end_s, 0.0, [&](double t) { return (palm(m, t) - from).norm() >= way; });
}

Moment pose(const Movement& m, const sim::FingerAngles& shape, const sim::FingerAngles& from,
            double start_s, double end_s) {
    constexpr float kScore = 0.8F;
    constexpr double kHoldS = 0.500;
    constexpr double kMmps = 100.0;
    return held(start_s, end_s, kHoldS, [&](double t) {
        return likeness(m.planned(t).fingers, shape, from) >= kScore && speed(m, t) < kMmps;
    });
}

Moment zoom(const Movement& a, const Movement& b, double start_s, double end_s) {
    constexpr float kMm = 20.0F;
    const float apart = (palm(a, start_s) - palm(b, start_s)).norm();
    return held(start_s, end_s, 0.0, [&](double t) {
        return std::abs((palm(a, t) - palm(b, t)).norm() - apart) >= kMm;
    });
}

Moment rotate(const Movement& a, const Movement& b, double start_s, double end_s) {
    constexpr float kTurnRad = 10.0F * kDegree;
    const auto angle = [&](double t) {
        const Vec3f between = palm(b, t) - palm(a, t);
        return std::atan2(between.y(), between.x());
    };
    const float from = angle(start_s);
    return held(start_s, end_s, 0.0, [&](double t) {
        return std::abs(std::remainder(angle(t) - from, 2.0F * std::numbers::pi_v<float>)) >=
               kTurnRad;
    });
}

bool fulfilled_before(const Movement& m, const std::string& gesture, double t_s) {
    constexpr double kBeforeS = 0.5;
    // The user's left is to the image's right, and up is toward smaller y.
    struct Way {
        const char* name;
        Vec3f along;
    };
    const std::array<Way, 4> strokes{{{"swipe_left", {1.0F, 0.0F, 0.0F}},
                                      {"swipe_right", {-1.0F, 0.0F, 0.0F}},
                                      {"swipe_up", {0.0F, -1.0F, 0.0F}},
                                      {"swipe_down", {0.0F, 1.0F, 0.0F}}}};
    for (const Way& way : strokes) {
        if (gesture == way.name) {
            return stroke(m, way.along, t_s - kBeforeS, t_s).has_value();
        }
    }
    if (gesture == "pinch") {
        return pinch(m, t_s - kBeforeS, t_s).has_value();
    }
    if (gesture == "grab") {
        return grab(m, t_s - kBeforeS, t_s).has_value();
    }
    const bool push = gesture == "push";
    return (push || gesture == "pull") &&
           thrust(m, {0.0F, 0.0F, push ? -1.0F : 1.0F}, t_s - kBeforeS, t_s).has_value();
}

}  // namespace xtrack::tools::corpus::definitions
