// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <xtrack/sim.hpp>

#include "core/sim/random.hpp"

namespace xtrack {
namespace {

// The rig: a projector that hangs 200 mm over the camera and looks down at the hand, so that one
// fringe period of about half its height orders everything from the hand to the wall.
constexpr double kCameraFocalPx = 600.0;
constexpr Size kCameraSize{640, 480};
constexpr double kProjectorFocalPx = 1000.0;
constexpr Size kProjectorSize{1024, 768};
constexpr double kBaselineMm = 200.0;
constexpr double kProjectorPitchRad = 0.22;
constexpr WorkingVolume kVolume{400.0, 1600.0};

Rig default_rig() {
    Rig rig;
    rig.camera.size = kCameraSize;
    rig.camera.matrix << kCameraFocalPx, 0.0, 321.4, 0.0, kCameraFocalPx, 238.2, 0.0, 0.0, 1.0;
    Pinhole projector;
    projector.size = kProjectorSize;
    projector.matrix << kProjectorFocalPx, 0.0, 509.7, 0.0, kProjectorFocalPx, 386.1, 0.0, 0.0, 1.0;
    rig.projector = projector;
    // The projector stands at (0, -baseline, 0) of the camera frame and is turned down.
    rig.projector_from_camera_R =
        Eigen::AngleAxisd(kProjectorPitchRad, Eigen::Vector3d::UnitX()).toRotationMatrix();
    rig.projector_from_camera_T = rig.projector_from_camera_R * Vec3d(8.0, kBaselineMm, 5.0);
    Mat4d interaction = Mat4d::Identity();
    interaction(0, 0) = -1.0;
    interaction(1, 1) = -1.0;
    rig.interaction_from_camera = interaction;
    rig.working_volume = kVolume;
    return rig;
}

struct Bound {
    const char* field;
    double value;
    double low;
    double high;
};

Error out_of_range(const Bound& b) {
    return {ErrorCode::invalid_argument,
            std::string("simulation: ") + b.field + " is " + std::to_string(b.value) +
                "; give a value from " + std::to_string(b.low) + " to " + std::to_string(b.high)};
}

Result<void> validate_paths(const std::vector<SimPath>& paths) {
    if (paths.size() > kSimMaxHands) {
        return Error{ErrorCode::invalid_argument,
                     "simulation: paths has " + std::to_string(paths.size()) +
                         " hands; give at most " + std::to_string(kSimMaxHands)};
    }
    for (const SimPath& path : paths) {
        if (path.poses.empty()) {
            return Error{ErrorCode::invalid_argument,
                         "simulation: paths has a hand without poses; give one at least"};
        }
        constexpr double kLongestS = 36000.0;
        double before = -kLongestS;
        for (const SimPose& pose : path.poses) {
            const bool finite = pose.palm_mm.allFinite() && pose.turn_rad.allFinite() &&
                                std::all_of(pose.fingers_rad.begin(), pose.fingers_rad.end(),
                                            [](float angle) { return std::isfinite(angle); });
            if (!(pose.t_s > before && pose.t_s <= kLongestS) || !finite) {
                return Error{ErrorCode::invalid_argument,
                             "simulation: paths has a pose whose t_s does not increase, is over "
                             "36000, or whose numbers are not finite; mend it"};
            }
            before = pose.t_s;
        }
    }
    return {};
}

}  // namespace

Result<SimSettings> SimSettings::preset(std::string_view name) {
    SimSettings s;
    s.name = std::string(name);
    s.rig = default_rig();
    const auto period = volume_wide_period_px(s.rig, Axis::y);
    if (!period) {
        return period.error();
    }
    s.patterns = three_step_sequence(Axis::y, kProjectorSize, *period);
    s.patterns.gamma = 1.0;
    s.script = demo_script();
    if (name == "ideal-60") {
        return s;
    }
    if (name == "webcam-30") {
        s.camera.colour = true;
        s.camera.chroma_422 = true;
        s.camera.frame_hz = 30.0;
        s.camera.exposure_s = 1.0 / 60.0;  // one refresh of the projector
        s.camera.readout_s = 25e-3;
        s.camera.blur_px = 0.7;
        s.camera.full_well_e = 7000.0;
        s.camera.read_noise_e = 12.0;
        s.clocks.locked = false;
        s.clocks.hold_frames = 2;
        s.clocks.drift_ppm = 60.0;
        s.clocks.phase_s = 9e-3;
        s.clocks.latency_error_s = 0.4e-3;
        s.clocks.guard_s = 0.8e-3;
        return s;
    }
    return Error{ErrorCode::invalid_argument, "simulation: no preset is called '" +
                                                  std::string(name) +
                                                  "'; there are ideal-60 and webcam-30"};
}

std::vector<SimStep> SimSettings::demo_script(SimHand hand) {
    std::vector<SimStep> script;
    constexpr double kBeforeS = 0.6;  // an empty room first: something to learn the background from
    script.push_back({SimAction::enter, hand, kBeforeS, 1.0});
    script.push_back({SimAction::idle, hand, -1.0, 0.8});
    for (const SimAction action :
         {SimAction::swipe_left, SimAction::swipe_right, SimAction::swipe_up, SimAction::swipe_down,
          SimAction::push, SimAction::pinch, SimAction::pinch}) {
        script.push_back({action, hand, -1.0, 1.0});
    }
    script.push_back({SimAction::idle, hand, -1.0, 0.5});
    script.push_back({SimAction::leave, hand, -1.0, 1.0});
    return script;
}

void SimSettings::vary(std::uint64_t new_seed) {
    seed = new_seed;
    sim::Random random(sim::mix(new_seed, 404U));
    const SimHand hand = random.unit() < 0.5 ? SimHand::left : SimHand::right;
    user.hand_length_mm = random.between(165.0, 205.0);
    user.skin_albedo = random.between(0.35, 0.65);
    user.hand_distance_mm = random.between(640.0, 720.0);
    user.hand_x_mm = random.between(-60.0, -10.0);
    user.hand_y_mm = random.between(10.0, 40.0);
    user.chest_distance_mm = random.between(900.0, 980.0);
    user.clothing_albedo = random.between(0.2, 0.55);
    room.wall_distance_mm = random.between(1250.0, 1450.0);
    room.wall_yaw_rad = random.between(-0.10, 0.10);
    room.ambient_grey = random.between(6.0, 18.0);
    clocks.phase_s = random.between(0.0, 30e-3);
    script = demo_script(hand);
    // Steps between the first two (enters, rests) and the last two (rests, leaves) change places.
    constexpr std::size_t kFirst = 2;
    const std::size_t last = script.size() - 2;
    for (std::size_t i = last - 1; i > kFirst; --i) {
        const std::size_t other = kFirst + random.bits() % (i - kFirst + 1);
        std::swap(script[i], script[other]);
    }
    const auto at = static_cast<std::ptrdiff_t>(kFirst + random.bits() % (last - kFirst));
    script.insert(script.begin() + at, SimStep{SimAction::wander, hand, -1.0, 2.5});
}

Result<void> SimSettings::validate() const {
    if (auto ok = xtrack::validate(rig); !ok) {
        return ok.error();
    }
    if (!rig.projector) {
        return Error{ErrorCode::invalid_argument,
                     "simulation: rig has no projector; give projector_matrix"};
    }
    if (auto ok = xtrack::validate(patterns); !ok) {
        return ok.error();
    }
    PatternSequence compensated = patterns;
    compensated.response = projector.compensation;
    if (auto ok = xtrack::validate(compensated); !ok) {
        return Error{ok.error().code, "simulation: projector.compensation: " + ok.error().message};
    }
    if (!(patterns.projector_size == rig.projector->size)) {
        return Error{ErrorCode::invalid_argument,
                     "simulation: projector_size of the patterns and of the rig differ"};
    }
    constexpr double kHour = 3600.0;
    const double frame_s = 1.0 / std::max(camera.frame_hz, 1e-3);
    const std::array<Bound, 32> bounds{{
        {"duration_s", duration_s, 0.0, 10.0 * kHour},
        {"user.hand_length_mm", user.hand_length_mm, 130.0, 220.0},
        {"user.skin_albedo", user.skin_albedo, 0.15, 0.8},
        {"user.hand_distance_mm", user.hand_distance_mm, 450.0, 800.0},
        {"user.hand_x_mm", user.hand_x_mm, -300.0, 300.0},
        {"user.hand_y_mm", user.hand_y_mm, -300.0, 300.0},
        {"user.chest_distance_mm", user.chest_distance_mm, 600.0, 2000.0},
        {"user.clothing_albedo", user.clothing_albedo, 0.05, 0.9},
        {"room.wall_distance_mm", room.wall_distance_mm, 500.0, 6000.0},
        {"room.wall_yaw_rad", room.wall_yaw_rad, -0.5, 0.5},
        {"room.wall_albedo", room.wall_albedo, 0.05, 0.95},
        {"room.ambient_grey", room.ambient_grey, 0.0, 255.0},
        {"projector.light_grey", projector.light_grey, 0.0, 1000.0},
        {"projector.contrast", projector.contrast, 10.0, 1e6},
        {"projector.gamma", projector.gamma, 0.3, 4.0},
        {"projector.s_curve[0]", projector.s_curve[0], 0.0, 1.0},
        {"projector.s_curve[1]", projector.s_curve[1], 0.0, 1.0},
        {"projector.s_curve[2]", projector.s_curve[2], 0.0, 1.0},
        {"projector.blur_px", projector.blur_px, 0.0, 20.0},
        {"camera.frame_hz", camera.frame_hz, 1.0, 240.0},
        {"camera.exposure_s", camera.exposure_s, 1e-5, frame_s},
        {"camera.readout_s", camera.readout_s, 0.0, frame_s},
        {"camera.blur_px", camera.blur_px, 0.0, 1.0},
        {"camera.full_well_e", camera.full_well_e, 500.0, 200000.0},
        {"camera.read_noise_e", camera.read_noise_e, 0.0, 200.0},
        {"camera.motion_samples", static_cast<double>(camera.motion_samples), 1.0, 8.0},
        {"clocks.hold_frames", static_cast<double>(clocks.hold_frames), 1.0, 8.0},
        {"clocks.drift_ppm", clocks.drift_ppm, -1000.0, 1000.0},
        {"clocks.phase_s", clocks.phase_s, -1.0, 1.0},
        {"clocks.latency_error_s", clocks.latency_error_s, -10e-3, 10e-3},
        {"clocks.guard_s", clocks.guard_s, 0.0, 10e-3},
        {"camera_size",
         static_cast<double>(std::min(rig.camera.size.width, rig.camera.size.height)), 8.0,
         16384.0},
    }};
    for (const Bound& b : bounds) {
        if (!(b.value >= b.low && b.value <= b.high)) {
            return out_of_range(b);
        }
    }
    if (clocks.locked && (camera.readout_s > 0.0 || clocks.hold_frames != 1)) {
        return Error{ErrorCode::invalid_argument,
                     "simulation: clocks.locked needs a global shutter (camera.readout_s 0) and "
                     "clocks.hold_frames 1; set them, or locked = false"};
    }
    if (auto ok = validate_paths(paths); !ok) {
        return ok.error();
    }
    if (script.empty() && paths.empty() && duration_s == 0.0) {
        return Error{ErrorCode::invalid_argument,
                     "simulation: duration_s is 0 (until the script is over) and there is no "
                     "script; give one of them"};
    }
    for (const SimStep& step : script) {
        const bool lasts = step.action == SimAction::idle || step.action == SimAction::wander ||
                           step.action == SimAction::slide;
        if (!(step.start_s <= kHour * 10.0) || (lasts && !(step.duration_s > 0.0)) ||
            !(step.duration_s <= kHour)) {
            return Error{ErrorCode::invalid_argument,
                         "simulation: script has a step whose start_s or duration_s is not a time; "
                         "give seconds, duration_s above 0 and at most 3600"};
        }
        constexpr float kFastestMmps = 20000.0F;  // no hand is; far places stay within a float
        if (!(step.velocity_mmps.norm() <= kFastestMmps)) {
            return Error{ErrorCode::invalid_argument,
                         "simulation: script has a step whose velocity_mmps is no velocity; give "
                         "at most 20000 mm/s"};
        }
    }
    return {};
}

}  // namespace xtrack
