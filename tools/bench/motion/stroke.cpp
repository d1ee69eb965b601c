// SPDX-License-Identifier: Apache-2.0
#include "tools/bench/motion/stroke.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include <xtrack/depth_decoder.hpp>

namespace xtrack::tools::bench {

namespace {

constexpr double kHand_mm = 600.0;
constexpr double kWall_mm = 900.0;
constexpr double kNear_mm = 400.0;
constexpr double kFar_mm = 950.0;
constexpr double kBaseline_mm = 200.0;
constexpr double kProjectorFocal_px = 1400.0;
constexpr Size kProjectorSize{1024, 768};
// Measured is what happens so near to the middle, where all of the hand is in view and lit.
constexpr double kMeasuredReach_mm = 80.0;
// Frames: more than every pattern once, so that no pattern is favoured.
constexpr int kLeastMeasured = 12;
// Frames before, for everything that looks back: two cycles and some.
constexpr int kLeastWarmUp = 12;
// How long the room is empty before.
constexpr double kEmptyRoom_s = 0.5;
// What the projector's response is off by after it was corrected.
constexpr double kResidualGamma = 1.05;
// A cheap camera's colours: rows camera R, G, B, columns projector R, G, B.
constexpr double kCrosstalk[3][3] = {{0.86, 0.12, 0.02}, {0.07, 0.80, 0.13}, {0.02, 0.11, 0.87}};
// What a colour calibration is off by, in each entry.
constexpr double kColourError = 0.02;

Mat3d crosstalk(double error) {
    Mat3d matrix;
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) {
            const double sign = (row + column) % 2 == 0 ? -1.0 : 1.0;
            matrix(row, column) = kCrosstalk[row][column] + sign * error;
        }
    }
    return matrix;
}

SimSettings preset_of(MotionCamera camera) {
    auto made = SimSettings::preset(camera == MotionCamera::webcam_30 ? "webcam-30" : "ideal-60");
    SimSettings settings = std::move(*made);  // the names are those of the presets
    if (camera == MotionCamera::ideal_120) {
        settings.camera.frame_hz *= 2.0;
        settings.camera.exposure_s *= 0.5;
        settings.projector.light_grey *= 0.5;
        settings.room.ambient_grey *= 0.5;
    }
    return settings;
}

/// The room without a hand, up to the first moment of a stroke.
Result<std::vector<FramePtr>> empty_room(SimSettings settings) {
    settings.script.clear();
    settings.duration_s = kEmptyRoom_s;
    auto rig = SimulatedRig::create(settings);
    if (!rig) {
        return rig.error();
    }
    std::vector<FramePtr> frames;
    for (;;) {
        const FrameSource::Item item = (*rig)->next({});
        if (item.status != SourceStatus::ok) {
            return frames;
        }
        auto earlier = std::make_shared<Frame>(*item.frame);
        earlier->stamp = earlier->stamp - (*rig)->duration();
        frames.push_back(std::move(earlier));
    }
}

}  // namespace

std::string_view name_of(MotionCamera camera) {
    switch (camera) {
        case MotionCamera::ideal_60: return "ideal-60";
        case MotionCamera::ideal_120: return "ideal-120";
        case MotionCamera::webcam_30: break;
    }
    return "webcam-30";
}

double frames_per_second(MotionCamera camera) { return preset_of(camera).camera.frame_hz; }

Rig motion_rig() {
    Rig rig;
    rig.camera.size = {640, 480};
    rig.camera.matrix << 600.0, 0.0, 319.5, 0.0, 600.0, 239.5, 0.0, 0.0, 1.0;
    Pinhole projector;
    projector.size = kProjectorSize;
    // Shifted, as projectors' lenses are, so that the light is centred on the hand.
    const double centre_px =
        0.5 * kProjectorSize.width - kProjectorFocal_px * kBaseline_mm / kHand_mm;
    projector.matrix << kProjectorFocal_px, 0.0, centre_px, 0.0, kProjectorFocal_px,
        0.5 * kProjectorSize.height, 0.0, 0.0, 1.0;
    rig.projector = projector;
    rig.projector_from_camera_T << kBaseline_mm, 0.0, 0.0;
    rig.working_volume = WorkingVolume{kNear_mm, kFar_mm};
    return rig;
}

Mat3d motion_crosstalk() { return crosstalk(kColourError); }

Result<Stroke> simulate_stroke(MotionCamera camera, const PatternSequence& patterns, bool colour,
                               const Vec3f& velocity_mmps, std::uint64_t seed) {
    SimSettings settings = preset_of(camera);
    settings.name = name_of(camera);
    settings.seed = seed;
    settings.rig = motion_rig();
    settings.patterns = patterns;
    settings.projector.gamma = kResidualGamma;
    settings.room.wall_distance_mm = kWall_mm;
    settings.user.visible_body = false;
    settings.user.hand_distance_mm = kHand_mm;
    settings.user.hand_x_mm = 0.0;
    settings.user.hand_y_mm = 0.0;
    if (colour) {
        settings.camera.colour = true;
        settings.camera.chroma_422 = true;
        settings.rig.camera_from_projector_rgb = crosstalk(0.0);
    }
    const double frame_s = 1.0 / settings.camera.frame_hz;
    const double move_mm = velocity_mmps.norm() * frame_s;
    const int cycle =
        static_cast<int>(patterns.patterns.size()) * std::max(1, settings.clocks.hold_frames);
    int measured = std::max(kLeastMeasured, cycle);
    if (move_mm > 0.0) {
        measured = std::min(measured, 1 + static_cast<int>(2.0 * kMeasuredReach_mm / move_mm));
    }
    const int warm_up = std::max(kLeastWarmUp, 2 * cycle + 2);
    const double middle_s = (warm_up + 0.5 * measured) * frame_s;
    SimStep slide;
    slide.action = SimAction::slide;
    slide.duration_s = 2.0 * middle_s;
    slide.velocity_mmps = velocity_mmps;
    settings.script = {slide};
    // Depth that is registered to the middle of its window comes that much later.
    settings.duration_s = (warm_up + measured + cycle) * frame_s;

    auto rig = SimulatedRig::create(settings);
    if (!rig) {
        return rig.error();
    }
    Stroke stroke;
    if (patterns.patterns.size() == 1) {
        auto room = empty_room(settings);
        if (!room) {
            return room.error();
        }
        stroke.room = *std::move(room);
    }
    stroke.decoder_rig = settings.rig;
    if (colour) {
        stroke.decoder_rig.camera_from_projector_rgb = motion_crosstalk();
    }
    for (;;) {
        const FrameSource::Item item = (*rig)->next({});
        if (item.status != SourceStatus::ok) {
            break;
        }
        stroke.frames.push_back(item.frame);
        const auto number = static_cast<int>(item.frame->sequence);
        if (number >= warm_up && number < warm_up + measured) {
            stroke.truths.push_back((*rig)->truth());
        }
    }
    return stroke;
}

Result<MotionDecoder> MotionDecoder::create(const Rig& rig, const PatternSequence& patterns,
                                            const DecodeSettings& settings) {
    MotionDecoder decoder;
    auto by_patterns = DepthDecoder::create(rig, patterns, rig.camera.size, settings);
    if (by_patterns) {
        decoder.by_patterns_ = *std::move(by_patterns);
        return decoder;
    }
    if (patterns.patterns.size() != 1) {
        return by_patterns.error();
    }
    auto made = PaperDecoder::create(patterns, rig.camera.size, settings, &rig);
    if (!made) {
        return made.error();
    }
    decoder.in_space_ = *std::move(made);
    return decoder;
}

Result<HandAccuracy> measure_stroke(const Stroke& stroke, const PatternSequence& patterns,
                                    const DecodeSettings& settings) {
    const Size size = stroke.decoder_rig.camera.size;
    auto decoder = MotionDecoder::create(stroke.decoder_rig, patterns, settings);
    if (!decoder) {
        return decoder.error();
    }
    const auto compare = [](const DepthFrame& depth, const SimTruth& truth) {
        return measure_hand(depth, truth.depth.view(), truth.mask.view(), kMotionLimit_mm);
    };
    for (const FramePtr& frame : stroke.room) {
        (void)decoder->push(frame);
    }
    HandAccuracy all;
    for (const FramePtr& frame : stroke.frames) {
        if (decoder->push(frame) != DecodeState::depth_ready) {
            continue;
        }
        const DepthFrame& depth = decoder->depth();
        for (const SimTruth& truth : stroke.truths) {
            if (truth.sequence == depth.sequence) {
                all.add(compare(depth, truth));
            }
        }
    }
    if (all.pixels == 0) {
        DepthFrame nothing;
        nothing.depth = Image<std::uint16_t>(size.width, size.height, 0);
        for (const SimTruth& truth : stroke.truths) {
            all.add(compare(nothing, truth));
        }
    }
    return all;
}

}  // namespace xtrack::tools::bench
