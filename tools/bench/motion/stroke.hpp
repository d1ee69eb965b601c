// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include <xtrack/depth_decoder.hpp>
#include <xtrack/frame.hpp>
#include <xtrack/paper_decoder.hpp>
#include <xtrack/result.hpp>
#include <xtrack/sim.hpp>

#include "tools/bench/motion/methods.hpp"
#include "tools/hand_accuracy.hpp"

namespace xtrack::tools::bench {

/// A pixel that errs by more is off.
inline constexpr double kMotionLimit_mm = 20.0;

/// Camera and clocks of a simulated rig, by name.
enum class MotionCamera {
    ideal_60,   ///< global shutter, locked, 60 frames a second
    ideal_120,  ///< the same at twice the rate, with half the light a frame
    webcam_30,  ///< rolling shutter, free clocks, every pattern held for two frames
};
inline constexpr std::array<MotionCamera, 3> kMotionCameras{
    MotionCamera::ideal_60, MotionCamera::webcam_30, MotionCamera::ideal_120};
[[nodiscard]] std::string_view name_of(MotionCamera camera);
[[nodiscard]] double frames_per_second(MotionCamera camera);

/// The rig of the reference: camera 640x480 of f 600 px, projector 1024x768 of f 1400 px 200 mm to
/// its left, depth from 400 to 950 mm.
[[nodiscard]] Rig motion_rig();
/// camera_from_projector_rgb as a calibration of colours finds it, a little off.
[[nodiscard]] Mat3d motion_crosstalk();

/// One hand that crosses the middle of the view at constant velocity, 600 mm away, before a wall at
/// 900 mm.
struct Stroke {
    /// Half a second of the room without a hand, earlier: of a pattern that never changes, whose
    /// order comes from what is known of the room. Else none.
    std::vector<FramePtr> room;
    std::vector<FramePtr> frames;  ///< from before the hand is in view
    std::vector<SimTruth> truths;  ///< of those frames in which it is near the middle
    Rig decoder_rig;               ///< what calibration knows of the rig
};

/// As sessions decode: a pattern that never changes, and whose order nothing gives, in space.
class MotionDecoder {
 public:
    /// @return an Error of DepthDecoder::create()
    [[nodiscard]] static Result<MotionDecoder> create(const Rig& rig,
                                                      const PatternSequence& patterns,
                                                      const DecodeSettings& settings);
    [[nodiscard]] DecodeState push(const FramePtr& frame) noexcept {
        return (in_space_ ? in_space_->push(frame) : by_patterns_->push(frame)).state;
    }
    [[nodiscard]] const DepthFrame& depth() const noexcept {
        return in_space_ ? in_space_->depth() : by_patterns_->depth();
    }

 private:
    std::optional<DepthDecoder> by_patterns_;
    std::optional<PaperDecoder> in_space_;  ///< either this or the other
};

/// @param velocity_mmps camera frame
/// @param seed of noise and sway
/// @return an Error of SimulatedRig::create()
[[nodiscard]] Result<Stroke> simulate_stroke(MotionCamera camera, const PatternSequence& patterns,
                                             bool colour, const Vec3f& velocity_mmps,
                                             std::uint64_t seed);

/// Decodes a stroke and compares every depth image that is registered to a frame with truth. Where
/// there is no such image at all, the hand is missing.
/// @return an Error of MotionDecoder::create()
[[nodiscard]] Result<HandAccuracy> measure_stroke(const Stroke& stroke,
                                                  const PatternSequence& patterns,
                                                  const DecodeSettings& settings);

}  // namespace xtrack::tools::bench
