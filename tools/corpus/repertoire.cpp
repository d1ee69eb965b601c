// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include <xtrack/gesture_event.hpp>

#include "tools/corpus/performer.hpp"
#include "tools/corpus/shapes.hpp"

namespace xtrack::tools::corpus {

double touch_plane_mm() {
    constexpr double kPlaneMm = 420.0;
    return kPlaneMm;
}

std::vector<std::string> names_of(const GestureSettings& settings) {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < kGestureTypeCount; ++i) {
        GestureEvent event;
        event.type = static_cast<GestureType>(i);
        if (event.type == GestureType::hand || event.type == GestureType::engage ||
            !is_wanted(settings, event.type)) {
            continue;
        }
        if (directions_of(event.type).empty()) {
            names.push_back(name_of(event));
        }
        for (const Direction direction : directions_of(event.type)) {
            event.direction = direction;
            names.push_back(name_of(event));
        }
    }
    return names;
}

bool takes_two_hands(const std::string& name) {
    return name == to_string(GestureType::two_hand_zoom) ||
           name == to_string(GestureType::two_hand_rotate);
}

Person with_room_for(const std::vector<std::string>& names, Person person) {
    constexpr float kReachMm = 220.0F;  // of a touch
    const bool touches = std::find(names.begin(), names.end(), "touch") != names.end();
    const bool roomy = touches || std::any_of(names.begin(), names.end(), [](const auto& name) {
                           return name == "raise" || takes_two_hands(name);
                       });
    if (roomy) {
        const float least =
            std::max(620.0F * person.scale(),
                     touches ? static_cast<float>(touch_plane_mm()) + kReachMm : 0.0F);
        const float back = std::max(0.0F, least - person.home_mm.z());
        person.home_mm.z() += back;
        person.chest_mm += back;
    }
    return person;
}

void perform_with_both(const std::string& name, Performer& right, Performer& left) {
    Movement& r = right.hand();
    Movement& l = left.hand();
    const bool zooms = name == to_string(GestureType::two_hand_zoom);
    const bool pinches = r.random().unit() < 0.6;
    const float apart = static_cast<float>(r.draw(150.0, 190.0)) * r.person().scale();
    const Vec3f middle = 0.5F * (r.home() + l.home());
    const auto at = [&](float distance, float angle) {
        return Vec3f(0.5F * distance * Vec3f(std::cos(angle), std::sin(angle), 0.0F));
    };
    const auto both = [&](const auto& act) {
        const double from = std::max(r.now(), l.now());
        r.wait_until(from);
        l.wait_until(from);
        act(r, -1.0F);
        act(l, 1.0F);
        const double to = std::max(r.now(), l.now());
        r.wait_until(to);
        l.wait_until(to);
    };
    const sim::FingerAngles open = pinches ? sim::pinch_open() : sim::relaxed_open();
    const sim::FingerAngles closed = pinches ? pinched() : fist();
    const float yaw = pinches ? -0.35F : 0.0F;
    const double pause_s = r.draw(0.3, 0.6);
    both([&](Movement& m, float side) {
        m.begin("both hands up");
        m.turn({0.0F, yaw, 0.0F}, 0.4);
        m.shape(open, 0.4);
        m.go_at(middle + side * at(apart, 0.0F), 130.0);
        m.wait(pause_s);
        m.begin(zooms ? "zoom" : "rotate");
    });
    const double start = r.now();
    const double close_s = r.draw(0.2, 0.4);
    both([&](Movement& m, float /*side*/) {
        m.shape(closed, close_s);
        m.wait(close_s + 0.25);
    });
    const double held = r.now();
    const float factor = zooms ? static_cast<float>(r.draw(1.3, 1.7)) : 1.0F;
    const float angle = zooms ? 0.0F : static_cast<float>(r.draw(0.4, 0.8));
    const float sense = r.random().unit() < 0.5 ? 1.0F : -1.0F;
    const double mmps = r.draw(80.0, 250.0);
    const double stay_s = r.draw(0.2, 0.5);
    both([&](Movement& m, float side) {
        constexpr int kPieces = 12;
        const float way = zooms ? 0.5F * apart * (factor - 1.0F) : 0.5F * apart * angle;
        for (int i = 1; i <= kPieces; ++i) {
            const float u = static_cast<float>(i) / kPieces;
            const float s = u * u * (3.0F - 2.0F * u);
            const float distance = apart * (1.0F + s * (factor - 1.0F));
            m.go_evenly(middle + side * at(distance, sense * angle * s), way / mmps / kPieces);
        }
        m.wait(stay_s);
        m.shape(open, 0.25);
        m.wait(0.25);
    });
    right.add_label(
        name, start, r.now(),
        zooms ? definitions::zoom(r, l, held, r.now()) : definitions::rotate(r, l, held, r.now()));
    both([&](Movement& m, float side) {
        m.begin("both hands down");
        m.wait(0.3);
        m.go_at(middle + side * at(apart, 0.0F), 110.0);
        m.wait(0.3);
    });
}

}  // namespace xtrack::tools::corpus
