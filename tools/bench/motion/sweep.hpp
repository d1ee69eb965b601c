// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tools/bench/motion/methods.hpp"
#include "tools/bench/motion/stroke.hpp"

namespace xtrack::tools::bench {

/// A method at every speed.
struct MethodReport {
    MotionMethod method;
    std::string not_decoded;  ///< why DepthDecoder refuses the sequence; empty: it does not
    std::array<HandAccuracy, kSideways_mm.size()> sideways{};
    std::array<HandAccuracy, kToward_mm.size()> toward{};
};

/// The fastest hand that a camera and a method still measure.
struct FastestReport {
    MotionCamera camera = MotionCamera::ideal_60;
    std::string method;       ///< MotionMethod::name
    std::string not_decoded;  ///< as above
    double speed_mps = 0.0;   ///< of kLadder_mps, sideways; 0: not even the slowest
    HandAccuracy there;       ///< at that speed
};

/// Speeds that are tried in turn until one fails, m/s.
inline constexpr std::array<double, 8> kLadder_mps{0.05, 0.1, 0.2, 0.3, 0.5, 0.75, 1.0, 1.5};
/// A method works at a speed where no more of the hand is off and missing.
inline constexpr double kWorksOff_percent = 5.0;
inline constexpr double kWorksMissing_percent = 15.0;
[[nodiscard]] bool works(const HandAccuracy& hand) noexcept;

/// The methods at every speed with the camera ideal-60; each figure is of one stroke to each side,
/// or two toward the camera.
/// @param only names of methods; empty = all
/// @param step called kSpeedSteps times for every sequence
[[nodiscard]] Result<std::vector<MethodReport>> sweep_speeds(const std::vector<std::string>& only,
                                                             const std::function<void()>& step);

/// The fastest speed of the ladder for every camera and method.
/// @param step called once for every camera and sequence
[[nodiscard]] Result<std::vector<FastestReport>> find_fastest(const std::vector<std::string>& only,
                                                              const std::function<void()>& step);

/// How many sequences the methods use.
[[nodiscard]] Result<std::size_t> sequence_count(const std::vector<std::string>& only);
inline constexpr std::size_t kSpeedSteps = kSideways_mm.size() + kToward_mm.size();

}  // namespace xtrack::tools::bench
