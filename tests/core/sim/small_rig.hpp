// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <utility>

#include <xtrack/sim.hpp>

namespace xtrack::test {

/// A preset with a camera of a quarter of the pixels a side: fast, the same geometry.
inline SimSettings small_settings(const char* preset = "ideal-60") {
    SimSettings s = SimSettings::preset(preset).value();
    constexpr int kDivide = 4;
    s.rig.camera.size = {s.rig.camera.size.width / kDivide, s.rig.camera.size.height / kDivide};
    s.rig.camera.matrix.topRows<2>() /= kDivide;
    s.rig.camera.matrix(0, 2) -= 0.375;  // pixel centres, not corners, are whole numbers
    s.rig.camera.matrix(1, 2) -= 0.375;
    return s;
}

/// The right hand stands still in the middle, but for its sway.
inline SimSettings small_still_hand(double duration_s = 0.1) {
    SimSettings s = small_settings();
    s.script = {{SimAction::idle, SimHand::right, -1.0, duration_s}};
    s.duration_s = duration_s;
    return s;
}

inline std::unique_ptr<SimulatedRig> make_rig(const SimSettings& settings) {
    auto rig = SimulatedRig::create(settings);
    if (!rig) {
        ADD_FAILURE() << rig.error().message;
        return nullptr;
    }
    return std::move(rig).value();
}

/// Every pattern flat, at these levels.
inline void show_flat(SimSettings& s, std::initializer_list<double> levels) {
    s.patterns.patterns.clear();
    for (const double level : levels) {
        Pattern p;
        p.level = level;
        s.patterns.patterns.push_back(p);
    }
}

/// No noise worth the name, no blur, no ambient light: light as computed, but for rounding.
inline void make_clean(SimSettings& s) {
    s.camera.full_well_e = 200000.0;
    s.camera.read_noise_e = 0.0;
    s.camera.blur_px = 0.0;
    s.projector.blur_px = 0.0;
    s.projector.contrast = 1e6;
    s.room.ambient_grey = 0.0;
}

}  // namespace xtrack::test
