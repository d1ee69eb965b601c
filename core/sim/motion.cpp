// SPDX-License-Identifier: Apache-2.0
#include "core/sim/motion.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/sim/random.hpp"

namespace xtrack::sim {
namespace {

// Peak speed of a minimum-jerk stroke over its mean speed.
constexpr double kPeakOverMean = 1.875;
// How people gesture at a screen; the ranges are drawn from for every gesture anew.
struct Range {
    double low;
    double high;
};
constexpr Range kSwipeLengthMm{250.0, 300.0};
constexpr Range kVerticalSwipeLengthMm{210.0, 250.0};  // the frame is less high than wide
constexpr Range kSwipePeakMmps{700.0, 1050.0};
constexpr Range kWindUpPeakMmps{190.0, 270.0};
constexpr Range kReturnPeakMmps{180.0, 260.0};
constexpr Range kPauseS{0.20, 0.40};
constexpr Range kAfterStrokeS{0.25, 0.50};
constexpr Range kPushLengthMm{140.0, 165.0};
constexpr Range kPushPeakMmps{600.0, 800.0};
constexpr Range kPushStayS{0.50, 0.80};
constexpr Range kWaveLengthMm{90.0, 130.0};
constexpr Range kWaveStrokeS{0.26, 0.34};
constexpr Range kPinchCloseS{0.28, 0.45};
constexpr Range kPinchHoldS{0.30, 0.80};
constexpr Range kPinchOpenS{0.25, 0.40};
constexpr Range kEnterS{1.3, 1.7};
constexpr Range kBetweenGesturesS{0.35, 0.80};
constexpr double kStrokeTiltRad = 0.09;  // a swipe is not level: up to 5 degrees

// The definitions that `commit` follows. The recogniser asks for more on purpose (a push of 370
// mm/s, a pinch of 80 ms), so part of the delay after `commit` that a demo shows is meant.
constexpr double kSwipeCandidateMmps = 200.0;
constexpr double kSwipeMeanMmps = 300.0;
constexpr double kSwipeMm = 100.0;
constexpr double kPushMmps = 330.0;
constexpr double kPushWindowS = 0.240;
constexpr int kWaveTurns = 4;
constexpr double kPinchMm = 20.0;
constexpr double kPinchS = 0.050;
constexpr double kLookS = 0.001;  // step of the search on the known movement

std::array<float, 3> to_array(const Vec3f& v) { return {v.x(), v.y(), v.z()}; }
Vec3f to_vector(const std::array<float, 3>& a) { return {a[0], a[1], a[2]}; }
Stamp stamp_of(double t_s) { return Stamp{std::llround(t_s * 1e9)}; }

const char* name_of(SimAction action) {
    switch (action) {
        case SimAction::swipe_left: return "swipe_left";
        case SimAction::swipe_right: return "swipe_right";
        case SimAction::swipe_up: return "swipe_up";
        case SimAction::swipe_down: return "swipe_down";
        case SimAction::push: return "push";
        case SimAction::pinch: return "pinch";
        case SimAction::wave: return "wave";
        case SimAction::idle:
        case SimAction::wander:
        case SimAction::enter:
        case SimAction::leave:
        case SimAction::slide: break;
    }
    return "";
}

/// The camera faces the user: the user's left is to the image's right.
Vec3f direction_of(SimAction action) {
    switch (action) {
        case SimAction::swipe_left: return {1.0F, 0.0F, 0.0F};
        case SimAction::swipe_right: return {-1.0F, 0.0F, 0.0F};
        case SimAction::swipe_up: return {0.0F, -1.0F, 0.0F};
        case SimAction::swipe_down: return {0.0F, 1.0F, 0.0F};
        case SimAction::push: return {0.0F, 0.0F, -1.0F};
        case SimAction::pinch:
        case SimAction::wave:
        case SimAction::idle:
        case SimAction::wander:
        case SimAction::enter:
        case SimAction::leave:
        case SimAction::slide: break;
    }
    return Vec3f::Zero();
}

Vec3f home_of(const SimUser& user, SimHand hand) {
    const double x = hand == SimHand::right ? user.hand_x_mm : -user.hand_x_mm;
    return {static_cast<float>(x), static_cast<float>(user.hand_y_mm),
            static_cast<float>(user.hand_distance_mm)};
}

/// Below the lower edge of the image, with the fingers down too.
Vec3f away_of(const SimSettings& settings, SimHand hand) {
    const Pinhole& camera = settings.rig.camera;
    const double z = settings.user.hand_distance_mm + 60.0;
    const double edge = (camera.size.height - camera.matrix(1, 2)) / camera.matrix(1, 1) * z;
    const double x = home_of(settings.user, hand).x() * 1.4;
    return {static_cast<float>(x), static_cast<float>(edge + settings.user.hand_length_mm),
            static_cast<float>(z)};
}

Vec3f shoulder_of(const SimUser& user, SimHand hand) {
    constexpr double kShoulderHalfMm = 185.0;
    constexpr double kShoulderDownMm = -35.0;
    constexpr double kShoulderBehindChestMm = 75.0;
    return {static_cast<float>(hand == SimHand::right ? -kShoulderHalfMm : kShoulderHalfMm),
            static_cast<float>(kShoulderDownMm),
            static_cast<float>(user.chest_distance_mm + kShoulderBehindChestMm)};
}

}  // namespace

/// Lays the steps of a script onto the tracks.
class HandMotion::Planner {
 public:
    Planner(HandMotion& motion, const SimSettings& settings, const HandModel& model)
        : motion_(motion),
          settings_(settings),
          model_(model),
          random_(mix(settings.seed, 101U + static_cast<std::uint64_t>(motion.hand_))),
          home_(home_of(settings.user, motion.hand_)),
          pinch_closed_(solve_pinch_closed(model)) {}

    void run(const SimStep& step) {
        now() = std::max(now(), step.start_s);
        switch (step.action) {
            case SimAction::idle: now() += step.duration_s; break;
            case SimAction::wander: wander(step.duration_s); break;
            case SimAction::enter:
                move_to(home_, now() + draw(kEnterS));
                now() += draw(kBetweenGesturesS);
                break;
            case SimAction::leave:
                move_to(away_of(settings_, motion_.hand_), now() + draw(kEnterS));
                break;
            case SimAction::swipe_left:
            case SimAction::swipe_right:
            case SimAction::swipe_up:
            case SimAction::swipe_down: swipe(step.action); break;
            case SimAction::push: push(); break;
            case SimAction::pinch: pinch(); break;
            case SimAction::slide: slide(step); break;
            case SimAction::wave: wave(); break;
        }
    }

 private:
    double& now() { return motion_.clock_s_; }
    double draw(const Range& range) { return random_.between(range.low, range.high); }
    Vec3f place() const { return to_vector(motion_.place_.target()); }

    void move_to(const Vec3f& target, double end_s) {
        motion_.place_.move(now(), end_s, to_array(target));
        now() = end_s;
    }
    void move_at(const Vec3f& target, double peak_mmps) {
        constexpr double kShortestS = 0.15;
        const double length = (target - place()).norm();
        move_to(target, now() + std::max(kShortestS, length * kPeakOverMean / peak_mmps));
    }
    Vec3f near_home(double spread_mm) {
        const auto one = [&] { return static_cast<float>(random_.between(-spread_mm, spread_mm)); };
        const Vec3f off(one(), one(), one());
        return home_ + off;
    }

    void wander(double duration_s) {
        const double end = now() + duration_s;
        constexpr double kShortestLegS = 0.6;
        constexpr double kSpreadMm = 60.0;
        while (end - now() > 2.0 * kShortestLegS) {
            move_at(near_home(kSpreadMm), draw({60.0, 220.0}));
            now() += draw(kPauseS);
        }
        move_at(home_, draw(kReturnPeakMmps));
        now() = std::max(now(), end);
    }

    void slide(const SimStep& step) {
        const Vec3f half = step.velocity_mmps * static_cast<float>(0.5 * step.duration_s);
        motion_.place_.move_evenly(now(), now(), to_array(home_ - half));
        motion_.place_.move_evenly(now(), now() + step.duration_s, to_array(home_ + half));
        now() += step.duration_s;
    }

    void swipe(SimAction action) {
        const bool level = action == SimAction::swipe_left || action == SimAction::swipe_right;
        const double length = draw(level ? kSwipeLengthMm : kVerticalSwipeLengthMm);
        const double tilt = random_.between(-kStrokeTiltRad, kStrokeTiltRad);
        Vec3f along = direction_of(action);
        const Vec3f across(-along.y(), along.x(), 0.0F);
        along = along * static_cast<float>(std::cos(tilt)) +
                across * static_cast<float>(std::sin(tilt));
        const Vec3f middle = near_home(12.0);
        const Vec3f half = along * static_cast<float>(length / 2.0);
        move_at(middle - half, draw(kWindUpPeakMmps));
        now() += draw(kPauseS);
        const double start = now();
        move_at(middle + half, draw(kSwipePeakMmps));
        // The palm turns with the stroke, as a forearm about its elbow does.
        const double lean = level ? 0.10 : 0.12;
        std::array<float, 3> turned{};
        turned[level ? 1 : 0] = static_cast<float>(
            (action == SimAction::swipe_left || action == SimAction::swipe_up ? -lean : lean) *
            (level && motion_.hand_ == SimHand::left ? -1.0 : 1.0));
        motion_.turn_.move(start, now(), turned);
        add_stroke_label(action, start, now(), along);
        now() += draw(kAfterStrokeS);
        const double back = now();
        move_at(near_home(15.0), draw(kReturnPeakMmps));
        motion_.turn_.move(back, now(), {});
        now() += draw(kBetweenGesturesS);
    }

    void push() {
        move_at(near_home(12.0), draw(kWindUpPeakMmps));
        now() += draw(kPauseS);
        const double start = now();
        const double length = draw(kPushLengthMm);
        const Vec3f from = place();
        // A push goes where the hand points: along its line of sight, a little off.
        Vec3f along = direction_of(SimAction::push);
        along.x() = static_cast<float>(random_.between(-0.10, 0.10));
        along.y() = static_cast<float>(random_.between(-0.10, 0.10));
        along.normalize();
        move_at(from + along * static_cast<float>(length), draw(kPushPeakMmps));
        add_stroke_label(SimAction::push, start, now(), along);
        now() += draw(kPushStayS);
        move_at(near_home(12.0), draw(kReturnPeakMmps));
        now() += draw(kBetweenGesturesS);
    }

    void wave() {
        constexpr int kStrokes = 6;
        move_at(near_home(12.0), draw(kWindUpPeakMmps));
        now() += draw(kPauseS);
        const Vec3f middle = place();
        const Vec3f half =
            direction_of(SimAction::swipe_left) * static_cast<float>(draw(kWaveLengthMm) / 2.0);
        const double start = now();
        double commit = start;
        for (int stroke = 0; stroke < kStrokes; ++stroke) {
            const float side = stroke % 2 == 0 ? 1.0F : -1.0F;
            move_to(middle + side * half, now() + draw(kWaveStrokeS));
            commit = stroke + 1 == kWaveTurns ? now() : commit;
        }
        add_label(SimAction::wave, start, now(), commit);
        move_at(near_home(12.0), draw(kReturnPeakMmps));
        now() += draw(kBetweenGesturesS);
    }

    void pinch() {
        constexpr double kShapeS = 0.5;
        move_at(near_home(15.0), draw(kWindUpPeakMmps));
        // Turned so that the camera looks past the thumb at the gap.
        const auto yaw = static_cast<float>(random_.between(-0.45, -0.25));
        motion_.turn_.move(now(), now() + kShapeS, {0.0F, yaw, 0.0F});
        motion_.fingers_.move(now(), now() + kShapeS, pinch_open());
        now() += kShapeS + draw(kPauseS);
        const double start = now();
        const double closed = start + draw(kPinchCloseS);
        motion_.fingers_.move(start, closed, pinch_closed_);
        const double opens = closed + draw(kPinchHoldS);
        const double end = opens + draw(kPinchOpenS);
        motion_.fingers_.move(opens, end, pinch_open());
        add_pinch_label(start, end);
        now() = end + draw(kPauseS);
        motion_.turn_.move(now(), now() + kShapeS, {});
        motion_.fingers_.move(now(), now() + kShapeS, relaxed_open());
        now() += kShapeS + draw(kBetweenGesturesS);
    }

    void add_label(SimAction action, double start, double end, double commit) {
        motion_.labels_.push_back(
            {name_of(action), motion_.hand_, stamp_of(start), stamp_of(end), stamp_of(commit)});
    }

    /// Measured on the movement itself, drift and tremor included, as a judge would.
    void add_stroke_label(SimAction action, double start, double end, const Vec3f& along) {
        const auto travelled = [&](double t) { return (motion_.at(t).palm_mm).dot(along); };
        double begun = start;
        bool candidate = false;
        double commit = end;
        for (double t = start; t < end; t += kLookS) {
            if (action == SimAction::push) {
                if (travelled(t) - travelled(t - kPushWindowS) >= kPushMmps * kPushWindowS) {
                    commit = t;
                    break;
                }
                continue;
            }
            if (!candidate) {
                candidate = travelled(t + kLookS) - travelled(t) >= kSwipeCandidateMmps * kLookS;
                begun = t;
                continue;
            }
            const double length = travelled(t) - travelled(begun);
            if (length >= kSwipeMm && length >= kSwipeMeanMmps * (t - begun)) {
                commit = t;
                break;
            }
        }
        add_label(action, start, end, commit);
    }

    void add_pinch_label(double start, double end) {
        const auto scale = static_cast<float>(settings_.user.hand_length_mm) / kModelHandLengthMm;
        double narrow_since = end;
        double commit = end;
        bool narrow = false;
        for (double t = start; t < end; t += kLookS) {
            const PosedBones bones = pose_bones(motion_.at(t), motion_.hand_, scale);
            if (aperture_mm(model_, bones) > kPinchMm) {
                narrow = false;
                continue;
            }
            if (!narrow) {
                narrow = true;
                narrow_since = t;
            }
            if (t - narrow_since >= kPinchS) {
                commit = t;
                break;
            }
        }
        add_label(SimAction::pinch, start, end, commit);
    }

    HandMotion& motion_;
    const SimSettings& settings_;
    const HandModel& model_;
    Random random_;
    Vec3f home_;
    FingerAngles pinch_closed_;
};

HandMotion::HandMotion(const SimSettings& settings, SimHand hand, const HandModel& model)
    : hand_(hand),
      place_({}),
      turn_({}),
      fingers_(relaxed_open()),
      sway_(std::in_place, settings.seed, hand) {
    bool enters = false;
    for (const SimStep& step : settings.script) {
        if (step.hand == hand) {
            enters = step.action == SimAction::enter;
            break;
        }
    }
    place_ = Track<3>(to_array(enters ? away_of(settings, hand) : home_of(settings.user, hand)));
    shoulder_mm_ = shoulder_of(settings.user, hand);
    Planner planner(*this, settings, model);
    for (const SimStep& step : settings.script) {
        if (step.hand == hand) {
            planner.run(step);
        }
    }
}

HandMotion::HandMotion(const SimSettings& settings, const SimPath& path)
    : hand_(path.hand),
      shoulder_mm_(shoulder_of(settings.user, path.hand)),
      clock_s_(path.poses.back().t_s),
      place_(to_array(path.poses.front().palm_mm)),
      turn_(to_array(path.poses.front().turn_rad)),
      fingers_(path.poses.front().fingers_rad) {
    double before = path.poses.front().t_s;
    for (const SimPose& pose : path.poses) {
        place_.move_evenly(before, pose.t_s, to_array(pose.palm_mm));
        turn_.move_evenly(before, pose.t_s, to_array(pose.turn_rad));
        fingers_.move_evenly(before, pose.t_s, pose.fingers_rad);
        before = pose.t_s;
    }
}

HandPose HandMotion::at(double t_s) const {
    HandPose pose;
    pose.shoulder_mm = shoulder_mm_;
    pose.palm_mm = to_vector(place_.at(t_s));
    pose.turn_rad = to_vector(turn_.at(t_s));
    pose.fingers = fingers_.at(t_s);
    if (sway_) {
        sway_->add(t_s, pose);
    }
    return pose;
}

}  // namespace xtrack::sim
