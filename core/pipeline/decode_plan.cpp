// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/decode_plan.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace xtrack {
namespace {

// Periods and phases from text files agree to their printed digits.
constexpr double kSamePeriod = 1e-6;
constexpr double kSamePhaseRad = 1e-4;
// A flat at least this bright serves as white, at most this dark as black (of full light).
constexpr double kWhiteLevel = 0.9;
constexpr double kBlackLevel = 0.1;

Error unsupported(std::string message) {
    return Error{ErrorCode::unsupported, "pattern sequence: " + std::move(message)};
}
Error malformed(std::string message) {
    return Error{ErrorCode::invalid_argument, "pattern sequence: " + std::move(message)};
}

double turned(double angle) { return std::remainder(angle, 2.0 * std::numbers::pi); }

std::optional<PeriodKind> kind_of(PatternKind kind) {
    switch (kind) {
        case PatternKind::sine: return PeriodKind::steps;
        case PatternKind::rgb_sine: return PeriodKind::colour;
        case PatternKind::ramp: return PeriodKind::ramp;
        case PatternKind::gray_code:
        case PatternKind::flat: break;
    }
    return std::nullopt;
}

Result<void> complete(SinePlan& plan, const PatternSequence& sequence) {
    if (plan.kind == PeriodKind::ramp || plan.kind == PeriodKind::carrier) {
        return {};
    }
    auto taps = least_squares_taps(plan.phases_rad);
    if (!taps) {
        return malformed("period " + std::to_string(plan.period_px) +
                         " px: " + taps.error().message);
    }
    plan.newest_taps = *taps;
    std::vector<ResponseCurve> responses;
    for (std::size_t n = 0; n < plan.phases_rad.size(); ++n) {
        responses.push_back(plan.kind == PeriodKind::colour
                                ? colour_response(sequence, static_cast<int>(n))
                                : grey_response(sequence));
    }
    plan.gamma = GammaCorrection(plan.newest_taps, plan.phases_rad, responses);
    return {};
}

Result<std::vector<SinePlan>> collect_sines(const PatternSequence& sequence) {
    std::vector<SinePlan> sines;
    for (std::size_t i = 0; i < sequence.patterns.size(); ++i) {
        const Pattern& pattern = sequence.patterns[i];
        const std::optional<PeriodKind> kind = kind_of(pattern.kind);
        if (!kind) {
            continue;
        }
        auto same = std::find_if(sines.begin(), sines.end(), [&](const SinePlan& plan) {
            return plan.kind == *kind &&
                   std::fabs(plan.period_px - pattern.period_px) <= kSamePeriod * pattern.period_px;
        });
        if (same == sines.end()) {
            same = sines.insert(sines.end(), SinePlan{});
            same->period_px = pattern.period_px;
            same->kind = *kind;
        } else if (*kind != PeriodKind::steps) {
            return unsupported("entry " + std::to_string(i) + ": a second " +
                               (*kind == PeriodKind::ramp ? "ramp" : "colour pattern") +
                               " of one period; use one");
        }
        same->patterns.push_back(static_cast<int>(i));
        if (*kind == PeriodKind::colour) {
            same->phases_rad.assign(pattern.phase_rad.begin(), pattern.phase_rad.end());
        } else {
            same->phases_rad.push_back(pattern.phase_rad[0]);
        }
    }
    if (sequence.patterns.size() == 1 && sines.size() == 1 &&
        sines.front().kind == PeriodKind::steps) {
        sines.front().kind = PeriodKind::carrier;
    }
    for (SinePlan& plan : sines) {
        if (auto ok = complete(plan, sequence); !ok) {
            return ok.error();
        }
    }
    std::sort(sines.begin(), sines.end(),
              [](const SinePlan& a, const SinePlan& b) { return a.period_px > b.period_px; });
    return sines;
}

// The last flat patterns of full and of no light.
void find_flats(const PatternSequence& sequence, DecodePlan& plan) {
    for (std::size_t i = 0; i < sequence.patterns.size(); ++i) {
        const Pattern& pattern = sequence.patterns[i];
        if (pattern.kind == PatternKind::flat) {
            const int index = static_cast<int>(i);
            plan.white = pattern.level >= kWhiteLevel ? index : plan.white;
            plan.black = pattern.level <= kBlackLevel ? index : plan.black;
        }
    }
}

Result<std::optional<GrayPlan>> collect_gray(const PatternSequence& sequence, bool flats) {
    std::optional<GrayPlan> gray;
    for (std::size_t i = 0; i < sequence.patterns.size(); ++i) {
        const Pattern& pattern = sequence.patterns[i];
        const int index = static_cast<int>(i);
        if (pattern.kind != PatternKind::gray_code) {
            continue;
        }
        if (!gray) {
            gray.emplace();
            gray->bits = pattern.bits;
            gray->cell_px = pattern.cell_px;
            gray->offset_px = pattern.offset_px;
            gray->image.fill(-1);
            gray->inverse.fill(-1);
        }
        if (pattern.bits != gray->bits || pattern.cell_px != gray->cell_px ||
            pattern.offset_px != gray->offset_px) {
            return unsupported("entry " + std::to_string(i) +
                               ": a second Gray code with other cells; use one");
        }
        (pattern.inverted ? gray->inverse : gray->image)[static_cast<std::size_t>(pattern.bit)] =
            index;
    }
    if (!gray) {
        return gray;
    }
    bool all_inverted = true;
    for (int bit = 0; bit < gray->bits; ++bit) {
        const auto b = static_cast<std::size_t>(bit);
        if (gray->image[b] < 0) {
            return malformed("Gray code bit " + std::to_string(bit) + " of " +
                             std::to_string(gray->bits) + " is missing");
        }
        all_inverted = all_inverted && gray->inverse[b] >= 0;
    }
    if (!all_inverted && !flats) {
        return unsupported(
            "a Gray code needs flat patterns of level 1 and 0, or every bit inverted as well, to "
            "tell dark skin from a dark stripe");
    }
    return gray;
}

Result<std::optional<CyclePlan>> find_cycle(const SinePlan& sine, int pattern_count,
                                            PhaseTaps choice) {
    const auto length = static_cast<int>(sine.patterns.size());
    const double step = turned(sine.phases_rad[1] - sine.phases_rad[0]);
    bool even = length == pattern_count;
    for (int n = 0; n < length; ++n) {
        const auto here = static_cast<std::size_t>(n);
        const auto next = static_cast<std::size_t>((n + 1) % length);
        even = even && std::fabs(turned(sine.phases_rad[next] - sine.phases_rad[here] - step)) <
                           kSamePhaseRad;
    }
    TapDesign design = TapDesign::three_plus_two;
    switch (choice) {
        case PhaseTaps::least_squares: return std::optional<CyclePlan>{};
        case PhaseTaps::automatic:
            if (!even || (length != 3 && length != 4)) {
                return std::optional<CyclePlan>{};
            }
            design = length == 3 ? TapDesign::three_plus_two : TapDesign::four_plus_one;
            break;
        case PhaseTaps::three_plus_one: design = TapDesign::three_plus_one; break;
        case PhaseTaps::three_plus_two: break;
        case PhaseTaps::four_plus_one: design = TapDesign::four_plus_one; break;
    }
    const int wanted = design == TapDesign::four_plus_one ? 4 : 3;
    if (!even || length != wanted) {
        return unsupported("the chosen taps need a cycle of " + std::to_string(wanted) +
                           " equal steps of one period and nothing else; choose least_squares");
    }
    CyclePlan cycle;
    cycle.images = tap_count(design);
    for (const double first : sine.phases_rad) {
        auto taps = design_taps(design, step, first);
        if (!taps) {
            return taps.error();
        }
        cycle.designs.push_back(*taps);
    }
    return std::optional<CyclePlan>{cycle};
}

Result<void> check_colours(const std::vector<SinePlan>& sines) {
    double direction = 0.0;
    for (const SinePlan& sine : sines) {
        if (sine.kind != PeriodKind::colour) {
            if (direction != 0.0) {
                return unsupported(
                    "a grey period is shorter than its colour periods; colour must "
                    "be the shortest");
            }
            continue;
        }
        const double step = turned(sine.phases_rad[1] - sine.phases_rad[0]);
        if (direction * step < 0.0) {
            return unsupported(
                "its colour patterns go through their phases in both directions; use one");
        }
        direction = step;
    }
    return {};
}

}  // namespace

Result<DecodePlan> DecodePlan::create(const PatternSequence& sequence,
                                      const DecodeSettings& settings) {
    if (auto valid = validate(sequence); !valid) {
        return malformed(valid.error().message);
    }
    DecodePlan plan;
    plan.axis = sequence.axis;
    plan.grey = grey_response(sequence);
    plan.coded_length_px = sequence.coded_length_px();
    plan.pattern_count = static_cast<int>(sequence.patterns.size());
    auto sines = collect_sines(sequence);
    if (!sines) {
        return sines.error();
    }
    plan.sines = *std::move(sines);
    find_flats(sequence, plan);
    const bool flats = plan.white >= 0 && plan.black >= 0;
    auto gray = collect_gray(sequence, flats);
    if (!gray) {
        return gray.error();
    }
    plan.gray = *gray;
    if (plan.sines.empty() && !plan.gray) {
        return unsupported(
            "it has neither sines, ramps nor a Gray code; nothing in it codes position");
    }
    if (plan.gray && !plan.sines.empty() &&
        plan.gray->cell_px > plan.sines.front().period_px * (1.0 + kSamePeriod)) {
        return unsupported("Gray code cells wider than the longest period leave its order open");
    }
    const bool ramps = std::any_of(plan.sines.begin(), plan.sines.end(), [](const SinePlan& sine) {
        return sine.kind == PeriodKind::ramp;
    });
    if (ramps && !flats) {
        return unsupported(
            "a ramp is measured between a white and a black image; add flat "
            "patterns of level 1 and 0");
    }
    if (auto colours = check_colours(plan.sines); !colours) {
        return colours.error();
    }
    if (plan.sines.size() == 1 && plan.sines.front().kind == PeriodKind::steps) {
        auto cycle = find_cycle(plan.sines.front(), plan.pattern_count, settings.taps);
        if (!cycle) {
            return cycle.error();
        }
        plan.cycle = *std::move(cycle);
    } else if (settings.taps != PhaseTaps::automatic && settings.taps != PhaseTaps::least_squares) {
        return unsupported(
            "the chosen taps need a sequence of one grey period; choose least_squares");
    }
    for (const Pattern& pattern : sequence.patterns) {
        plan.pattern_phase_rad.push_back(kind_of(pattern.kind) ? pattern.phase_rad[0] : 0.0);
    }
    for (const SinePlan& sine : plan.sines) {
        plan.needed.insert(plan.needed.end(), sine.patterns.begin(), sine.patterns.end());
    }
    const auto add = [&](int pattern) {
        if (pattern >= 0) {
            plan.needed.push_back(pattern);
        }
    };
    if (plan.gray || ramps) {
        add(plan.white);
        add(plan.black);
    }
    if (plan.gray) {
        for (int bit = 0; bit < plan.gray->bits; ++bit) {
            add(plan.gray->image[static_cast<std::size_t>(bit)]);
            add(plan.gray->inverse[static_cast<std::size_t>(bit)]);
        }
    }
    std::sort(plan.needed.begin(), plan.needed.end());
    return plan;
}

}  // namespace xtrack
