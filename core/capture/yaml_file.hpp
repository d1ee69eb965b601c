// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include <xtrack/pattern.hpp>
#include <xtrack/result.hpp>
#include <xtrack/rig.hpp>

// The one place that knows OpenCV's FileStorage, which throws, recurses as deep as its input is
// nested and reserves what a matrix claims to hold: texts are checked before it sees them, and
// matrices are taken number by number. Messages name `name`, the file, then the field.
namespace xtrack::capture {

/// What rig.yaml holds.
struct RigFile {
    Rig rig;
    std::optional<double> depth_unit_mm;
};

inline constexpr std::size_t kMaxYamlBytes = std::size_t{1} << 20U;
// A micrometre to a metre a step: beyond these no depth that is of use fits 16 bits.
inline constexpr double kMinDepthUnit_mm = 1e-3;
inline constexpr double kMaxDepthUnit_mm = 1000.0;
[[nodiscard]] inline bool is_depth_unit(double unit_mm) noexcept {
    return unit_mm >= kMinDepthUnit_mm && unit_mm <= kMaxDepthUnit_mm;
}

/// @return the rig as written, validated
[[nodiscard]] Result<RigFile> parse_rig(const std::string& text, const std::string& name);
/// @return the sequence as written, validated
[[nodiscard]] Result<PatternSequence> parse_patterns(const std::string& text,
                                                     const std::string& name);

/// The texts that parse_rig() and parse_patterns() read back to the same values.
[[nodiscard]] std::string rig_text(const RigFile& file);
[[nodiscard]] std::string patterns_text(const PatternSequence& sequence);

}  // namespace xtrack::capture
