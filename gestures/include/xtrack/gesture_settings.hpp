// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

#include <xtrack/gesture_event.hpp>
#include <xtrack/result.hpp>

namespace xtrack {

/// Every threshold of the recognisers, each with its unit in its name, then its range and its
/// source. Lengths are of a real hand in mm, so they do not depend on the camera.
/// @since 0.1
struct GestureSettings {
    // --- what is recognised ----------------------------------------------------------------------
    bool swipe = true;
    bool push = true;
    bool pull = true;
    bool pinch = true;
    bool double_pinch = false;
    bool grab = true;
    bool tap = true;
    bool double_tap = false;
    bool circle = true;
    bool wave = false;  ///< off: who beckons or gesticulates waves too
    bool raise = false;
    bool dwell = false;
    bool press = false;
    bool touch = false;
    bool drag = false;
    bool open_palm = false;
    bool fist = false;
    bool point = false;
    bool victory = false;
    bool thumb_up = false;
    bool thumb_down = false;
    bool two_hand_zoom = false;
    bool two_hand_rotate = false;
    /// Only the hand that took the session is listened to, and a second one of the same body.
    bool engage = false;

    // --- the hand itself -------------------------------------------------------------------------
    /// Below it a hand counts as not seen. 0..1. MediaPipe's and OpenXR runtimes' usual line.
    double hand_confidence = 0.6;
    /// Seen for so long before it counts. 0..1000. Two to three frames at 30 fps.
    double hand_valid_ms = 100.0;
    /// Not seen for so long: what is active is cancelled. 20..1000. Three frames at 30 fps.
    double lost_freeze_ms = 120.0;
    /// Not seen for so long: gone; until then it comes back without an entry. 120..2000.
    double gone_ms = 300.0;
    /// No events for so long after a hand enters: its way in is no gesture. 0..2000. Leap, Kinect.
    double entry_lockout_ms = 300.0;
    /// Window of the line fit that gives velocity. 60..200. Less is noise, more is lag.
    double velocity_window_ms = 100.0;

    /// A fist that lasts says nothing more, where grab, fist and two-hand gestures are off: from so
    /// much of a fist, for so long, until it is this open again. 0.5..1; 100..3000; 0..0.95.
    double silence_fist = 0.8;
    double silence_ms = 500.0;
    double silence_open = 0.65;

    // --- whose session ---------------------------------------------------------------------------
    /// Where hands are listened to while `engage` is on: interaction frame, palm. -3000..3000.
    double zone_left_mm = -500.0;
    double zone_right_mm = 500.0;
    double zone_bottom_mm = -350.0;
    double zone_top_mm = 450.0;
    double zone_near_mm = 100.0;
    double zone_far_mm = 1000.0;
    double zone_margin_mm = 20.0;  ///< to leave it. 0..200. NiTE1's sessions.
    /// What takes a session that is nobody's: being still in the zone, waving, raising. NiTE1.
    bool engage_by_stillness = true;
    bool engage_by_wave = true;
    bool engage_by_raise = true;
    /// Slower than this for so long is still; as long a second hand must fit the owner's body to
    /// join. 20..500; 50..3000.
    double engage_still_mmps = 200.0;
    double engage_ms = 300.0;
    /// Outside for so long, or idle (no gesture, moved by less) for so long, and it is over.
    /// 50..3000; 1000..600000; 5..300. NiTE1.
    double engage_leave_ms = 300.0;
    double engage_idle_ms = 15000.0;
    double engage_idle_mm = 40.0;
    /// An owner that was lost finds its session kept for so long, within so much of where it was;
    /// nobody else takes it meanwhile. 0..10000; 20..1000.
    double engage_return_ms = 2000.0;
    double engage_return_mm = 300.0;
    /// Elbows of an adult's body lie no farther apart: to the side, up, and in depth; of smaller
    /// hands in proportion. A second hand joins well within. 100..2000. Shoulders of adults are 400
    /// wide, and elbows spread beside them.
    double body_width_mm = 750.0;
    double body_height_mm = 300.0;
    double body_depth_mm = 300.0;

    // --- swipe -----------------------------------------------------------------------------------
    /// Mean over the stroke. 100..3000. NiTE1 250, TouchFree 625.
    double swipe_speed_mmps = 300.0;
    /// The same where joints show that the palm leads the motion like a paddle, which nobody does
    /// by chance. 100..3000. NiTE1.
    double swipe_paddle_speed_mmps = 250.0;
    /// Length at which it commits. 40..600. TouchFree.
    double swipe_length_mm = 100.0;
    /// Up and down, too. Hands that go to faces, cups and keyboards swipe up and down by any rule,
    /// so that who needs the sides only switches it off.
    bool swipe_vertical = true;
    /// The candidate dies below it, and none begins. 50..1000; above three sigma of the velocity of
    /// a hand with 3 mm of noise (65 mm/s at 15 fps).
    double swipe_dies_mmps = 200.0;
    /// From the horizontal, in the x-y plane. 5..44. NiTE1.
    double swipe_horizontal_deg = 25.0;
    /// From the vertical, in the x-y plane. 5..44. NiTE1.
    double swipe_vertical_deg = 20.0;
    /// Out of the x-y plane. 10..60. Measured: swipes of recordings 0..28, hands that reach for
    /// something at the side 0..45.
    double swipe_depth_deg = 35.0;
    /// Up and away from the screen, or down and toward it: to the face and from it. 10..60.
    double swipe_body_deg = 25.0;
    /// So far below where the hand is held up begin no swipes: they come from a table, or from a
    /// hand that hung down. 60..2000.
    double swipe_below_mm = 160.0;
    /// Swipes up and down are asked for a preparation (Kendon 2004: preparation, stroke): they
    /// begin so far below that place, or above it, or are flicks of this speed at least. Who goes
    /// to a face, a cup or a keyboard does neither. Off: from where the hand is held up they may
    /// begin at once. 0..200; 100..3000.
    bool swipe_prepared = false;
    double swipe_prepared_mm = 20.0;
    double swipe_flick_mmps = 800.0;
    /// Sideways motion allowed: this, and a share of the length. 5..200; 0..1.
    double swipe_sideways_mm = 30.0;
    double swipe_sideways_share = 0.2;
    /// How far the way may turn, were it an arc: from there on it is more likely a circle's first
    /// quarter. 10..180. Measured: swipes of joints 0..36, circles of 40..130 mm radius 40..100.
    double swipe_bend_deg = 40.0;
    /// Mean extension of the four fingers that a camera's hand has at least: nobody swipes with a
    /// fist, and a fist that is carried does all else that a swipe does. 0 = any hand. 0..1.
    /// Measured: swipes 0.46..1, fists that are carried 0.2..0.35.
    double swipe_open = 0.4;
    /// Grab value, mean over the stroke, at most; of no effect where it is known in less than half
    /// of the images. 0..1. Measured: swipes of joints 0..0.34, of cameras 0..0.05.
    double swipe_grab = 0.45;
    /// After a commit the opposite direction is barred so long *and* until the hand has been
    /// slower than swipe_rest_mmps. 0..2000; 10..200. The return stroke is no swipe.
    double swipe_return_bar_ms = 450.0;
    double swipe_rest_mmps = 65.0;
    /// Within so long an opposite stroke that is slower than this share of the swipe's speed brings
    /// the hand back. 0..5000; 0..1.
    double swipe_return_memory_ms = 1500.0;
    double swipe_return_share = 0.8;
    /// The hand's flat side leads when palm direction . motion is above it. 0.1..1. Measured on
    /// joints: swipes 0.6..1.0, hands carried from place to place -0.3..0.4.
    double swipe_facing = 0.5;
    /// The back of the hand leads on the way back too, and hands are held up flat on their way to
    /// something else, so more is asked. 100..3000; 40..600. Measured: returns 230..340 mm/s.
    double swipe_back_speed_mmps = 380.0;
    double swipe_back_length_mm = 120.0;
    /// A hand that is merely carried (flat side not in front) or that points must move with this
    /// much more intent. 100..3000; 40..600. Measured: carried hands reach 390 mm/s over 180 mm.
    double swipe_carried_speed_mmps = 480.0;
    double swipe_carried_length_mm = 150.0;
    /// Mean extension of middle, ring and little finger under which a hand points. 0..1. Circles
    /// and letters are drawn at 0.1..0.45, swipes made at 0.5..1.
    double swipe_pointing_extension = 0.45;
    /// The index tip's share of the palm's way, as second vote. 0..1.
    double swipe_tip_share = 0.5;

    // --- push, pull ------------------------------------------------------------------------------
    /// Mean speed over the window. 100..3000; 100..600. NiTE1 has 330; hands that reach out to
    /// begin something else come to 350.
    double push_speed_mmps = 370.0;
    double push_window_ms = 240.0;
    /// From the screen's normal. 5..60. NiTE1.
    double push_cone_deg = 30.0;
    /// From the motion before, if there was one. 0..180. NiTE1 has 20; a hand that is raised and
    /// reaches out to begin something else turns by 40..90, one that winds up by more.
    double push_turn_deg = 100.0;
    /// Slower for so long before the next. 20..500; 0..2000. NiTE1.
    double push_stable_mmps = 130.0;
    double push_stable_ms = 360.0;
    /// Within so long after a thrust ended, an opposite one brings the hand back, unless it is 1.2
    /// times as fast. 0..5000.
    double push_return_memory_ms = 1500.0;
    /// As swipe_facing, for the palm toward the screen. 0..1.
    double push_facing = 0.5;
    /// A pull goes at least so far, because hands draw back to rest after whatever they
    /// did. 40..600. Measured: hands that draw back 100..130, a pull 300; those of the simulated
    /// people have 120..200, so that it is set where few of the first and most of these count.
    double pull_length_mm = 115.0;

    // --- pinch -----------------------------------------------------------------------------------
    /// Thumb tip to index tip, or the share of the hand's length if that is more. 5..40; 0..0.3.
    /// LeapC has 18, widened for our noise.
    double pinch_close_mm = 20.0;
    double pinch_close_share = 0.11;
    /// Opens again. 10..80; at least pinch_close_mm + 3 pinch_noise_mm. LeapC has 24.
    double pinch_release_mm = 30.0;
    /// Standard deviation of the aperture: what pinch_release_mm is checked against, nothing else.
    /// 0..20. Measured: 2 to 3 mm.
    double pinch_noise_mm = 3.0;
    /// Closed for so long, half of the time before the first closed image counted, so that it means
    /// the same at any rate. 0..1000. LeapC has 50; hands in motion touch by chance for 50 to 110.
    double pinch_hold_ms = 110.0;
    /// The approach: seen open by so much, at most so long before it closes. 20..120; 50..3000.
    double pinch_open_mm = 40.0;
    double pinch_approach_ms = 600.0;
    /// Not while the palm moves faster. 20..1000. Measured: pinches begin at 5..120 mm/s.
    double pinch_palm_mmps = 150.0;
    /// Nor of a camera's palm that moves farther while its depth is measured (HandFrame::span; 67
    /// ms where it is not known): its fingers are smeared. 2..1000. Measured: 10 loses a tenth of
    /// the pinches that are seen at 60 images a second.
    double pinch_blur_mm = 15.0;
    /// It must come to rest within so long of the touch. 0..5000. Measured: 0..250.
    double pinch_settle_ms = 400.0;
    /// The three other fingers stay: one that folds by more in the approach makes a fist or a
    /// number, no pinch. 0.05..1 of the extension. Measured: pinches 0..0.2, fists 0.3..0.6.
    double pinch_others_fold = 0.25;
    /// Before it the thumb stands free: thumb tip to middle tip. A thumb that rests on folded
    /// fingers belongs to a pointing hand, whose index taps. 0..100. Measured: pinches 42 and
    /// more, taps and letters drawn in the air 8..31.
    double pinch_thumb_free_mm = 36.0;
    /// All fingertips together with straight fingers are a bunch (to expand), no pinch: thumb tip
    /// to middle tip under it, mean extension of the three others over it. 0..60; 0..1.
    double pinch_bunch_mm = 20.0;
    double pinch_bunch_extension = 0.68;
    /// The index does its share of the way that brings the tips together. 0..0.9. Measured: pinches
    /// 0.5..0.85, thumbs that fold in front of the palm 0.1..0.3.
    double pinch_index_share = 0.25;

    // --- grab ------------------------------------------------------------------------------------
    /// Strength from which on it is closed, and at which it opens again. 0.3..1; 0.1..0.9; at least
    /// 0.1 apart. TouchFree has 0.8 and 0.7.
    double grab_strength = 0.80;
    double grab_release = 0.65;
    /// Closed for so long, counted likewise. 0..1000.
    double grab_hold_ms = 100.0;
    /// The approach: seen so open, at most so long before it closes. 0..0.6; 50..3000. Measured:
    /// grabs take 100..570; hands that half close at rest have 0.4..0.7.
    double grab_open = 0.25;
    double grab_approach_ms = 700.0;
    /// It begins once the palm is slower than this, which must be within so long. 20..2000;
    /// 0..5000. Measured: grabs reach out at 800 mm/s, and are at 50..180 mm/s 200 ms later.
    double grab_palm_mmps = 200.0;
    double grab_settle_ms = 400.0;
    /// The thumb lies on the fingers: its tip is at most this share of the hand's length from the
    /// nearest joint of index, middle and ring finger. 0.05..1. Measured: grabs 0.06..0.17, shown
    /// thumbs 0.3..0.5.
    double grab_thumb_share = 0.19;

    // --- tap -------------------------------------------------------------------------------------
    /// The index bends by so much in its two inner joints, at this speed at least; of a camera's
    /// hand it is how far the way from palm to tip leans toward the screen. 10..120; 10..60;
    /// 50..2000. TouchFree has 30 and 180. Measured: taps 73..170 at 420..1370, and 50.
    double tap_flexion_deg = 55.0;
    double tap_lean_deg = 30.0;
    double tap_speed_degps = 180.0;
    /// It straightens again by this, and by this share of the bend, at most so long after it was
    /// straight. 5..90; 0.1..1; 100..3000. Measured: 450..1300 ms.
    double tap_open_deg = 15.0;
    double tap_open_share = 0.3;
    double tap_within_ms = 1500.0;
    /// The hand points, before and after: mean extension of the three others at most; above it the
    /// hand is open, of which more is asked (docs/gestures/tap.md). 0..1. Measured: taps 0.1..0.45.
    double tap_pointing_extension = 0.5;
    /// The palm stays within. 10..500. Measured: taps 30..105, letters drawn in the air 140..215.
    double tap_palm_mm = 120.0;
    /// Another finger bends, or stretches, at most by this share of the index's bend. 0..2; 0..2.
    double tap_others_bend = 0.5;
    double tap_others_stretch = 0.8;

    // --- double pinch, double tap ----------------------------------------------------------------
    /// From the first to the second. 100..2000. The usual double click.
    double double_within_ms = 500.0;

    // --- circle ----------------------------------------------------------------------------------
    /// Radius. 10..200; 100..1000. Leap, NiTE.
    double circle_least_mm = 40.0;
    double circle_most_mm = 400.0;
    /// So much of a turn is one; then each full turn. 0.5..2. Leap.
    double circle_turns = 0.75;
    /// The farthest off the circle, as a share of its radius. 0.05..0.6. NiTE.
    double circle_error = 0.3;
    /// Without progress for so long it ends. 50..2000. NiTE.
    double circle_stale_ms = 300.0;
    /// A turn takes at most so long. 500..10000.
    double circle_within_ms = 3000.0;

    // --- press -----------------------------------------------------------------------------------
    /// The way toward the screen that makes a virtual force of 1: at the slow speed, at the fast
    /// one and above, quadratic between; slower adds nothing. 20..1000; 5..200. TouchFree
    /// AirPush has 42 mm at 150 mm/s, which hands that work on a table reach.
    double press_slow_mmps = 150.0;
    double press_slow_way_mm = 50.0;
    double press_fast_mmps = 500.0;
    double press_fast_way_mm = 8.0;
    /// Off the screen's normal; without drag a press is only a click, and need not be followed
    /// aside. 5..85. TouchFree, which has 15 without drag; arms that press swing farther aside.
    double press_cone_deg = 65.0;
    double press_cone_without_drag_deg = 20.0;
    double press_decay_mm = 50.0;  ///< so far aside, and the force is gone. 10..500. TouchFree.
    /// UP below it; again from below this. 0.5..0.99; 0..0.95. TouchFree's 0.97 and 0.87 chatter at
    /// the noise of a webcam.
    double press_up_force = 0.90;
    double press_rearm_force = 0.80;
    double press_most_ms = 1500.0;  ///< then it comes up by itself. 200..60000. TouchFree.

    // --- touch -----------------------------------------------------------------------------------
    double touch_plane_mm = 0.0;  ///< the plane, before the screen (z). -2000..2000
    /// Nearer than this to the plane touches; release; progress counts from here. 5..300; 10..400;
    /// 20..1000. TouchFree, with a hysteresis.
    double touch_mm = 50.0;
    double touch_release_mm = 60.0;
    double touch_progress_mm = 150.0;

    // --- dwell -----------------------------------------------------------------------------------
    /// Within such a radius for so long it begins, and fills for so long. 1..50; 100..3000;
    /// 100..2000. TouchFree.
    double dwell_radius_mm = 5.0;
    double dwell_still_ms = 500.0;
    double dwell_fill_ms = 600.0;
    /// Farther cancels; as far from a place that was dwelt on until the next. 2..100; 2..200.
    double dwell_cancel_mm = 12.0;
    double dwell_rearm_mm = 20.0;

    // --- drag ------------------------------------------------------------------------------------
    /// Way of a pinch or press, and of a grab, that makes a drag of it. 3..200. TouchFree.
    double drag_mm = 30.0;
    double drag_grab_mm = 10.0;

    // --- two hands -------------------------------------------------------------------------------
    /// Both pinch or grab, and the distance between them, or their direction, changes by so much.
    /// 5..200; 2..90.
    double two_hand_zoom_mm = 20.0;
    double two_hand_rotate_deg = 10.0;

    // --- wave ------------------------------------------------------------------------------------
    /// So many turns of the palm, left and right, within so long. 2..12; 300..5000. NiTE1.
    int wave_turns = 4;
    double wave_within_ms = 2000.0;
    /// Way from one turn to the next. 20..300. NiTE1.
    double wave_stroke_mm = 50.0;
    /// The palm may stray so far up or down, or to the screen. 10..200. NiTE1.
    double wave_off_axis_mm = 50.0;
    /// Slower for so long before the next. 10..200; 0..2000.
    double wave_rest_mmps = 65.0;
    double wave_rest_ms = 360.0;

    // --- raise -----------------------------------------------------------------------------------
    /// Upward, within so long. 50..600; 200..1000. NiTE2.
    double raise_mm = 150.0;
    double raise_within_ms = 1000.0;
    /// Then slower for so long. 10..200; 0..700. NiTE2.
    double raise_still_mmps = 65.0;
    double raise_still_ms = 200.0;

    // --- poses -----------------------------------------------------------------------------------
    /// Score from which on a pose fits, and under which it ends. 0.3..1; 0..0.9; 0.1 apart.
    double pose_begin = 0.8;
    double pose_end = 0.6;
    /// Fits for so long, with a palm slower than this. 0..3000; 20..1000. MediaPipe's users, SHREC.
    double pose_hold_ms = 500.0;
    double pose_palm_mmps = 100.0;
    /// Does not fit for so long. 0..1000.
    double pose_end_ms = 100.0;
};

/// What enabled gestures ask of the depth images they are seen in.
/// @since 0.1
struct GestureDemands {
    /// At which all of the hand must be seen: half the speed from which on a movement is a gesture,
    /// of the fastest one.
    double hand_mmps = 0.0;
    bool metric = false;  ///< lengths in mm decide: relative depth will not do
};

/// @thread any
/// @since 0.1
[[nodiscard]] GestureDemands demands_of(const GestureSettings& settings) noexcept;

/// Whether a type of event is switched on; hands always are.
/// @thread any
/// @since 0.1
[[nodiscard]] bool is_wanted(const GestureSettings& settings, GestureType type) noexcept;

/// Whether a gesture compares what is smaller than a hand, or is a distance that is asked for in
/// mm: relative depth, whose lengths are nominal, does not carry it.
/// @thread any
/// @since 0.1
[[nodiscard]] bool needs_millimetres(GestureType type) noexcept;

/// The same settings without those gestures.
/// @thread any
/// @since 0.1
[[nodiscard]] GestureSettings without_millimetres(const GestureSettings& settings);

/// One field of GestureSettings, for programs that list, set and sweep them by name. A switch takes
/// 0 and 1.
/// @since 0.1
struct GestureField {
    const char* name = "";  ///< as in the struct; its unit is its last word
    double least = 0.0;
    double most = 1.0;
    bool is_switch = false;
    bool whole = false;  ///< whole numbers only
    double (*get)(const GestureSettings&) = nullptr;
    void (*set)(GestureSettings&, double) = nullptr;

    [[nodiscard]] double standard() const { return get(GestureSettings{}); }
};

/// All fields, in the struct's order.
/// @thread any @ownership static
/// @since 0.1
[[nodiscard]] std::span<const GestureField> gesture_fields() noexcept;

/// Sets a field by its name; nothing changes on an Error. What it may be together with others,
/// validate() says.
/// @param text a number with a point; of a switch on, off, 1 or 0
/// @return invalid_argument that names the field and what it takes
/// @thread any
/// @since 0.1
[[nodiscard]] Result<void> set_field(GestureSettings& settings, std::string_view name,
                                     std::string_view text);

/// Checks every range and the relations between them.
/// @return invalid_argument that names the setting, its value and its range
/// @thread any
/// @since 0.1
[[nodiscard]] Result<void> validate(const GestureSettings& settings);

}  // namespace xtrack
