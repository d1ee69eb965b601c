// SPDX-License-Identifier: Apache-2.0
#include "tools/corpus/person.hpp"

#include <algorithm>
#include <cmath>

#include "core/sim/hand_model.hpp"
#include "core/sim/random.hpp"

namespace xtrack::tools::corpus {

const char* to_string(Manner manner) noexcept {
    switch (manner) {
        case Manner::usual: return "usual";
        case Manner::tremor: return "tremor";
        case Manner::slow_and_short: return "slow and short";
        case Manner::wrist_at_rest: return "wrist at rest";
        case Manner::bent_fingers: return "bent fingers";
        case Manner::missing_finger: return "missing finger";
    }
    return "unknown";
}

float Person::scale() const noexcept {
    return static_cast<float>(hand_length_mm) / sim::kModelHandLengthMm;
}

Vec3f Person::home_of(SimHand which) const noexcept {
    const auto middle = static_cast<float>(to_side_mm);
    const float off = home_mm.x() - middle;
    return {which == SimHand::right ? middle + off : middle - off, home_mm.y(), home_mm.z()};
}

Person draw_person(std::uint64_t seed, Manner manner) {
    sim::Random random(sim::mix(seed, 11U));
    Person p;
    p.seed = seed;
    p.manner = manner;
    p.hand = random.unit() < 0.5 ? SimHand::left : SimHand::right;
    p.hand_length_mm = random.between(130.0, 220.0);
    // Evenly over ratios, so that half as fast is as frequent as twice as fast.
    p.speed_mmps = 200.0 * std::pow(1500.0 / 200.0, random.unit());
    const double distance = random.between(400.0, 900.0);
    // The nearer the hand, the less of a stroke has room in the image.
    const double room = std::min(1.0, distance / 650.0);
    p.home_mm = {static_cast<float>(random.between(-70.0, -10.0) * room),
                 static_cast<float>(random.between(0.0, 40.0) * room),
                 static_cast<float>(distance)};
    // Arms are three hands long; who is near the screen reaches less far out.
    p.chest_mm = distance + random.between(1.2, 1.8) * p.hand_length_mm;
    p.tall_mm = (p.hand_length_mm - 185.0) * 1.5;
    switch (manner) {
        case Manner::usual: break;
        case Manner::tremor:
            p.tremor_hz = random.between(4.0, 6.0);
            p.tremor_mm = random.between(5.0, 20.0);
            break;
        case Manner::slow_and_short: p.speed_mmps = random.between(100.0, 300.0); break;
        case Manner::wrist_at_rest: break;
        case Manner::bent_fingers: p.bent = {false, false, false, true, true}; break;
        case Manner::missing_finger: p.missing[1 + random.bits() % 4] = true; break;
    }
    return p;
}

}  // namespace xtrack::tools::corpus
