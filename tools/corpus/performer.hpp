// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <xtrack/gesture_settings.hpp>
#include <xtrack/labels.hpp>

#include "tools/corpus/definitions.hpp"
#include "tools/corpus/movement.hpp"

namespace xtrack::tools::corpus {

/// Where the plane is that `touch` touches, camera Z.
[[nodiscard]] double touch_plane_mm();
/// The person as far back as the gestures need that must have room: raise, touch, both hands.
[[nodiscard]] Person with_room_for(const std::vector<std::string>& names, Person person);

/// The names of labels that a set of gestures asks for: `swipe_left`, `push` ...
[[nodiscard]] std::vector<std::string> names_of(const GestureSettings& settings);
/// Made with both hands.
[[nodiscard]] bool takes_two_hands(const std::string& name);

/// Makes gestures with one hand, their ways there and back included, and labels them. What is drawn
/// for each is drawn anew: length, speed, pauses, the way back.
class Performer {
 public:
    /// @param labels in order of their starts as long as one hand performs
    /// @param names all that is asked for: what is one of it is not done between
    Performer(Movement& hand, std::vector<GestureLabel>& labels,
              const std::vector<std::string>& names);

    /// Comes from below, rests.
    void enter();
    void leave();
    /// Goes home slowly and waits a little.
    void rest();
    /// One of names_of() that takes one hand.
    void perform(const std::string& name);

    /// How many of the gestures of somebody who moves as usual fell short of their definition and
    /// were not labelled.
    [[nodiscard]] int short_of_definition() const noexcept { return short_; }
    void add_label(const std::string& name, double start, double end,
                   const definitions::Moment& commit);

    void take_pinch_pose();
    void drop_pinch_pose();
    [[nodiscard]] Movement& hand() noexcept { return m_; }

 private:
    struct Room {
        Vec3f low;
        Vec3f high;
    };
    [[nodiscard]] Room room(double z_mm) const;
    [[nodiscard]] Vec3f near_home(double spread_mm);
    /// Mean speed of a stroke of this person's, at least so fast.
    double stroke_mmps(double least_mmps);
    [[nodiscard]] double way(double mm) const;
    void go_slowly(const Vec3f& target);
    void go_back(double stroke_mmps);

    void swipe(const std::string& name, const Vec3f& along);
    void thrust(const std::string& name, float toward_camera);
    void pinch();
    void double_pinch();
    void close_and_open(double close_s, double hold_s, double open_s, const std::string& label);
    void grab();
    void tap(int times);
    void circle(bool clockwise);
    void wave();
    void raise();
    void dwell();
    void press();
    void touch();
    void drag();
    void pose(const std::string& name);

    Movement& m_;
    std::vector<GestureLabel>& labels_;
    int short_ = 0;
    bool stays_bent_ = false;    ///< an open hand that rests would be a pose
    bool stays_moving_ = false;  ///< one that is still would dwell
};

/// Both hands pinch or grab, and then pull apart, come together or turn.
/// @param name two_hand_zoom or two_hand_rotate
void perform_with_both(const std::string& name, Performer& right, Performer& left);

}  // namespace xtrack::tools::corpus
