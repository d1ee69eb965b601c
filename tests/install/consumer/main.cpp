// SPDX-License-Identifier: Apache-2.0
// A program of somebody else, built for the CPU at hand against the installed libraries. Calls
// that take and return structs with Eigen members by value fail here if the two sides disagree
// about their layout.
#include <cmath>
#include <cstdio>

#include <xtrack/gesture_event.hpp>
#include <xtrack/hand.hpp>

int main() {
    xtrack::HandFrame camera;
    camera.stamp = xtrack::Stamp::from_us(1'000'000);
    camera.count = 1;
    camera.hands[0].id = 7;
    camera.hands[0].chirality = xtrack::Chirality::left;
    camera.hands[0].palm_mm = {10.0F, 20.0F, 300.0F};
    xtrack::Mat4d mirror = xtrack::Mat4d::Identity();
    mirror(0, 0) = -1.0;
    mirror(2, 3) = -100.0;

    const xtrack::HandFrame user = xtrack::to_interaction(camera, mirror);
    const xtrack::Hand& hand = user.hands[0];
    const bool moved = std::abs(hand.palm_mm.x() + 10.0F) < 1e-3F &&
                       std::abs(hand.palm_mm.y() - 20.0F) < 1e-3F &&
                       std::abs(hand.palm_mm.z() - 200.0F) < 1e-3F;
    if (user.stamp != camera.stamp || user.count != 1 || hand.id != 7 || !moved ||
        hand.chirality != xtrack::Chirality::right) {
        std::puts("the library returned another hand than it was given");
        return 1;
    }
    std::puts(xtrack::to_string(hand.chirality));
    return 0;
}
