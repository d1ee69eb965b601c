// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include <xtrack/decode_settings.hpp>
#include <xtrack/pattern.hpp>
#include <xtrack/result.hpp>

#include "core/decode/gamma_correction.hpp"
#include "core/decode/taps.hpp"
#include "core/pattern/response_curve.hpp"
#include "core/unwrap/gray_code.hpp"

namespace xtrack {

/// How the images of one period become a phase.
enum class PeriodKind {
    steps,    ///< grey sines, one pattern for each phase
    colour,   ///< one pattern, its three phases in red, green and blue
    carrier,  ///< one grey sine, whose neighbouring pixels are its phases
    ramp,     ///< one linear ramp between the black and the white image
};

/// The images of one period. Indices are into PatternSequence::patterns.
struct SinePlan {
    double period_px = 0.0;
    PeriodKind kind = PeriodKind::steps;
    std::vector<int> patterns;  ///< one for each phase; else one alone
    std::vector<double> phases_rad;
    TapSet newest_taps;  ///< least squares over the newest image of each pattern
    GammaCorrection gamma;
};

/// A named design over consecutive images of a sequence that is one cycle of one period.
struct CyclePlan {
    int images = 0;               ///< consecutive images that a design combines
    std::vector<TapSet> designs;  ///< by the pattern of the oldest image
};

struct GrayPlan {
    int bits = 0;
    std::array<int, kMaxGrayBits> image{};
    std::array<int, kMaxGrayBits> inverse{};  ///< -1: none
    double cell_px = 0.0;
    double offset_px = 0.0;
};

/// What to do with a sequence: found once, when a decoder is made.
struct DecodePlan {
    Axis axis = Axis::x;
    int coded_length_px = 0;
    int pattern_count = 0;
    ResponseCurve grey;           ///< of the projector, as far as it is known
    std::vector<SinePlan> sines;  ///< longest period first
    std::optional<CyclePlan> cycle;
    std::optional<GrayPlan> gray;
    int white = -1;  ///< flat patterns of full and of no light; -1: none
    int black = -1;
    std::vector<double> pattern_phase_rad;  ///< by pattern; 0 where it is no sine
    std::vector<int> needed;                ///< patterns without which there is no depth, ascending

    /// @return unsupported or invalid_argument, naming the pattern
    [[nodiscard]] static Result<DecodePlan> create(const PatternSequence& patterns,
                                                   const DecodeSettings& settings);
    [[nodiscard]] bool colour() const noexcept {
        return !sines.empty() && sines.back().kind == PeriodKind::colour;
    }
    /// One image of one grey sine is all there is.
    [[nodiscard]] bool carrier() const noexcept {
        return sines.size() == 1 && sines.front().kind == PeriodKind::carrier;
    }
    /// False: motion is not looked for, in one image there is none, and long sequences and ramps
    /// are for scenes at rest.
    [[nodiscard]] bool motion_matters() const noexcept {
        const bool one_image = sines.size() == 1 && sines.front().kind != PeriodKind::steps;
        return !gray && white < 0 && !one_image;
    }
    /// The colour period that orders the shortest one; null: something else does.
    [[nodiscard]] const SinePlan* colour_reference() const noexcept {
        return colour() && sines.size() > 1 && sines[sines.size() - 2].kind == PeriodKind::colour
                   ? &sines[sines.size() - 2]
                   : nullptr;
    }
};

}  // namespace xtrack
