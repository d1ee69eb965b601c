// SPDX-License-Identifier: Apache-2.0
#include <xtrack/method.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace xtrack {
namespace {

// Fine periods, projector px. Colour fringes want 64 to 96: finer ones are lost in chroma that is
// sampled every second pixel. What is unwrapped in space wants many fringes.
constexpr double kFineColour_px = 96.0;
constexpr double kFineGrey_px = 32.0;
constexpr double kCarrier_px = 16.0;
constexpr double kCell_px = 8.0;
// A coarse phase orders a period so many times finer, sixteen times its noise below half a turn.
constexpr double kRatio = 10.0;
constexpr int kRamps = 4;

constexpr std::array<MethodInfo, 12> kMethods{{
    {Method::paper, "paper", "three steps, unwrapped in space, as in the 2012 paper", false, true,
     false, 3, 0.0},
    {Method::grey, "grey", "three steps of one period that is unique in the working volume", false,
     true, true, 5, 8.0},
    {Method::rgb, "rgb", "two colour patterns in turn, a coarse one orders a fine one", true, true,
     true, 2, 12.5},
    {Method::rgb_static, "rgb-static", "one colour pattern that never changes", true, false, true,
     1, 33.0},
    {Method::dual, "dual", "three steps of a coarse and of a fine period", false, true, true, 6,
     0.0},
    {Method::triple, "triple", "three steps of three periods", false, true, true, 9, 0.0},
    {Method::gray_code, "gray-code", "black and white stripes", false, true, true, 9, 0.0},
    {Method::gray_phase, "gray-phase", "black and white stripes, and three steps within", false,
     true, true, 10, 0.0},
    {Method::four_step, "four-step", "four steps of one period that is unique in the volume", false,
     true, true, 5, 0.0},
    {Method::ftp, "ftp", "one grey pattern that never changes", false, false, false, 1, 12.5},
    {Method::ramp, "ramp", "one linear ramp, white and black, for comparison", false, true, true, 3,
     0.0},
    {Method::ramp_four, "ramp-four", "one ramp and four side by side, white and black", false, true,
     true, 4, 0.0},
}};

Pattern flat(double level) {
    Pattern p;
    p.level = level;
    return p;
}

Pattern ramp(double period_px) {
    Pattern p;
    p.kind = PatternKind::ramp;
    p.period_px = period_px;
    return p;
}

std::string speed_text(double mmps) {
    const auto cmps = static_cast<int>(std::lround(mmps / 10.0));
    return std::to_string(cmps / 100) + "." + (cmps % 100 < 10 ? "0" : "") +
           std::to_string(cmps % 100) + " m/s";
}

}  // namespace

std::span<const MethodInfo> methods() noexcept { return kMethods; }

const MethodInfo& info(Method method) noexcept {
    return kMethods[static_cast<std::size_t>(method)];
}

std::optional<Method> method_of(std::string_view name) noexcept {
    for (const MethodInfo& one : kMethods) {
        if (name == one.name) {
            return one.method;
        }
    }
    return std::nullopt;
}

Result<PatternSequence> method_sequence(Method method, const Rig& rig, Axis axis) {
    if (!rig.projector) {
        return Error{ErrorCode::invalid_argument,
                     "projector_matrix is missing; patterns are made for a projector"};
    }
    const Size size = rig.projector->size;
    const double whole_px = axis == Axis::x ? size.width : size.height;
    switch (method) {
        case Method::paper: return three_step_sequence(axis, size, kFineGrey_px);
        case Method::grey:
        case Method::four_step: {
            const auto period_px = volume_wide_period_px(rig, axis);
            if (!period_px) {
                return period_px.error();
            }
            return n_step_sequence(axis, size, *period_px, method == Method::grey ? 3 : 4);
        }
        case Method::rgb: return rgb_sequence(axis, size, {8.0 * kFineColour_px, kFineColour_px});
        case Method::rgb_static: return rgb_sequence(axis, size, {kFineColour_px});
        case Method::dual: return dual_sequence(axis, size, whole_px, whole_px / kRatio);
        case Method::triple: {
            PatternSequence s = dual_sequence(axis, size, whole_px, whole_px / 6.0);
            const PatternSequence fine = three_step_sequence(axis, size, whole_px / 36.0);
            s.patterns.insert(s.patterns.end(), fine.patterns.begin(), fine.patterns.end());
            return s;
        }
        case Method::gray_code: {
            PatternSequence s = gray_code_sequence(axis, size, kCell_px);
            std::erase_if(s.patterns, [](const Pattern& p) { return p.kind == PatternKind::sine; });
            return s;
        }
        case Method::gray_phase: return gray_code_sequence(axis, size, kFineGrey_px);
        case Method::ftp: return n_step_sequence(axis, size, kCarrier_px, 1);
        case Method::ramp:
        case Method::ramp_four: break;
    }
    PatternSequence s = n_step_sequence(axis, size, whole_px, 0);
    s.patterns = {flat(1.0), flat(0.0), ramp(whole_px)};
    if (method == Method::ramp_four) {
        s.patterns.push_back(ramp(whole_px / kRamps));
    }
    return s;
}

PatternSequence light_sequence(Axis axis, Size projector_size, int levels) {
    const double whole_px = axis == Axis::x ? projector_size.width : projector_size.height;
    PatternSequence s = dual_sequence(axis, projector_size, whole_px, whole_px / kRatio);
    const PatternSequence colour =
        rgb_sequence(axis, projector_size, {8.0 * kFineColour_px, kFineColour_px});
    s.patterns.insert(s.patterns.end(), colour.patterns.begin(), colour.patterns.end());
    std::vector<Pattern> ramp;
    for (int i = 0; i < levels; ++i) {
        ramp.push_back(flat(static_cast<double>(i) / std::max(levels - 1, 1)));
    }
    s.patterns.insert(s.patterns.begin(), ramp.begin(), ramp.end());
    return s;
}

MethodVerdict judge(Method method, const MethodNeeds& needs) {
    const MethodInfo& about = info(method);
    MethodVerdict verdict;
    verdict.method = method;
    // A pattern that never changes needs not be held.
    const int hold = about.changes ? std::max(needs.hold_frames, 1) : 1;
    verdict.hand_mmps = about.motion_mm * needs.frame_hz / hold;
    if (about.colour && !needs.colour) {
        verdict.reason = "needs a colour camera";
    } else if (about.colour && needs.colour_works == false) {
        verdict.reason = "the camera failed the colour self-test";
    } else if (needs.static_only && about.changes) {
        verdict.reason = "its patterns change, and only patterns that never change are allowed";
    } else if (needs.metric && !about.metric) {
        verdict.reason = "gives relative depth, and mm are needed";
    } else if (verdict.hand_mmps < needs.hand_mmps) {
        verdict.reason = about.motion_mm > 0.0
                             ? "follows hands up to " + speed_text(verdict.hand_mmps) +
                                   " on this camera, and " + speed_text(needs.hand_mmps) +
                                   " is needed"
                             : "is for scenes at rest, and a hand of " +
                                   speed_text(needs.hand_mmps) + " must be followed";
    } else {
        verdict.possible = true;
        verdict.reason =
            about.changes ? "" : "never changes, so nothing flickers or must be timed; ";
        verdict.reason += about.motion_mm > 0.0
                              ? "follows hands up to " + speed_text(verdict.hand_mmps)
                              : "for scenes at rest";
    }
    return verdict;
}

Result<MethodVerdict> choose_method(const MethodNeeds& needs) {
    std::optional<MethodVerdict> best;
    std::optional<MethodVerdict> nearest;
    const auto better = [&](const MethodVerdict& a, const MethodVerdict& b) {
        const MethodInfo& of_a = info(a.method);
        const MethodInfo& of_b = info(b.method);
        if (of_a.changes != of_b.changes) {
            return !of_a.changes;
        }
        if (of_a.metric != of_b.metric) {
            return of_a.metric;
        }
        if (a.hand_mmps != b.hand_mmps) {
            return a.hand_mmps > b.hand_mmps;
        }
        // A colour camera that nobody has tested comes last; fewer images come first.
        const bool a_sure = !of_a.colour || needs.colour_works == true;
        const bool b_sure = !of_b.colour || needs.colour_works == true;
        return a_sure != b_sure ? a_sure : of_a.images < of_b.images;
    };
    for (const MethodInfo& one : kMethods) {
        const MethodVerdict verdict = judge(one.method, needs);
        if (verdict.possible && (!best || better(verdict, *best))) {
            best = verdict;
        }
        if (!verdict.possible && (!nearest || verdict.hand_mmps > nearest->hand_mmps)) {
            nearest = verdict;
        }
    }
    if (!best) {
        return Error{ErrorCode::unsupported, "no method will do on this camera; nearest is " +
                                                 std::string(info(nearest->method).name) +
                                                 ", which " + nearest->reason};
    }
    return *best;
}

}  // namespace xtrack
