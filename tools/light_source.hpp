// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <xtrack/light_calibration.hpp>
#include <xtrack/pattern.hpp>
#include <xtrack/result.hpp>
#include <xtrack/rig.hpp>
#include <xtrack/sim.hpp>

namespace xtrack::tools {

/// What a calibration of light found, and of what.
struct CalibratedLight {
    LightCalibration light;
    PatternSequence patterns;  ///< that were shown
    std::optional<Rig> rig;
};

/// From a recording of light_sequence(), or the like.
/// @errors those of RecordingReader and LightCalibrator; they name the folder
[[nodiscard]] Result<CalibratedLight> light_of_recording(const std::string& folder);

/// From a simulated rig that shows light_sequence() on its wall before anybody comes.
[[nodiscard]] Result<CalibratedLight> light_of_simulation(SimSettings settings);

}  // namespace xtrack::tools
