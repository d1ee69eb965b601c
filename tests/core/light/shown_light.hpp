// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <xtrack/light_calibration.hpp>
#include <xtrack/method.hpp>
#include <xtrack/sim.hpp>

#include "tests/core/sim/small_rig.hpp"

namespace xtrack::test {

/// A wall alone, on which the sequence of a light calibration is shown once.
inline SimSettings light_on_a_wall(const char* preset = "ideal-60") {
    SimSettings s = small_settings(preset);
    s.user.visible_body = false;
    s.script.clear();
    s.patterns = light_sequence(s.patterns.axis, s.patterns.projector_size);
    // A pattern of a projector that runs free is not seen whole each time: show all of it twice.
    const double shows = s.clocks.locked ? 1.0 : 2.0 * s.clocks.hold_frames;
    s.duration_s = shows * static_cast<double>(s.patterns.patterns.size()) / s.camera.frame_hz;
    return s;
}

struct BentProjector {
    const char* name;
    double gamma;
    std::array<double, 3> s_curve;
};
/// A power, and curves that are none and differ by colour.
inline constexpr std::array<BentProjector, 3> kBentProjectors{
    {{"gamma", 2.2, {}}, {"s_curves", 2.4, {0.3, 0.6, 0.9}}, {"dark_s", 1.6, {0.2, 0.1, 0.5}}}};

inline std::string name_of_projector(const testing::TestParamInfo<BentProjector>& each) {
    return each.param.name;
}

inline SimSettings bent_wall(const BentProjector& projector) {
    SimSettings s = light_on_a_wall();
    s.projector.gamma = projector.gamma;
    s.projector.s_curve = projector.s_curve;
    return s;
}

/// What a calibration makes of a simulated sequence.
/// @param disturb each frame before it is added
inline Result<LightCalibration> calibrate(const SimSettings& settings,
                                          const std::function<void(Frame&)>& disturb = {}) {
    auto made = LightCalibrator::create(settings.patterns, settings.rig.camera.size, settings.rig);
    if (!made) {
        return made.error();
    }
    const auto rig = make_rig(settings);
    for (FrameSource::Item item = rig->next({}); item.status == SourceStatus::ok;
         item = rig->next({})) {
        Frame frame = *item.frame;
        if (disturb) {
            disturb(frame);
        }
        if (auto ok = made->add(frame); !ok) {
            return ok.error();
        }
    }
    return made->finish();
}

/// The simulator's own response, written out once more.
inline double true_light(const SimProjector& projector, double value, std::size_t colour) {
    const double s = projector.s_curve[colour];
    return (1.0 - s) * std::pow(value, projector.gamma) + s * value * value * (3.0 - 2.0 * value);
}

/// The largest error of a measured curve, share of full light.
inline double worst_error(const SimProjector& projector, const ProjectorResponse& response,
                          std::size_t colour) {
    const std::vector<double>& light = response.light[colour];
    double worst = 0.0;
    for (std::size_t i = 0; i < light.size(); ++i) {
        const double value = static_cast<double>(i) / static_cast<double>(light.size() - 1);
        worst = std::max(worst, std::fabs(light[i] - true_light(projector, value, colour)));
    }
    return worst;
}

}  // namespace xtrack::test
