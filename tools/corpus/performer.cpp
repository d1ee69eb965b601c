// SPDX-License-Identifier: Apache-2.0
#include "tools/corpus/performer.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/corpus/shapes.hpp"

namespace xtrack::tools::corpus {

namespace {

using definitions::Moment;

// The user's left is to the image's right.
const Vec3f kLeft{1.0F, 0.0F, 0.0F};
const Vec3f kUp{0.0F, -1.0F, 0.0F};

// Slow enough to be no stroke, whatever its length: least-jerk moves peak at 1.875 of their mean.
constexpr double kSlowLeastMmps = 80.0;
constexpr double kSlowMostMmps = 150.0;
constexpr double kFastestMmps = 1500.0;

Stamp stamp_of(double t_s) { return Stamp{std::llround(t_s * 1e9)}; }

}  // namespace

Performer::Performer(Movement& hand, std::vector<GestureLabel>& labels,
                     const std::vector<std::string>& names)
    : m_(hand),
      labels_(labels),
      stays_bent_(std::find(names.begin(), names.end(), "open_palm") != names.end()),
      stays_moving_(std::find(names.begin(), names.end(), "dwell") != names.end()) {}

void Performer::add_label(const std::string& name, double start, double end, const Moment& commit) {
    // What somebody meant who cannot fulfil the definition is asked for all the same.
    if (!commit && m_.person().manner == Manner::usual) {
        ++short_;
        return;
    }
    GestureLabel label;
    label.gesture = name;
    label.hand = m_.hand() == SimHand::left ? Chirality::left : Chirality::right;
    label.start = stamp_of(start);
    label.end = stamp_of(end);
    if (commit) {
        label.commit = stamp_of(*commit);
    }
    labels_.push_back(std::move(label));
}

/// Where the palm may be so that an open hand stays in the image.
Performer::Room Performer::room(double z_mm) const {
    const Pinhole& camera = corpus_camera();
    const float z = static_cast<float>(z_mm);
    const float scale = m_.person().scale();
    const auto half = [z](int size, double focal) {
        return 0.48F * static_cast<float>(size) / static_cast<float>(focal) * z;
    };
    const float x = half(camera.size.width, camera.matrix(0, 0)) - 75.0F * scale;
    const float y = half(camera.size.height, camera.matrix(1, 1));
    return {{-x, -y + 118.0F * scale, 0.0F}, {x, y - 12.0F, 0.0F}};
}

Vec3f Performer::near_home(double spread_mm) {
    const auto one = [&] { return static_cast<float>(m_.draw(-spread_mm, spread_mm)); };
    const Vec3f off(one(), one(), one());
    return m_.home() + off;
}

double Performer::stroke_mmps(double least_mmps) {
    const double own = m_.person().speed_mmps * m_.draw(0.85, 1.15);
    return m_.person().manner == Manner::slow_and_short ? own
                                                        : std::clamp(own, least_mmps, kFastestMmps);
}

double Performer::way(double mm) const {
    return m_.person().manner == Manner::slow_and_short ? 0.5 * mm : mm;
}

void Performer::go_slowly(const Vec3f& target) {
    m_.go_at(target, m_.draw(kSlowLeastMmps, kSlowMostMmps));
}

void Performer::enter() {
    m_.begin("coming");
    m_.wait(0.6);  // an empty room first: something to learn the background from
    m_.shape(loose(static_cast<float>(stays_bent_ ? m_.draw(0.8, 1.0) : m_.draw(0.0, 0.5))), 0.5);
    m_.go(m_.home(), m_.draw(0.7, 1.7));
    m_.wait(stays_moving_ ? 0.0 : m_.draw(0.4, 1.0));
}

void Performer::leave() {
    m_.begin("leaving");
    m_.go(m_.away(), m_.draw(0.6, 1.6));
    m_.wait(0.6);
}

void Performer::rest() {
    m_.begin("between");
    m_.turn(Vec3f::Zero(), 0.4);
    m_.shape(loose(static_cast<float>(stays_bent_ ? m_.draw(0.8, 1.0) : m_.draw(0.0, 0.4))), 0.4);
    go_slowly(near_home(15.0));
    m_.wait(stays_moving_ ? 0.0 : m_.draw(0.3, 1.2));
}

/// Back to where the stroke began: slowly, at once, or round a bend.
void Performer::go_back(double stroke) {
    const double kind = m_.random().unit();
    if (kind < 0.4) {
        m_.wait(m_.draw(0.25, 0.8));
        m_.begin("way back, slow");
        go_slowly(near_home(15.0));
    } else if (kind < 0.7) {
        m_.wait(m_.draw(0.0, 0.1));
        m_.begin("way back, at once");
        m_.go_at(near_home(15.0), stroke * m_.draw(0.5, 0.9));
    } else {
        m_.wait(m_.draw(0.1, 0.4));
        m_.begin("way back, round");
        const Vec3f home = near_home(15.0);
        const Vec3f from = m_.place();
        const Vec3f down(0.0F, static_cast<float>(m_.draw(30.0, 60.0)),
                         static_cast<float>(m_.draw(20.0, 60.0)));
        const double seconds = (home - from).norm() / m_.draw(150.0, 350.0);
        constexpr int kPieces = 16;
        for (int i = 1; i <= kPieces; ++i) {
            const float u = static_cast<float>(i) / kPieces;
            const float s = u * u * (3.0F - 2.0F * u);
            const float bow = std::sin(std::numbers::pi_v<float> * s);
            m_.go_evenly(from + (home - from) * s + down * bow, seconds / kPieces);
        }
    }
    m_.wait(m_.draw(0.3, 0.8));
}

void Performer::perform(const std::string& name) {
    if (name == "swipe_left") {
        swipe(name, kLeft);
    } else if (name == "swipe_right") {
        swipe(name, -kLeft);
    } else if (name == "swipe_up") {
        swipe(name, kUp);
    } else if (name == "swipe_down") {
        swipe(name, -kUp);
    } else if (name == "push") {
        thrust(name, 1.0F);
    } else if (name == "pull") {
        thrust(name, -1.0F);
    } else if (name == "pinch") {
        pinch();
    } else if (name == "double_pinch") {
        double_pinch();
    } else if (name == "grab") {
        grab();
    } else if (name == "tap") {
        tap(1);
    } else if (name == "double_tap") {
        tap(2);
    } else if (name == "circle_clockwise" || name == "circle_counterclockwise") {
        circle(name == "circle_clockwise");
    } else if (name == "wave") {
        wave();
    } else if (name == "raise") {
        raise();
    } else if (name == "dwell") {
        dwell();
    } else if (name == "press") {
        press();
    } else if (name == "touch") {
        touch();
    } else if (name == "drag") {
        drag();
    } else {
        pose(name);
    }
    rest();
}

void Performer::swipe(const std::string& name, const Vec3f& along) {
    const bool level = along.y() == 0.0F;
    const double tilt = m_.draw(-0.14, 0.14);  // up to 8 degrees
    const Vec3f across(-along.y(), along.x(), 0.0F);
    const Vec3f direction =
        along * static_cast<float>(std::cos(tilt)) + across * static_cast<float>(std::sin(tilt));
    const Room inside = room(m_.home().z());
    const double space =
        level ? inside.high.x() - inside.low.x() : inside.high.y() - inside.low.y();
    const double length = way(
        std::min(level ? m_.draw(180.0, 320.0) : m_.draw(140.0, 260.0), std::max(space, 130.0)));
    const Vec3f half = direction * static_cast<float>(length / 2.0);
    Vec3f middle = near_home(12.0);
    for (int axis = 0; axis < 2; ++axis) {
        const float reach = std::abs(half[axis]);
        const float low = inside.low[axis] + reach;
        const float high = inside.high[axis] - reach;
        middle[axis] = low < high ? std::clamp(middle[axis], low, high) : 0.5F * (low + high);
    }
    m_.begin("wind-up");
    const double mmps = stroke_mmps(360.0);
    if (m_.random().unit() < 0.4) {
        // A short one, as fast as the stroke.
        const Vec3f back = middle - half;
        go_slowly(back + direction * static_cast<float>(m_.draw(40.0, 85.0)));
        m_.wait(m_.draw(0.1, 0.4));
        m_.go_at(back, std::min(mmps, 600.0));
        m_.wait(m_.draw(0.0, 0.1));
    } else {
        go_slowly(middle - half);
        m_.wait(m_.draw(0.15, 0.5));
    }
    m_.begin("swipe");
    const double start = m_.now();
    const double lean = (level ? 0.10 : 0.12) * (along.x() - along.y()) *
                        (level && m_.hand() == SimHand::left ? -1.0 : 1.0);
    const auto turned = static_cast<float>(-lean);
    m_.turn(level ? Vec3f(0.0F, turned, 0.0F) : Vec3f(turned, 0.0F, 0.0F), length / mmps);
    m_.go_at(middle + half, mmps);
    add_label(name, start, m_.now(), definitions::stroke(m_, along, start, m_.now()));
    go_back(mmps);
}

void Performer::thrust(const std::string& name, float toward_camera) {
    m_.begin("wind-up");
    const double length = way(m_.draw(120.0, 200.0));
    Vec3f direction(static_cast<float>(m_.draw(-0.2, 0.2)), static_cast<float>(m_.draw(-0.2, 0.2)),
                    -toward_camera);
    direction.normalize();
    constexpr float kNearestMm = 260.0F;
    Vec3f from = near_home(12.0) - direction * static_cast<float>(m_.draw(0.0, 0.5) * length);
    from.z() =
        std::max(from.z(), kNearestMm + (toward_camera > 0.0F ? static_cast<float>(length) : 0.0F));
    go_slowly(from);
    m_.wait(m_.draw(0.4, 0.7));
    m_.begin(toward_camera > 0.0F ? "push" : "pull");
    const double start = m_.now();
    const double mmps = stroke_mmps(320.0);
    m_.go_at(from + direction * static_cast<float>(length), mmps);
    // The window of the definition is longer than the fastest strokes.
    constexpr double kWindowS = 0.24;
    const double end = std::max(m_.now(), start + kWindowS);
    add_label(name, start, end,
              definitions::thrust(m_, Vec3f(0.0F, 0.0F, -toward_camera), start, m_.now()));
    m_.wait(m_.draw(0.3, 0.8));
    go_back(mmps);
}

void Performer::circle(bool clockwise) {
    const Room inside = room(m_.home().z());
    const double most =
        std::min(inside.high.x() - inside.low.x(), inside.high.y() - inside.low.y());
    const double radius = way(std::min(m_.draw(55.0, 120.0), std::max(0.5 * most, 50.0)));
    Vec3f centre = near_home(10.0);
    for (int axis = 0; axis < 2; ++axis) {
        const float r = static_cast<float>(radius);
        const float low = inside.low[axis] + r;
        const float high = inside.high[axis] - r;
        centre[axis] = low < high ? std::clamp(centre[axis], low, high) : 0.5F * (low + high);
    }
    // As the user sees it: x and y are both the other way round in the image, so the sense of a
    // turn from x to y is the same, and in the user's axes (y up) that is counterclockwise.
    const double sense = clockwise ? -1.0 : 1.0;
    double angle = m_.draw(-std::numbers::pi, std::numbers::pi);
    const auto at = [&](double a) {
        return Vec3f(centre + static_cast<float>(radius) * Vec3f(static_cast<float>(std::cos(a)),
                                                                 static_cast<float>(std::sin(a)),
                                                                 0.0F));
    };
    m_.begin("wind-up");
    if (m_.random().unit() < 0.5) {
        m_.shape(pointing(), 0.4);
    }
    go_slowly(at(angle));
    m_.wait(m_.draw(0.4, 0.7));
    m_.begin("circle");
    const double start = m_.now();
    const double mmps = std::clamp(stroke_mmps(250.0), 100.0, 900.0);
    const double turns = m_.draw(1.1, 1.35);
    constexpr int kPieces = 60;
    const double piece = turns * 2.0 * std::numbers::pi / kPieces;
    for (int i = 0; i < kPieces; ++i) {
        // Sets off and stops within a tenth of the way.
        const double from_end = std::min(i + 0.5, kPieces - i - 0.5) / (0.1 * kPieces);
        const double share = std::clamp(from_end, 0.25, 1.0);
        angle += sense * piece;
        m_.go_evenly(at(angle), piece * radius / (mmps * share));
    }
    add_label(clockwise ? "circle_clockwise" : "circle_counterclockwise", start, m_.now(),
              definitions::circle(m_, centre, start, m_.now()));
    m_.wait(m_.draw(0.4, 0.8));
}

void Performer::wave() {
    const Room inside = room(m_.home().z());
    const double most = 0.9 * (inside.high.x() - inside.low.x());
    const float half = static_cast<float>(way(std::min(m_.draw(75.0, 150.0), most)) / 2.0);
    const Vec3f middle = near_home(10.0);
    m_.begin("wind-up");
    m_.shape(flat(), 0.4);
    go_slowly(middle - kLeft * half);
    m_.wait(m_.draw(0.2, 0.5));
    m_.begin("wave");
    constexpr int kStrokes = 6;
    constexpr int kTurns = 4;
    const double start = m_.now();
    const double stroke_s = std::clamp(2.0 * half / stroke_mmps(200.0), 0.18, 0.36);
    Moment commit;
    for (int i = 0; i < kStrokes; ++i) {
        m_.go(middle + kLeft * (i % 2 == 0 ? half : -half), stroke_s);
        if (i + 1 == kTurns && 2.0F * half >= 50.0F) {
            commit = m_.now();
        }
    }
    add_label("wave", start, m_.now(), commit);
    m_.wait(m_.draw(0.4, 0.8));
}

void Performer::raise() {
    m_.begin("wind-up");
    Vec3f low = m_.home();
    const Room inside = room(low.z());
    low.y() = inside.high.y();
    const double length =
        way(std::min(m_.draw(165.0, 260.0), static_cast<double>(inside.high.y() - inside.low.y())));
    go_slowly(low);
    m_.wait(m_.draw(0.5, 0.9));
    m_.begin("raise");
    const double start = m_.now();
    m_.go_at(low + kUp * static_cast<float>(length), std::min(stroke_mmps(200.0), 900.0));
    m_.wait(m_.draw(0.5, 0.9));
    add_label("raise", start, m_.now(), definitions::raise(m_, start, m_.now()));
    m_.begin("way back, slow");
    go_slowly(near_home(15.0));
}

void Performer::dwell() {
    m_.begin("on the way");
    // To the other side of home, well away from where it dwelt last.
    const float side = m_.place().x() > m_.home().x() ? -1.0F : 1.0F;
    const Vec3f target = near_home(15.0) + Vec3f(side * static_cast<float>(m_.draw(40.0, 70.0)),
                                                 static_cast<float>(m_.draw(-30.0, 30.0)), 0.0F);
    const double start = m_.now();
    m_.go_at(target, m_.draw(120.0, 260.0));
    m_.begin("dwell");
    m_.wait(m_.draw(1.4, 2.0));
    add_label("dwell", start, m_.now(), definitions::dwell(m_, start, m_.now()));
}

void Performer::press() {
    m_.begin("wind-up");
    const Vec3f from = near_home(15.0);
    go_slowly(from);
    m_.wait(m_.draw(0.4, 0.7));
    m_.begin("press");
    Vec3f direction(static_cast<float>(m_.draw(-0.3, 0.3)), static_cast<float>(m_.draw(-0.3, 0.3)),
                    -1.0F);
    direction.normalize();
    const double start = m_.now();
    m_.go_at(from + direction * static_cast<float>(way(m_.draw(60.0, 100.0))),
             std::min(stroke_mmps(200.0), 600.0));
    m_.wait(m_.draw(0.05, 0.5));
    m_.go_at(from, m_.draw(150.0, 400.0));
    add_label("press", start, m_.now(), definitions::press(m_, start, m_.now()));
    m_.wait(m_.draw(0.3, 0.6));
}

void Performer::touch() {
    m_.begin("wind-up");
    const double plane = touch_plane_mm();
    const auto before = static_cast<float>(m_.draw(160.0, 220.0));
    Vec3f from = near_home(15.0);
    from.z() = static_cast<float>(plane) + before;
    go_slowly(from);
    m_.wait(m_.draw(0.4, 0.7));
    m_.begin("touch");
    Vec3f at = from;
    at.z() = static_cast<float>(plane + m_.draw(5.0, 30.0));
    const double start = m_.now();
    m_.go_at(at, std::min(stroke_mmps(200.0), 600.0));
    m_.wait(m_.draw(0.1, 0.6));
    m_.go_at(from, m_.draw(150.0, 300.0));
    add_label("touch", start, m_.now(), definitions::touch(m_, plane, start, m_.now()));
    m_.wait(m_.draw(0.3, 0.6));
}

void Performer::drag() {
    go_slowly(near_home(30.0));
    take_pinch_pose();
    m_.begin("drag");
    const double start = m_.now();
    const double close_s = m_.draw(0.15, 0.45);
    m_.shape(pinched(), close_s);
    m_.wait(close_s + m_.draw(0.2, 0.4));
    const Moment held = definitions::pinch(m_, start, m_.now());
    const double angle = m_.draw(-std::numbers::pi, std::numbers::pi);
    const Vec3f to = m_.place() + static_cast<float>(way(m_.draw(60.0, 120.0))) *
                                      Vec3f(static_cast<float>(std::cos(angle)),
                                            static_cast<float>(std::sin(angle)), 0.0F);
    m_.go_at(to, m_.draw(120.0, 350.0));
    m_.wait(m_.draw(0.1, 0.4));
    m_.shape(sim::pinch_open(), 0.3);
    m_.wait(0.3);
    add_label("drag", start, m_.now(),
              held ? definitions::drag(m_, false, *held, m_.now()) : Moment{});
    drop_pinch_pose();
}

}  // namespace xtrack::tools::corpus
