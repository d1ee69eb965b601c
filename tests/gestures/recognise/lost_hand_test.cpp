// SPDX-License-Identifier: Apache-2.0
//
// A hand may be lost at any moment, with frames going on or with none: whatever was active is
// cancelled within 150 ms of the hand's last good frame. Nothing can stick.
#include <map>
#include <random>

#include <gmock/gmock.h>

#include "tests/gestures/recognise/play_hand.hpp"

namespace xtrack::test {
namespace {

Vec3f at(float x, float y = 0.0F, float z = 400.0F) { return {x, y, z}; }

/// Everything that has a life.
GestureSettings all() {
    GestureSettings s;
    for (const GestureField& field : gesture_fields()) {
        if (field.is_switch) {
            field.set(s, 1.0);
        }
    }
    return s;
}

std::vector<Actor> busy_hands() {
    Actor left{{{0, at(-150), 75},
                {700, at(-150), 75},
                {850, at(-150), 12},
                {1500, at(-150), 12},
                {2500, at(-250), 12},
                {3000, at(-250), 12},
                {3200, at(-250), 75},
                {4500, at(-250), 75},
                {4700, at(-250, 0, 330), 75},
                {5300, at(-250, 0, 330), 75},
                {5500, at(-250), 75},
                {7000, at(-250, 0, 30), 75},
                {8000, at(-250, 0, 30), 75}}};
    left.chirality = Chirality::left;
    Actor right{{{0, at(150), 75},
                 {700, at(150), 75},
                 {850, at(150), 12},
                 {1500, at(150), 12},
                 {2500, at(250), 12},
                 {3000, at(250), 12},
                 {3200, at(250), 75},
                 {5200, at(250), 75},
                 {5350, at(250), 12},
                 {6500, at(250, 150), 12},
                 {7500, at(250, 150), 12},
                 {7700, at(250, 150), 75},
                 {8000, at(250, 150), 75}}};
    right.id = 2;
    return {left, right};
}

struct Outcome {
    int begun = 0;
    int open = 0;
    Stamp last;  ///< event
};

Outcome outcome_of(const std::vector<GestureEvent>& events, Stamp since) {
    std::map<int, EventPhase> lives;
    Outcome o;
    for (const GestureEvent& e : events) {
        if (e.type == GestureType::hand) {
            continue;
        }
        lives[e.gesture_id] = e.phase;
        if (e.emit > since) {
            o.last = e.emit;
        }
    }
    for (const auto& [id, phase] : lives) {
        ++o.begun;
        o.open += phase == EventPhase::begin || phase == EventPhase::update ? 1 : 0;
    }
    return o;
}

/// Plays until the cut, then `after` 400 ms: frames without hands, or the clock alone.
void cut_at(double ms, double fps, bool frames_go_on, bool engage, int& ever_open) {
    GestureSettings settings = all();
    settings.engage = engage;
    Stage stage(settings);
    std::vector<Actor> hands = busy_hands();
    Noise noise(5);
    const auto period_ms = 1000.0 / fps;
    double last_ms = 0.0;
    for (double t = 0.0; t <= ms; t += period_ms) {
        HandFrame frame;
        frame.stamp = Stamp{static_cast<std::int64_t>(t * 1e6)};
        frame.coordinates = CoordinateFrame::interaction;
        for (Actor& actor : hands) {
            actor.noise_mm = 1.5;
            frame.hands[frame.count++] = hand_of(actor, actor.where(t), noise);
        }
        stage.keep(stage.recogniser.push(frame));
        last_ms = t;
    }
    const Stamp last{static_cast<std::int64_t>(last_ms * 1e6)};
    ever_open += outcome_of(stage.events, last).open;
    const double step_ms = frames_go_on ? period_ms : 20.0;
    for (double t = last_ms + step_ms; t <= last_ms + 150.0; t += step_ms) {
        const Stamp now{static_cast<std::int64_t>(t * 1e6)};
        HandFrame frame;
        frame.stamp = now;
        frame.coordinates = CoordinateFrame::interaction;
        stage.keep(frames_go_on ? stage.recogniser.push(frame) : stage.recogniser.advance(now));
    }
    const std::string where = "cut at " + std::to_string(last_ms) + " ms, " + std::to_string(fps) +
                              " fps, " + (frames_go_on ? "frames" : "clock");
    for (const GestureEvent& e : stage.events) {
        if (e.type != GestureType::engage && e.emit > last && e.phase != EventPhase::cancel &&
            e.type != GestureType::hand) {
            ADD_FAILURE() << where << ": " << name_of(e) << " " << to_string(e.phase);
        }
    }
    std::map<int, const GestureEvent*> lives;
    for (const GestureEvent& e : stage.events) {
        if (e.type != GestureType::hand && e.type != GestureType::engage) {
            lives[e.gesture_id] = &e;
        }
    }
    for (const auto& [id, e] : lives) {
        EXPECT_TRUE(e->phase == EventPhase::end || e->phase == EventPhase::cancel)
            << where << ": " << name_of(*e) << " is stuck";
    }
}

TEST(LostHand, AtAnyMomentEverythingIsCancelledIn150Ms) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> when(100.0, 8000.0);
    int ever_open = 0;
    for (int trial = 0; trial < 240; ++trial) {
        const std::array<double, 4> rates{20.0, 30.0, 60.0, 120.0};
        cut_at(when(random), rates[static_cast<std::size_t>(trial) % rates.size()], trial % 2 == 0,
               trial % 3 == 0, ever_open);
        if (HasFailure()) {
            return;
        }
    }
    EXPECT_GT(ever_open, 80) << "the test must cut what is active";
}

}  // namespace
}  // namespace xtrack::test
