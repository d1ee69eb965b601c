// SPDX-License-Identifier: Apache-2.0
#include "tools/corpus/sequence.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "tools/corpus/everyday.hpp"
#include "tools/corpus/performer.hpp"
#include "tools/corpus/shapes.hpp"

namespace xtrack::tools::corpus {

namespace {

constexpr std::array<GestureSet, 8> kSets{{
    {"strokes", "swipe,push,pull,pinch,grab,tap,circle", true, ""},
    {"signs", "double_pinch,double_tap,wave,raise", true, ""},
    {"poses", "open_palm,fist,point,victory,thumb_up,thumb_down", true, "open_palm"},
    {"both hands", "two_hand_zoom,two_hand_rotate", true, ""},
    {"dwell", "dwell", false, ""},
    {"press", "press", false, ""},
    {"touch", "touch", false, ""},
    {"drag", "pinch,drag", false, ""},
}};

SimHand other(SimHand hand) { return hand == SimHand::right ? SimHand::left : SimHand::right; }

void shuffle(std::vector<std::string>& names, sim::Random& random) {
    for (std::size_t i = names.size(); i > 1; --i) {
        std::swap(names[i - 1], names[random.bits() % i]);
    }
}

Sequence begin(std::string name, std::uint64_t seed, const Seen& seen) {
    Sequence s;
    s.name = std::move(name);
    s.seed = seed;
    s.view = seen.view;
    s.frame_hz = seen.frame_hz;
    return s;
}

Movement& add_hand(Sequence& s, const Person& person, SimHand hand, bool strange) {
    s.strange.push_back(strange);
    return s.hands.emplace_back(person, hand);
}

void finish(Sequence& s) {
    for (const Movement& m : s.hands) {
        s.end_s = std::max(s.end_s, m.now());
    }
    std::stable_sort(
        s.labels.begin(), s.labels.end(),
        [](const GestureLabel& a, const GestureLabel& b) { return a.start < b.start; });
}

/// Over the owner's shoulder, toward the screen, a stroke there, and back.
void lean_over(Movement& m, const Person& owner) {
    m.begin("over the shoulder");
    const auto side = static_cast<float>(m.draw(60.0, 200.0) * (m.draw(-1.0, 1.0) < 0 ? -1 : 1));
    const auto middle = static_cast<float>(owner.to_side_mm);
    const Vec3f behind(middle + side, -190.0F, static_cast<float>(owner.chest_mm + 150.0));
    m.go_evenly(behind, 0.0);
    m.wait(m.draw(1.0, 4.0));
    m.turn({0.8F, 0.0F, 0.0F}, 0.5);
    m.shape(pointing(), 0.5);
    const Vec3f ahead(middle + 0.6F * side, static_cast<float>(m.draw(-120.0, -40.0)),
                      owner.home_mm.z() + static_cast<float>(m.draw(-40.0, 80.0)));
    m.go(ahead, m.draw(0.6, 1.2));
    m.wait(m.draw(0.3, 1.5));
    m.go(ahead + Vec3f(side > 0.0F ? -160.0F : 160.0F, 0.0F, 0.0F), m.draw(0.25, 0.6));
    m.wait(m.draw(0.2, 0.8));
    m.go(behind, m.draw(0.6, 1.2));
    m.go_evenly(m.away(), 0.0);
    m.wait(m.draw(2.0, 8.0));
}

/// From the side, through where the owner gestures, and out again.
void cross(Movement& m, const Person& owner) {
    m.begin("crossing");
    const float side = m.person().to_side_mm < owner.to_side_mm ? -1.0F : 1.0F;
    const float z = owner.home_mm.z() + static_cast<float>(m.draw(-60.0, 80.0));
    const Vec3f outside(side * (0.56F * z + 120.0F), static_cast<float>(m.draw(-60.0, 120.0)), z);
    m.go_evenly(outside, 0.0);
    m.wait(m.draw(1.0, 5.0));
    m.shape(loose(static_cast<float>(m.draw(0.0, 0.8))), 0.3);
    const Vec3f across(-side * 0.2F * z, outside.y(), z);
    m.go_at(across, m.draw(350.0, 1000.0));
    m.wait(m.draw(0.2, 1.0));
    m.go_at(outside, m.draw(350.0, 1000.0));
    m.go_evenly(m.away(), 0.0);
    m.wait(m.draw(2.0, 8.0));
}

Person stranger_near(Company company, std::uint64_t seed, const Person& owner) {
    sim::Random random(sim::mix(seed, 41U));
    Person p = draw_person(sim::mix(seed, 42U));
    const double side = random.unit() < 0.5 ? -1.0 : 1.0;
    switch (company) {
        case Company::queue:
            p.to_side_mm = owner.to_side_mm + side * random.between(150.0, 350.0);
            p.home_mm.z() = static_cast<float>(owner.chest_mm + random.between(200.0, 500.0));
            break;
        case Company::child:
            p.hand_length_mm = random.between(130.0, 150.0);
            p.tall_mm = -200.0;
            p.to_side_mm = owner.to_side_mm + side * random.between(260.0, 380.0);
            p.home_mm.z() = owner.home_mm.z() + static_cast<float>(random.between(-40.0, 80.0));
            break;
        case Company::over_the_shoulder:
            p.to_side_mm = owner.to_side_mm;
            p.home_mm.z() = owner.home_mm.z();
            break;
        case Company::crossing:  // from where they stand
            p.to_side_mm = owner.to_side_mm + side * random.between(450.0, 700.0);
            p.home_mm.z() = owner.home_mm.z();
            break;
    }
    p.home_mm.x() = static_cast<float>(p.to_side_mm + random.between(-70.0, -10.0));
    p.chest_mm = p.home_mm.z() + random.between(1.2, 1.8) * p.hand_length_mm;
    if (company == Company::over_the_shoulder) {
        p.chest_mm = owner.chest_mm + 450.0;
    }
    return p;
}

}  // namespace

std::span<const GestureSet> gesture_sets() noexcept { return kSets; }

const char* to_string(Company company) noexcept {
    switch (company) {
        case Company::queue: return "a queue behind";
        case Company::child: return "a child beside";
        case Company::over_the_shoulder: return "a hand over the shoulder";
        case Company::crossing: return "a hand that crosses";
    }
    return "unknown";
}

Seen seen_by(std::uint64_t index, double frame_hz) {
    constexpr std::array<Seen, 6> kAll{{{View::fine, 60.0},
                                        {View::coarse, 30.0},
                                        {View::joints, 60.0},
                                        {View::fine, 120.0},
                                        {View::coarse, 20.0},
                                        {View::joints, 30.0}}};
    Seen seen = kAll[index % kAll.size()];
    seen.frame_hz = frame_hz > 0.0 ? frame_hz : seen.frame_hz;
    return seen;
}

Sequence perform_all(const std::vector<std::string>& names, const Person& who, int times,
                     const Seen& seen) {
    const Person person = with_room_for(names, who);
    Sequence s = begin(to_string(person.manner), person.seed, seen);
    std::vector<std::string> order;
    for (int i = 0; i < times; ++i) {
        order.insert(order.end(), names.begin(), names.end());
    }
    sim::Random random(sim::mix(person.seed, 51U));
    shuffle(order, random);
    const bool both = std::any_of(names.begin(), names.end(), takes_two_hands);
    Movement& right = add_hand(s, person, both ? SimHand::right : person.hand, false);
    Performer performer(right, s.labels, names);
    performer.enter();
    if (both) {
        Movement& left = add_hand(s, person, SimHand::left, false);
        Performer second(left, s.labels, names);
        second.enter();
        for (const std::string& name : order) {
            if (takes_two_hands(name)) {
                perform_with_both(name, performer, second);
            } else {
                performer.perform(name);
            }
        }
        second.leave();
        s.short_of_definition += second.short_of_definition();
    } else {
        for (const std::string& name : order) {
            performer.perform(name);
        }
    }
    performer.leave();
    s.short_of_definition += performer.short_of_definition();
    finish(s);
    return s;
}

Sequence everyday(std::uint64_t seed, double seconds, const Seen& seen) {
    const Person person = draw_person(seed);
    Sequence s = begin("everyday", seed, seen);
    live(add_hand(s, person, person.hand, false), seconds);
    if (seed % 2 == 0) {
        live(add_hand(s, person, other(person.hand), false), seconds);
    }
    s.end_s = seconds;
    return s;
}

Sequence passers_by(std::uint64_t seed, double seconds, const Seen& seen) {
    Sequence s = begin("passing by", seed, seen);
    sim::Random random(sim::mix(seed, 61U));
    Movement& walker = add_hand(s, draw_person(seed), SimHand::right, true);
    while (walker.now() < seconds) {
        walk_past(walker, walker.draw(650.0, 1400.0));
        walker.wait(walker.draw(2.0, 12.0));
    }
    // And one who stands and talks, beyond where hands are listened to.
    Person far = draw_person(sim::mix(seed, 62U));
    far.home_mm.z() = static_cast<float>(random.between(1150.0, 1400.0));
    far.home_mm.x() -= static_cast<float>(far.to_side_mm = random.between(-300.0, 300.0));
    far.chest_mm = far.home_mm.z() + random.between(1.2, 1.8) * far.hand_length_mm;
    live(add_hand(s, far, far.hand, true), seconds);
    s.end_s = seconds;
    return s;
}

Sequence in_company(Company company, std::uint64_t seed, const std::vector<std::string>& names,
                    const Seen& seen) {
    Sequence s = begin(to_string(company), seed, seen);
    const Person owner = with_room_for(names, draw_person(seed));
    Movement& hand = add_hand(s, owner, owner.hand, false);
    Performer performer(hand, s.labels, names);
    std::vector<std::string> order = names;
    sim::Random random(sim::mix(seed, 71U));
    shuffle(order, random);
    performer.enter();
    hand.wait(1.0);
    const double engaged = hand.now();
    for (const std::string& name : order) {
        performer.perform(name);
    }
    const double end = hand.now();
    performer.leave();
    s.short_of_definition = performer.short_of_definition();

    const Person stranger = stranger_near(company, seed, owner);
    Movement& strange = add_hand(s, stranger, stranger.hand, true);
    strange.wait(engaged);
    std::vector<GestureLabel> of_nobody;
    Performer guest(strange, of_nobody, names);
    if (company == Company::queue || company == Company::child) {
        guest.enter();
    }
    while (strange.now() < end - 8.0) {
        switch (company) {
            case Company::queue: talk(strange, strange.draw(5.0, 12.0)); break;
            case Company::child: {
                strange.begin("a child's gestures");
                guest.perform(order[strange.random().bits() % order.size()]);
                break;
            }
            case Company::over_the_shoulder: lean_over(strange, owner); break;
            case Company::crossing: cross(strange, owner); break;
        }
    }
    finish(s);
    s.end_s = end;  // what strangers do when the owner has gone is theirs
    return s;
}

}  // namespace xtrack::tools::corpus
