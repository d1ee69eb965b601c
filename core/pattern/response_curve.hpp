// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <utility>
#include <vector>

#include <xtrack/pattern.hpp>

namespace xtrack {

/// The fields of pattern.yaml that hold a ProjectorResponse, in its order: all of them or none.
inline constexpr std::array<const char*, 3> kResponseFields{"response_red", "response_green",
                                                            "response_blue"};

/// How much light a projector gives for a value, both 0..1: a power of it, or a measured curve that
/// is straight from step to step.
/// @thread any; const
class ResponseCurve {
 public:
    /// light = value
    ResponseCurve() = default;
    /// light = value^gamma, gamma > 0
    explicit ResponseCurve(double gamma) noexcept : gamma_(gamma) {}
    /// @param light at equal steps, as ProjectorResponse has it
    explicit ResponseCurve(std::vector<double> light) noexcept : light_(std::move(light)) {}

    [[nodiscard]] bool linear() const noexcept { return light_.empty() && gamma_ == 1.0; }
    [[nodiscard]] double light(double value) const noexcept;
    /// The least value that gives so much light.
    [[nodiscard]] double value(double light) const noexcept;

 private:
    double gamma_ = 1.0;
    std::vector<double> light_;  // empty: the power holds
};

/// What a sequence knows of its projector's colour (0 red, 1 green, 2 blue): the measured response,
/// else gamma, else linear.
[[nodiscard]] ResponseCurve colour_response(const PatternSequence& sequence, int channel);
/// The same of grey patterns as luma sees them.
[[nodiscard]] ResponseCurve grey_response(const PatternSequence& sequence);

}  // namespace xtrack
