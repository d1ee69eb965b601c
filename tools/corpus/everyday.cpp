// SPDX-License-Identifier: Apache-2.0
#include "tools/corpus/everyday.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "tools/corpus/shapes.hpp"

namespace xtrack::tools::corpus {

namespace {

// Places of a body, from the middle between its shoulders, for the right hand; adult's mm.
float out(const Movement& m) { return Person::outward(m.hand()); }

/// @param outward_mm to the hand's own side; @param down_mm from the shoulders; @param before_mm
/// before the chest
Vec3f at_body(const Movement& m, double outward_mm, double down_mm, double before_mm) {
    const Person& p = m.person();
    const double scale = p.scale();
    return {static_cast<float>(p.to_side_mm + out(m) * outward_mm * scale),
            static_cast<float>(-35.0 - p.tall_mm + down_mm * scale),
            static_cast<float>(p.chest_mm - before_mm * scale)};
}

Vec3f jitter(Movement& m, double mm) {
    const auto one = [&] { return static_cast<float>(m.draw(-mm, mm)); };
    const float x = one();
    const float y = one();
    return {x, y, one()};
}

/// As hands are carried: round a bend, the middle of the way lifted.
void carry(Movement& m, const Vec3f& to, double mean_mmps, double bow_mm) {
    const Vec3f from = m.place();
    const double seconds = std::max(0.25, (to - from).norm() / mean_mmps);
    const Vec3f bow(out(m) * static_cast<float>(m.draw(0.0, 0.4) * bow_mm),
                    -static_cast<float>(bow_mm), static_cast<float>(m.draw(-0.3, 0.3) * bow_mm));
    constexpr int kPieces = 24;
    for (int i = 1; i <= kPieces; ++i) {
        const double u = static_cast<double>(i) / kPieces;
        const auto s = static_cast<float>(u * u * u * (10.0 + u * (-15.0 + 6.0 * u)));
        m.go_evenly(from + (to - from) * s + bow * std::sin(std::numbers::pi_v<float> * s),
                    seconds / kPieces);
    }
}

double hurry(Movement& m) { return m.draw(250.0, 700.0); }

/// Where hands are between times: in the lap, on the table, or still held up.
void settle(Movement& m, double bow_mm) {
    m.turn(Vec3f::Zero(), 0.5);
    m.shape(loose(static_cast<float>(m.draw(0.2, 1.0))), 0.4);
    const double kind = m.random().unit();
    if (kind < 0.4) {
        carry(m, m.away(), hurry(m), bow_mm);
    } else if (kind < 0.75) {
        m.turn({0.8F, 0.0F, 0.0F}, 0.5);
        carry(m, at_body(m, m.draw(40.0, 200.0), 250.0, m.draw(160.0, 260.0)), hurry(m), bow_mm);
    } else {
        carry(m, m.home() + jitter(m, 30.0), hurry(m), bow_mm);
    }
    m.wait(m.draw(0.5, 6.0));
}

void idle(Movement& m) {
    m.begin("idle, hand up");
    carry(m, m.home() + jitter(m, 30.0), hurry(m), 20.0);
    const double end = m.now() + m.draw(8.0, 40.0);
    while (m.now() < end) {
        if (m.random().unit() < 0.4) {
            m.shape(loose(static_cast<float>(m.draw(0.0, 1.0))), m.draw(0.4, 1.5));
        }
        m.turn(jitter(m, 0.25), m.draw(0.5, 1.5));
        m.go_at(m.home() + jitter(m, 40.0), m.draw(30.0, 110.0));
        m.wait(m.draw(1.0, 6.0));
    }
}

void put_down(Movement& m) {
    m.begin("hand down");
    carry(m, m.away(), hurry(m), 0.0);
    m.wait(m.draw(3.0, 20.0));
    m.begin("hand up again");
    m.shape(loose(static_cast<float>(m.draw(0.0, 0.8))), 0.4);
    carry(m, m.home() + jitter(m, 30.0), hurry(m), 10.0);
    m.wait(m.draw(0.5, 4.0));
}

void scratch(Movement& m) {
    m.begin("scratching");
    const bool head = m.random().unit() < 0.4;
    const Vec3f place = head ? at_body(m, 70.0, -250.0, 60.0) : at_body(m, 45.0, -160.0, 130.0);
    m.shape(loose(0.8F), 0.5);
    m.turn({static_cast<float>(m.draw(-0.3, 0.2)), 0.0F, static_cast<float>(m.draw(-0.6, 0.0))},
           0.6);
    carry(m, place, hurry(m), 0.0);
    const int strokes = 4 + static_cast<int>(m.random().bits() % 8);
    for (int i = 0; i < strokes; ++i) {
        m.go(place + Vec3f(0.0F, i % 2 == 0 ? 20.0F : -10.0F, 0.0F), m.draw(0.11, 0.2));
    }
    m.begin("back from scratching");
    settle(m, 0.0);
}

void adjust_glasses(Movement& m) {
    m.begin("adjusting glasses");
    m.shape(gripping(), 0.5);
    const Vec3f place = at_body(m, 60.0, -190.0, 135.0);
    carry(m, place, hurry(m), 0.0);
    m.go(place + Vec3f(0.0F, -12.0F, 0.0F), 0.3);
    m.wait(m.draw(0.2, 0.8));
    m.begin("back from glasses");
    settle(m, 0.0);
}

/// Fingers forward, down to a table, and up again with what was there.
void drink(Movement& m) {
    m.begin("reaching for a cup");
    const Vec3f cup = at_body(m, m.draw(80.0, 200.0), 260.0, m.draw(180.0, 300.0));
    m.turn({0.7F, 0.0F, 0.0F}, 0.5);
    m.shape(loose(0.3F), 0.4);
    carry(m, cup, hurry(m), 40.0);
    m.shape(gripping(), 0.3);
    m.wait(m.draw(0.3, 0.7));
    m.begin("drinking");
    m.turn({0.2F, -0.8F, 0.0F}, 0.8);
    const Vec3f mouth = at_body(m, 30.0, -110.0, 150.0);
    carry(m, mouth, m.draw(200.0, 450.0), 10.0);
    m.wait(m.draw(1.0, 3.0));
    carry(m, cup + jitter(m, 20.0), m.draw(200.0, 450.0), 10.0);
    m.wait(0.3);
    m.shape(loose(0.3F), 0.3);
    m.wait(0.3);
    m.begin("back from a cup");
    settle(m, 20.0);
}

void telephone(Movement& m) {
    m.begin("taking a telephone");
    const Vec3f table = at_body(m, m.draw(60.0, 180.0), 260.0, m.draw(150.0, 260.0));
    m.turn({0.7F, 0.0F, 0.0F}, 0.5);
    carry(m, table, hurry(m), 30.0);
    m.shape(gripping(), 0.3);
    m.wait(0.4);
    m.turn({0.0F, -1.2F, 0.0F}, 0.6);
    carry(m, at_body(m, 95.0, -180.0, 60.0), hurry(m), 0.0);
    m.begin("telephoning");
    m.wait(m.draw(5.0, 20.0));
    m.begin("putting a telephone back");
    m.turn({0.7F, 0.0F, 0.0F}, 0.6);
    carry(m, table, hurry(m), 20.0);
    m.shape(loose(0.3F), 0.3);
    m.wait(0.4);
    settle(m, 20.0);
}

void type(Movement& m) {
    m.begin("reaching for a keyboard");
    const Vec3f keys = at_body(m, 60.0, 250.0, 220.0);
    m.turn({1.0F, 0.0F, 0.0F}, 0.5);
    m.shape(loose(0.6F), 0.4);
    carry(m, keys, hurry(m), 10.0);
    m.begin("typing");
    const double end = m.now() + m.draw(6.0, 25.0);
    while (m.now() < end) {
        // One finger after the other, and now and then the hand moves on.
        sim::FingerAngles fingers = loose(0.6F);
        const std::size_t finger = 1 + m.random().bits() % 4;
        const double down_s = m.draw(0.06, 0.1);
        fingers[finger * sim::kAnglesPerFinger] += static_cast<float>(m.draw(0.15, 0.35));
        m.shape(fingers, down_s);
        m.wait(down_s);
        m.shape(loose(0.6F), down_s);
        m.wait(down_s);
        if (m.random().unit() < 0.15) {
            m.go(keys + jitter(m, 35.0), m.draw(0.15, 0.3));
        }
        m.wait(m.draw(0.0, 0.25));
    }
    m.begin("back from a keyboard");
    settle(m, 10.0);
}

void use_mouse(Movement& m) {
    m.begin("using a mouse");
    const Vec3f mouse = at_body(m, 170.0, 250.0, 230.0);
    m.turn({1.1F, 0.0F, 0.0F}, 0.5);
    m.shape(gripping(), 0.4);
    carry(m, mouse, hurry(m), 10.0);
    const double end = m.now() + m.draw(5.0, 20.0);
    while (m.now() < end) {
        Vec3f off = jitter(m, 50.0);
        off.y() *= 0.2F;
        m.go_at(mouse + off, m.draw(60.0, 300.0));
        m.wait(m.draw(0.1, 1.2));
    }
    m.begin("back from a mouse");
    settle(m, 10.0);
}

/// For something that lies or stands somewhere, and back with it.
void reach(Movement& m) {
    m.begin("reaching");
    const Vec3f thing = at_body(m, m.draw(-60.0, 330.0), m.draw(60.0, 280.0), m.draw(150.0, 380.0));
    m.turn({static_cast<float>(m.draw(0.3, 0.9)), 0.0F, static_cast<float>(m.draw(-0.3, 0.3))},
           0.5);
    m.shape(loose(0.4F), 0.4);
    carry(m, thing, hurry(m), m.draw(0.0, 40.0));
    m.shape(gripping(), 0.3);
    m.wait(m.draw(0.3, 2.0));
    m.begin("back from reaching");
    settle(m, m.draw(0.0, 40.0));
}

void fold_arms(Movement& m) {
    m.begin("folding arms");
    m.shape(loose(0.8F), 0.4);
    m.turn({0.0F, -0.9F, 1.2F}, 0.8);
    carry(m, at_body(m, -90.0, 150.0, 90.0), hurry(m), 0.0);
    m.wait(m.draw(4.0, 20.0));
    m.begin("unfolding arms");
    settle(m, 0.0);
}

void turn_pages(Movement& m) {
    m.begin("turning pages");
    m.turn({0.6F, 0.0F, 0.0F}, 0.5);
    m.shape(gripping(), 0.4);
    const int pages = 1 + static_cast<int>(m.random().bits() % 4);
    for (int i = 0; i < pages; ++i) {
        carry(m, at_body(m, 120.0, 220.0, 210.0) + jitter(m, 10.0), m.draw(90.0, 150.0), 10.0);
        m.wait(m.draw(0.3, 0.6));
        carry(m, at_body(m, -40.0, 220.0, 210.0) + jitter(m, 10.0), m.draw(90.0, 150.0), 70.0);
        m.wait(m.draw(2.0, 8.0));
    }
    settle(m, 20.0);
}

void talk_a_while(Movement& m) { talk(m, m.draw(8.0, 40.0)); }

struct Pastime {
    void (*act)(Movement&);
    double weight;  ///< how often it is begun, against the others
};
constexpr std::array<Pastime, 12> kPastimes{{{idle, 3.0},
                                             {put_down, 3.0},
                                             {scratch, 2.0},
                                             {adjust_glasses, 1.0},
                                             {drink, 1.5},
                                             {telephone, 0.5},
                                             {type, 1.5},
                                             {use_mouse, 1.5},
                                             {reach, 3.0},
                                             {fold_arms, 1.0},
                                             {turn_pages, 0.7},
                                             {talk_a_while, 4.0}}};

}  // namespace

void talk(Movement& m, double seconds) {
    m.begin("talking");
    const Vec3f rest = 0.5F * (m.home() + at_body(m, 80.0, 180.0, 200.0));
    carry(m, rest, hurry(m), 10.0);
    const double end = m.now() + seconds;
    while (m.now() < end) {
        // Beats: a stroke on the word and back, mostly down and outward, short; now and then a
        // wide one, askew, as arms swing about their elbows.
        m.begin("talking, beats");
        const bool wide = m.random().unit() < 0.12;
        const double length = wide ? m.draw(100.0, 170.0) : m.draw(25.0, 85.0);
        const double angle = wide ? m.draw(0.70, 0.95) : m.draw(0.0, 1.6);
        // To and fro as far as this, and again, would be a wave.
        constexpr double kWaveMm = 45.0;
        const int most = length * std::cos(angle) > kWaveMm ? 1 : 5;
        const int beats = 1 + static_cast<int>(m.random().bits() % 5) % most;
        const Vec3f way =
            static_cast<float>(length) * Vec3f(out(m) * static_cast<float>(std::cos(angle)),
                                               static_cast<float>(std::sin(angle)),
                                               static_cast<float>(m.draw(-0.5, 0.3)))
                                             .normalized();
        m.shape(loose(static_cast<float>(m.draw(0.0, 1.0))), m.draw(0.2, 0.5));
        m.turn(jitter(m, 0.4), m.draw(0.3, 0.7));
        const Vec3f from = rest + jitter(m, 25.0);
        m.go_at(from, m.draw(80.0, 250.0));
        for (int i = 0; i < beats; ++i) {
            m.go(from + way, std::max(0.14, length / m.draw(250.0, 700.0)));
            m.wait(m.draw(0.0, 0.12));
            m.go(from + jitter(m, 8.0), std::max(0.18, length / m.draw(150.0, 500.0)));
            m.wait(m.draw(0.0, 0.3));
        }
        m.begin("talking");
        m.wait(m.draw(0.2, 2.5));
    }
}

void walk_past(Movement& m, double distance_mm) {
    m.begin("walking past");
    const float side = m.random().unit() < 0.5 ? -1.0F : 1.0F;
    const float edge = 0.75F * static_cast<float>(distance_mm);
    const auto y = static_cast<float>(m.draw(0.10, 0.36) * distance_mm);
    const double speed = m.draw(900.0, 1400.0);
    const auto at = [&](double u, double swing) {
        return Vec3f(side * edge * static_cast<float>(2.0 * u - 1.0) +
                         side * static_cast<float>(130.0 * std::sin(swing)),
                     y - static_cast<float>(25.0 * std::abs(std::sin(swing))),
                     static_cast<float>(distance_mm + 25.0 * std::sin(swing)));
    };
    m.shape(loose(0.9F), 0.1);
    const double seconds = 2.0 * edge / speed;
    const double phase = m.draw(0.0, 6.28);
    constexpr double kStepsHz = 0.95;
    constexpr int kPieces = 80;
    m.go_evenly(at(0.0, phase), 0.0);
    for (int i = 1; i <= kPieces; ++i) {
        const double u = static_cast<double>(i) / kPieces;
        m.go_evenly(at(u, phase + 2.0 * std::numbers::pi * kStepsHz * seconds * u),
                    seconds / kPieces);
    }
    m.go_evenly(m.away(), 0.0);
}

void live(Movement& m, double end_s) {
    double sum = 0.0;
    for (const Pastime& p : kPastimes) {
        sum += p.weight;
    }
    while (m.now() < end_s) {
        double left = m.draw(0.0, sum);
        const Pastime* chosen = kPastimes.data();
        while (left > chosen->weight && chosen + 1 < kPastimes.data() + kPastimes.size()) {
            left -= chosen->weight;
            ++chosen;
        }
        chosen->act(m);
    }
}

}  // namespace xtrack::tools::corpus
