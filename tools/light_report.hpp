// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <xtrack/light_calibration.hpp>

namespace xtrack::tools {

/// What a calibration of light found, in words; lines.
[[nodiscard]] std::string light_text(const LightCalibration& light);
/// The same as one JSON object. @param written files that hold it now
[[nodiscard]] std::string light_json(const LightCalibration& light,
                                     const std::vector<std::string>& written);

}  // namespace xtrack::tools
