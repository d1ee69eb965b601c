// SPDX-License-Identifier: Apache-2.0
//
// What fingers do: pinches, grabs, taps and poses.
#include <numbers>

#include "tools/corpus/performer.hpp"
#include "tools/corpus/shapes.hpp"

namespace xtrack::tools::corpus {

void Performer::take_pinch_pose() {
    m_.begin("opening a pinch");
    // Turned so that the camera looks past the thumb at the gap.
    const double shape_s = m_.draw(0.3, 0.6);
    m_.turn({0.0F, static_cast<float>(m_.draw(-0.45, -0.25)), 0.0F}, shape_s);
    m_.shape(sim::pinch_open(), shape_s);
    m_.wait(shape_s + m_.draw(0.15, 0.5));
}

void Performer::drop_pinch_pose() {
    m_.begin("between");
    m_.wait(m_.draw(0.15, 0.5));
    m_.turn(Vec3f::Zero(), 0.4);
    m_.shape(sim::relaxed_open(), 0.4);
    m_.wait(0.5);
}

void Performer::close_and_open(double close_s, double hold_s, double open_s,
                               const std::string& label) {
    const double start = m_.now();
    m_.shape(pinched(), close_s);
    m_.wait(close_s + hold_s);
    m_.shape(sim::pinch_open(), open_s);
    m_.wait(open_s);
    add_label(label, start, m_.now(), definitions::pinch(m_, start, m_.now()));
}

void Performer::pinch() {
    go_slowly(near_home(30.0));
    take_pinch_pose();
    m_.begin("pinch");
    close_and_open(m_.draw(0.15, 0.45), m_.draw(0.15, 1.2), m_.draw(0.15, 0.4), "pinch");
    drop_pinch_pose();
}

void Performer::double_pinch() {
    go_slowly(near_home(30.0));
    take_pinch_pose();
    m_.begin("double pinch");
    const double start = m_.now();
    m_.shape(pinched(), 0.14);
    m_.wait(0.14 + m_.draw(0.09, 0.11));
    m_.shape(sim::pinch_open(), 0.12);
    m_.wait(0.12);
    const double again = m_.now();
    m_.shape(pinched(), 0.14);
    m_.wait(0.14 + m_.draw(0.09, 0.3));
    m_.shape(sim::pinch_open(), 0.2);
    m_.wait(0.2);
    add_label("double_pinch", start, m_.now(), definitions::pinch(m_, again, m_.now()));
    drop_pinch_pose();
}

void Performer::grab() {
    go_slowly(near_home(30.0));
    m_.begin("opening a hand");
    m_.shape(sim::relaxed_open(), 0.3);
    m_.wait(m_.draw(0.4, 0.8));
    m_.begin("grab");
    const double start = m_.now();
    const double close_s = m_.draw(0.18, 0.5);
    m_.shape(fist(), close_s);
    m_.wait(close_s + m_.draw(0.3, 1.4));
    const double open_s = m_.draw(0.2, 0.5);
    m_.shape(sim::relaxed_open(), open_s);
    m_.wait(open_s);
    add_label("grab", start, m_.now(), definitions::grab(m_, start, m_.now()));
    m_.wait(m_.draw(0.2, 0.6));
}

void Performer::tap(int times) {
    go_slowly(near_home(30.0));
    m_.begin("a finger out");
    const sim::FingerAngles up = m_.random().unit() < 0.6 ? pointing() : sim::relaxed_open();
    m_.shape(up, 0.35);
    m_.wait(m_.draw(0.6, 1.0));
    m_.begin(times == 1 ? "tap" : "double tap");
    const double start = m_.now();
    double last = start;
    for (int i = 0; i < times; ++i) {
        last = m_.now();
        const double down_s = m_.draw(0.08, 0.14);
        const double up_s = m_.draw(0.09, 0.16);
        m_.shape(with_index_bent(up, static_cast<float>(m_.draw(0.75, 1.05))), down_s);
        m_.wait(down_s + m_.draw(0.0, 0.04));
        m_.shape(up, up_s);
        m_.wait(up_s + (i + 1 < times ? m_.draw(0.0, 0.1) : 0.0));
    }
    add_label(times == 1 ? "tap" : "double_tap", start, m_.now(),
              definitions::tap(m_, last, m_.now()));
    m_.wait(m_.draw(0.3, 0.7));
}

void Performer::pose(const std::string& name) {
    constexpr float kQuarter = 0.5F * std::numbers::pi_v<float>;
    sim::FingerAngles shape = flat();
    Vec3f turned = Vec3f::Zero();
    if (name == "fist") {
        shape = fist();
    } else if (name == "point") {
        shape = pointing();
    } else if (name == "victory") {
        shape = victory();
    } else if (name == "thumb_up") {
        // The back of the hand to the screen, its fingers inward: as arms can.
        shape = thumb_out();
        turned = {0.0F, 1.9F * kQuarter, -kQuarter};
    } else if (name == "thumb_down") {
        shape = thumb_out();
        turned = {0.0F, 0.0F, kQuarter};
    }
    go_slowly(near_home(30.0));
    const sim::FingerAngles from = loose(0.8F);
    m_.shape(from, 0.3);
    m_.wait(m_.draw(0.6, 1.0));
    m_.begin("pose");
    const double start = m_.now();
    const double shape_s = m_.draw(0.25, 0.5);
    m_.turn(turned, shape_s);
    m_.shape(shape, shape_s);
    m_.wait(shape_s + m_.draw(0.8, 1.5));
    add_label(name, start, m_.now(), definitions::pose(m_, shape, from, start, m_.now()));
    m_.begin("between");
    m_.turn(Vec3f::Zero(), shape_s);
    m_.shape(from, shape_s);
    m_.wait(shape_s + m_.draw(0.3, 0.6));
}

}  // namespace xtrack::tools::corpus
