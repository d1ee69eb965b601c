// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include <xtrack/pattern.hpp>

#include "core/pattern/response_curve.hpp"

namespace xtrack {

namespace {

// A fringe shorter than this has no picture on a pixel grid (Nyquist).
constexpr double kMinPeriod_px = 2.0;
constexpr double kMaxPeriod_px = 1e6;
constexpr double kMinCell_px = 1.0;
constexpr double kMaxOffset_px = 1e6;
constexpr double kMinGamma = 0.1;
constexpr double kMaxGamma = 10.0;

// Not to_string: it writes 1e300 as three hundred digits.
std::string text_of(double v) {
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, "%.9g", v);
    return buffer;
}

Error bad(const std::string& field, const std::string& value, const std::string& mend) {
    return {ErrorCode::invalid_argument, field + " is " + value + "; " + mend};
}

// False for NaN too.
bool within(double v, double low, double high) { return v >= low && v <= high; }

Result<void> check_number(const std::string& field, double v, double low, double high) {
    if (!within(v, low, high)) {
        return bad(field, text_of(v),
                   "give a number from " + text_of(low) + " to " + text_of(high));
    }
    return {};
}

Result<void> check_sine(const std::string& field, const Pattern& p, int phases) {
    if (auto ok = check_number(field + ".period_px", p.period_px, kMinPeriod_px, kMaxPeriod_px);
        !ok) {
        return ok;
    }
    for (int i = 0; i < phases; ++i) {
        const double phase = p.phase_rad[static_cast<std::size_t>(i)];
        if (!std::isfinite(phase)) {
            const std::string name =
                phases == 1 ? ".phase_rad" : ".phase_rad[" + std::to_string(i) + "]";
            return bad(field + name, text_of(phase), "give a finite angle in radians");
        }
    }
    return {};
}

Result<void> check_gray_code(const std::string& field, const Pattern& p) {
    if (p.bits < 1 || p.bits > kMaxGrayBits) {
        return bad(field + ".bits", std::to_string(p.bits),
                   "give a whole number from 1 to " + std::to_string(kMaxGrayBits));
    }
    if (p.bit < 0 || p.bit >= p.bits) {
        return bad(field + ".bit", std::to_string(p.bit),
                   "give a whole number from 0 (most significant) to bits - 1 = " +
                       std::to_string(p.bits - 1));
    }
    if (auto ok = check_number(field + ".cell_px", p.cell_px, kMinCell_px, kMaxPeriod_px); !ok) {
        return ok;
    }
    return check_number(field + ".offset_px", p.offset_px, -kMaxOffset_px, kMaxOffset_px);
}

Result<void> check_pattern(const std::string& field, const Pattern& p) {
    switch (p.kind) {
        case PatternKind::sine: return check_sine(field, p, 1);
        case PatternKind::rgb_sine: return check_sine(field, p, 3);
        case PatternKind::gray_code: return check_gray_code(field, p);
        case PatternKind::ramp: return check_sine(field, p, 0);
        case PatternKind::flat: return check_number(field + ".level", p.level, 0.0, 1.0);
    }
    return bad(field + ".kind", "none that is known",
               "use sine, rgb_sine, gray_code, ramp or flat");
}

Result<void> check_response(const ProjectorResponse& response) {
    const std::size_t steps = response.light[0].size();
    for (std::size_t c = 0; c < kResponseFields.size(); ++c) {
        const std::vector<double>& light = response.light[c];
        const std::string field = kResponseFields[c];
        if (light.size() < kMinResponseSteps || light.size() > kMaxResponseSteps ||
            light.size() != steps) {
            return bad(field, std::to_string(light.size()) + " numbers long",
                       "give as many for each colour, " + std::to_string(kMinResponseSteps) +
                           " to " + std::to_string(kMaxResponseSteps));
        }
        // NaN fails one of these, wherever it stands.
        if (light.front() != 0.0 || light.back() != 1.0) {
            return bad(field, "from " + text_of(light.front()) + " to " + text_of(light.back()),
                       "begin with 0 (no light) and end with 1 (full light)");
        }
        for (std::size_t i = 1; i < steps; ++i) {
            if (!(light[i] >= light[i - 1])) {
                return bad(field + "[" + std::to_string(i) + "]", text_of(light[i]),
                           "give light that never falls from step to step");
            }
        }
    }
    return {};
}

}  // namespace

Result<void> validate(const PatternSequence& s) {
    for (const int side : {s.projector_size.width, s.projector_size.height}) {
        if (side < 1 || side > kMaxImageSide_px) {
            return bad("projector_size",
                       "[" + std::to_string(s.projector_size.width) + ", " +
                           std::to_string(s.projector_size.height) + "]",
                       "give [width, height], each from 1 to " + std::to_string(kMaxImageSide_px));
        }
    }
    if (s.gamma && !within(*s.gamma, kMinGamma, kMaxGamma)) {
        return bad("gamma", text_of(*s.gamma),
                   "give a number from " + text_of(kMinGamma) + " to " + text_of(kMaxGamma) +
                       ", or leave it out if it is not known");
    }
    if (s.response) {
        if (auto ok = check_response(*s.response); !ok) {
            return ok;
        }
    }
    if (s.patterns.empty() || s.patterns.size() > kMaxPatterns) {
        return bad("sequence", std::to_string(s.patterns.size()) + " patterns long",
                   "list 1 to " + std::to_string(kMaxPatterns));
    }
    for (std::size_t i = 0; i < s.patterns.size(); ++i) {
        if (auto ok = check_pattern("sequence[" + std::to_string(i) + "]", s.patterns[i]); !ok) {
            return ok;
        }
    }
    return {};
}

}  // namespace xtrack
