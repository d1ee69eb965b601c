// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <xtrack/geometry.hpp>
#include <xtrack/image.hpp>
#include <xtrack/result.hpp>

namespace xtrack {

/// The projector axis that a pattern codes: intensities change along it only.
enum class Axis { x, y };

enum class PatternKind { sine, rgb_sine, gray_code, flat };

/// What the projector shows in one refresh. Intensities are 0..1 of full light, before gamma;
/// x is the projector pixel index along the coded axis, 0 at the centre of the first pixel.
/// Fields that a kind does not name are ignored for it.
/// @since 0.1
struct Pattern {
    PatternKind kind = PatternKind::flat;
    /// sine, rgb_sine: I(x) = 0.5 + 0.5 cos(2 pi x / period_px + phase_rad)
    double period_px = 0.0;
    /// sine: [0] alone. rgb_sine: red, green, blue.
    std::array<double, 3> phase_rad{};
    /// gray_code: bit 0 is the most significant of `bits`; cell = floor((x + offset_px) / cell_px)
    int bit = 0;
    int bits = 0;
    double cell_px = 0.0;
    double offset_px = 0.0;
    bool inverted = false;
    /// flat: one level everywhere
    double level = 0.0;

    friend bool operator==(const Pattern&, const Pattern&) = default;
};

/// The patterns a projector shows, in order, again and again.
struct PatternSequence {
    Axis axis = Axis::x;
    Size projector_size;
    /// light = value^gamma of the projector; absent = unknown, 1 = linear
    std::optional<double> gamma;
    std::vector<Pattern> patterns;

    /// Projector pixels along the coded axis.
    [[nodiscard]] int coded_length_px() const noexcept {
        return axis == Axis::x ? projector_size.width : projector_size.height;
    }
    friend bool operator==(const PatternSequence&, const PatternSequence&) = default;
};

}  // namespace xtrack
