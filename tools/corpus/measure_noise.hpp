// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <xtrack/result.hpp>

namespace xtrack::tools::corpus {

/// Follows simulated people from fringe images to hands, compares every hand with what a camera
/// without noise would say at its stamp (look_at()), and prints the errors: what noise.cpp has its
/// numbers from.
/// @param people so many on each rig
[[nodiscard]] Result<std::string> measure_noise(int people);

}  // namespace xtrack::tools::corpus
