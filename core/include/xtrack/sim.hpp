// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <xtrack/geometry.hpp>
#include <xtrack/image.hpp>
#include <xtrack/pattern.hpp>
#include <xtrack/result.hpp>
#include <xtrack/rig.hpp>
#include <xtrack/source.hpp>
#include <xtrack/stamp.hpp>

namespace xtrack {

/// Whose hand, the user's.
enum class SimHand : std::uint8_t { left, right };

/// What a simulated hand does next. Directions are the user's.
/// @since 0.1
enum class SimAction : std::uint8_t {
    idle,    ///< stays where it is: drift, tremor, small turns
    wander,  ///< slow movement to a random place and back; no gesture
    enter,   ///< comes in from below the frame, forearm after it
    leave,   ///< goes out the same way
    swipe_left,
    swipe_right,
    swipe_up,
    swipe_down,
    push,   ///< toward the screen, stays, returns
    pinch,  ///< thumb and index close, hold, open
    slide,  ///< through its resting place at constant velocity, from its first moment to its last
    wave,   ///< to and fro, left and right, five turns
};

/// One line of a script.
/// @since 0.1
struct SimStep {
    SimAction action = SimAction::idle;
    SimHand hand = SimHand::right;
    double start_s = -1.0;    ///< not before this time; negative: when the hand's last step is over
    double duration_s = 1.0;  ///< of idle, wander and slide, > 0; gestures take their own time
    /// Of slide: camera frame, at most 20000 mm/s. The hand is where it rests at half time, and so
    /// it starts half a way before that place, however far outside the image this is.
    Vec3f velocity_mmps = Vec3f::Zero();
};

inline constexpr std::size_t kSimFingerCount = 5;
inline constexpr std::size_t kSimAngleCount = 4 * kSimFingerCount;

/// How a hand is held at a moment. Camera frame.
/// @since 0.1
struct SimPose {
    double t_s = 0.0;                ///< from the stream's begin
    Vec3f palm_mm = Vec3f::Zero();   ///< the OpenXR palm joint: in the middle of the hand
    Vec3f turn_rad = Vec3f::Zero();  ///< pitch, yaw, roll away from palm to camera, fingers up; of
                                     ///< a left hand as in a mirror
    /// Four a finger, thumb first. A finger's: flexion at the knuckle, spread toward the thumb,
    /// flexion at the middle joint, at the end joint. The thumb's: opposition (across the palm),
    /// spread away from the index finger, flexion at its two outer joints.
    std::array<float, kSimAngleCount> fingers_rad{};
};

/// A movement that was worked out elsewhere.
/// @since 0.1
struct SimPath {
    SimHand hand = SimHand::right;
    /// Times increase; straight lines between, at rest before the first and after the last.
    std::vector<SimPose> poses;
};

/// The person. Ranges are those of people.
/// @since 0.1
struct SimUser {
    double hand_length_mm = 185.0;     ///< wrist to middle fingertip, 130..220
    double skin_albedo = 0.55;         ///< diffuse, in the projector's light, 0.15..0.8
    double hand_distance_mm = 680.0;   ///< camera Z of the resting palm, 450..800
    double hand_x_mm = -40.0;          ///< camera X of the resting right palm; the left one mirrors
    double hand_y_mm = 25.0;           ///< camera Y of the resting palm, down
    double chest_distance_mm = 930.0;  ///< camera Z of the front of the chest
    double clothing_albedo = 0.35;     ///< 0.05..0.9
    bool visible_body = true;          ///< false: a hand and its arm before a wall
};

/// What is behind and around.
/// @since 0.1
struct SimRoom {
    double wall_distance_mm = 1400.0;  ///< camera Z on the optical axis
    double wall_yaw_rad = 0.08;        ///< turned about the vertical, -0.5..0.5
    double wall_albedo = 0.75;         ///< 0.05..0.95
    double ambient_grey = 12.0;        ///< grey levels that ambient light adds to a white surface
};

/// The projector's light. Its geometry is in the rig.
/// @since 0.1
struct SimProjector {
    /// grey levels of a white surface 1 m away, square to the light, at full level, 0..1000
    double light_grey = 115.0;
    double contrast = 500.0;  ///< full level : level 0, >= 10
    double gamma = 1.0;       ///< light = value^gamma, 0.3..4; more of it in s_curve
    /// Of red, green, blue, 0..1: so much of the light follows value^2 (3 - 2 value) instead, the S
    /// of a picture mode
    std::array<double, 3> s_curve{};
    /// What its driver believes the two to be, and makes up for: patterns are handed over as the
    /// values whose light they want. Absent: as they are
    std::optional<ProjectorResponse> compensation;
    double blur_px = 1.0;  ///< Gaussian sigma of defocus, projector pixels, 0..20
};

/// The camera's sensor and lens. Its geometry is in the rig.
/// @since 0.1
struct SimCamera {
    bool colour = false;           ///< BGR frames
    bool chroma_422 = false;       ///< colour went through YUYV: one chroma sample for two pixels
    double frame_hz = 60.0;        ///< 1..240
    double exposure_s = 8e-3;      ///< of each row, at most one frame
    double readout_s = 0.0;        ///< first to last row; 0 = global shutter; at most one frame
    double blur_px = 0.5;          ///< Gaussian sigma of the lens, camera pixels, 0..1
    double full_well_e = 20000.0;  ///< electrons at grey level 255, 500..200000
    double read_noise_e = 8.0;     ///< rms, 0..200
    int motion_samples = 3;        ///< at most so many moments in an exposure, 1..8
};

/// Who tells the time. Locked: the projector shows one pattern a camera frame, switching between
/// exposures. Not locked: both run free, each pattern is held for `hold_frames` nominal frames.
/// @since 0.1
struct SimClocks {
    bool locked = true;
    int hold_frames = 1;     ///< 1..8; locked rigs use 1
    double drift_ppm = 0.0;  ///< of the projector's clock against the camera's, +-1000
    double phase_s = 0.0;    ///< when the first pattern goes up, after the first exposure began
    double latency_error_s = 0.0;  ///< what the driver's measured latency is wrong by, +-10e-3
    double guard_s = 0.5e-3;       ///< rows that come so near to a switch are not called clean
};

/// Everything that decides a simulation: the same settings give the same bits.
/// @since 0.1
struct SimSettings {
    std::string name = "ideal-60";
    std::uint64_t seed = 1;    ///< of noise, idle movement, and the variation between gestures
    double duration_s = 0.0;   ///< 0 = until the script is over
    Rig rig;                   ///< with a projector
    PatternSequence patterns;  ///< what the projector shows
    SimUser user;
    SimRoom room;
    SimProjector projector;
    SimCamera camera;
    SimClocks clocks;
    std::vector<SimStep> script;  ///< empty = nobody's hand comes
    /// Instead of a script, one a hand; they bring no labels.
    std::vector<SimPath> paths;

    /// @param name `ideal-60` (global shutter, locked, grey) or `webcam-30` (rolling shutter, free
    ///        clocks, YUYV colour); both with demo_script().
    /// Errors: invalid_argument, names the presets.
    /// @thread any @since 0.1
    [[nodiscard]] static Result<SimSettings> preset(std::string_view name);

    /// Another person on another day, from `seed` alone: side, size, skin, place, order of the
    /// gestures, light. The script is replaced by a demo script for that person.
    /// @thread one thread at a time @since 0.1
    void vary(std::uint64_t seed);

    /// Enters, swipes four ways, pushes, pinches twice, leaves.
    /// @thread any @since 0.1
    [[nodiscard]] static std::vector<SimStep> demo_script(SimHand hand = SimHand::right);

    /// Errors: invalid_argument, with the field and its range.
    /// @thread any @since 0.1
    [[nodiscard]] Result<void> validate() const;
};

/// A gesture of the script, with the times at which it really happens.
/// @since 0.1
struct SimLabel {
    std::string gesture;  ///< as in labels.csv: swipe_left, push, pinch ...
    SimHand hand = SimHand::right;
    Stamp start;   ///< the stroke begins (not its wind-up)
    Stamp end;     ///< the stroke is over; a pinch: open again
    Stamp commit;  ///< its definition is fulfilled for the first time, on the noise-free movement
};

/// Values of SimTruth::mask.
enum class SimPart : std::uint8_t { none = 0, hand = 1, forearm = 2, body = 3, wall = 6 };

inline constexpr std::size_t kSimJointCount = 26;
inline constexpr std::size_t kSimMaxHands = 2;

/// Where a hand really is. Camera frame, mm.
/// @since 0.1
struct SimHandTruth {
    SimHand hand = SimHand::right;
    bool in_view = false;       ///< some of the hand is in the image
    bool palm_visible = false;  ///< palm_mm and palm_radius_mm hold
    Vec3f palm_mm =
        Vec3f::Zero();  ///< centre of the largest circle in the hand's mask, at the skin
    float palm_radius_mm = 0.0F;
    std::array<Vec3f, kSimFingerCount> tips_mm{};  ///< distal extremes, thumb to little
    std::array<bool, kSimFingerCount> tip_visible{};
    std::array<Vec3f, kSimJointCount> joints_mm{};  ///< OpenXR's order, palm first
    float aperture_mm = 0.0F;                       ///< pad of the thumb to pad of the index finger
};

/// What a perfect instrument would have said of one frame. Depth and mask are as the shutter saw
/// them (each row at the middle of its exposure); hands are at the frame's stamp.
/// @since 0.1
struct SimTruth {
    Stamp stamp;
    std::uint64_t sequence = 0;
    Image<std::uint16_t> depth;  ///< 0.1 mm a step (kDepthUnitMm), 0 = nothing
    Image<std::uint8_t> mask;    ///< SimPart
    std::array<SimHandTruth, kSimMaxHands> hands{};
    std::size_t hand_count = 0;
};

/// A projector and a camera that exist only in memory: fringes on an articulated hand, its arm, a
/// body and a wall, with the shadows, blur and noise that real ones have. Frames come as fast as
/// they are asked for; stamps tell the simulated time.
/// @since 0.1
class SimulatedRig final : public FrameSource {
 public:
    /// Builds the scene: about 0.3 s.
    /// Errors: those of SimSettings::validate(); io where memory runs out.
    /// @thread any @since 0.1
    [[nodiscard]] static Result<std::unique_ptr<SimulatedRig>> create(const SimSettings& settings);
    ~SimulatedRig() override;

    [[nodiscard]] const Rig& rig() const override;
    [[nodiscard]] const PatternSequence& patterns() const override;
    /// The next frame, or `end`. Never waits and drops none; no heap allocation unless the caller
    /// keeps so many frames that the pool is empty.
    Item next(Duration timeout) override;
    /// Half the exposure and half the readout.
    [[nodiscard]] Duration delivery_delay() const override;

    /// Ground truth of the frame that next() gave last; rendered when asked.
    /// @pre next() gave a frame
    /// @ownership lent until the next call of next() or truth()
    [[nodiscard]] const SimTruth& truth();
    /// Gestures of the script, in order of start.
    /// @ownership lent for the rig's life
    [[nodiscard]] const std::vector<SimLabel>& labels() const;
    [[nodiscard]] const SimSettings& settings() const;
    /// Length of the stream.
    [[nodiscard]] Duration duration() const;

 private:
    class Impl;
    explicit SimulatedRig(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace xtrack
